// glTF files built by tests.
#pragma once

#include <bit>
#include <map>
#include <set>
#include <type_traits>

#include "scene_files.h"

namespace whit {

inline std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    // Three bytes are 24 bits, which four digits of 6 bits encode.
    std::uint32_t group = 0;
    for (const auto k : indices(3)) {
      const bool there = i + k < bytes.size();
      group = group << 8 | (there ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }

    for (const auto k : indices(4)) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

template <typename T>
std::string bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// Returns a number of 32 bits as a file has it.
inline std::string word(std::size_t x) {
  return bytesOf<std::uint32_t>({static_cast<std::uint32_t>(x)});
}

// Gathers buffer views and accessors over one buffer.
class GltfBuilder {
 public:
  // Returns the number of the view.
  int view(const std::string& bytes, std::size_t stride = 0) {
    // Accessors of floats need views that are aligned to 4 bytes.
    while (data_.size() % 4 != 0) data_ += '\0';

    addItem(views_, joined("{'buffer':0,'byteOffset':", data_.size(), ",'byteLength':",
                           bytes.size(), stride > 0 ? joined(",'byteStride':", stride) : "", "}"));
    data_ += bytes;
    return viewCount_++;
  }

  // Returns the number of the accessor, as it is written into the file. `rest` has further members
  // and begins with a comma. A negative `view` means that there is none.
  std::string accessor(int view, int componentType, const std::string& type, std::size_t count,
                       const std::string& rest = "") {
    const std::string source = view >= 0 ? joined("'bufferView':", view, ",") : "";
    addItem(accessors_, joined("{", source, "'componentType':", componentType, ",'type':'", type,
                               "','count':", count, rest, "}"));
    return joined(accessorCount_++);
  }

  // Adds an accessor with a view of its own. With a stride, elements begin so many bytes apart.
  template <typename T>
  std::string add(const std::string& type, const std::vector<T>& values, std::size_t stride = 0,
                  const std::string& rest = "") {
    static const std::map<std::string, std::size_t> kComponents{
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const std::size_t size = stride > 0 ? stride : kComponents.at(type) * sizeof(T);
    return accessor(view(bytesOf(values), stride), kComponentType<T>, type,
                    values.size() * sizeof(T) / size, rest);
  }

  // Returns a member of an accessor that replaces its elements of these numbers.
  template <typename T>
  std::string sparse(const std::vector<std::uint16_t>& which, const std::vector<T>& values) {
    const int numbers = view(bytesOf(which)), elements = view(bytesOf(values));
    return joined(",'sparse':{'count':", which.size(), ",'indices':{'bufferView':", numbers,
                  ",'componentType':5123},'values':{'bufferView':", elements, "}}");
  }

  std::string floats(const std::string& type, const std::vector<float>& values) {
    return add(type, values);
  }

  std::string positions(const std::vector<float>& xyz) { return add("VEC3", xyz); }
  std::string indices(const std::vector<std::uint16_t>& i) { return add("SCALAR", i); }

  // What an animation does to a node: the values of a path at some times. `rest` has further
  // members of the sampler.
  struct Moved {
    std::string path;
    std::vector<float> times, to;
    int node = 0;
    std::string rest = {};
  };
  std::string animation(const std::vector<Moved>& all) {
    static const std::map<std::string, std::string> kTypes{
        {"translation", "VEC3"}, {"rotation", "VEC4"}, {"scale", "VEC3"}, {"weights", "SCALAR"}};
    std::string samplers, channels;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& [path, times, to, node, rest] = all[i];
      const std::string input = add(
          "SCALAR", times, 0, joined(",'min':[", times.front(), "],'max':[", times.back(), "]"));
      addItem(samplers,
              joined("{'input':", input, ",'output':", floats(kTypes.at(path), to), rest, "}"));
      addItem(channels,
              joined("{'sampler':", i, ",'target':{'node':", node, ",'path':'", path, "'}}"));
    }
    return "{'samplers':[" + samplers + "],'channels':[" + channels + "]}";
  }
  std::string animation(const std::string& path, const std::vector<float>& times,
                        const std::vector<float>& to, int node = 0, const std::string& rest = "") {
    return animation({{path, times, to, node, rest}});
  }

  static std::string named(const std::string& name, std::string animation) {
    return animation.insert(1, "'name':'" + name + "',");
  }
  static std::string played(const std::string& animations) {
    return ",'animations':[" + animations + "]";
  }

  // `members` are those of the root object besides asset, buffers, views and accessors.
  std::string json(const std::string& members, bool binary = false) const {
    std::string text = "{'asset':{'version':'2.0'}";
    if (!data_.empty()) {
      const std::string uri = ",'uri':'data:application/octet-stream;base64," + base64(data_) + "'";
      text += joined(",'buffers':[{'byteLength':", data_.size(), binary ? "" : uri,
                     "}],'bufferViews':[", views_, "]");
    }

    if (!accessors_.empty()) text += ",'accessors':[" + accessors_ + "]";
    if (members.find("extensionsUsed") == std::string::npos) text += extensionsIn(members);

    return text + (members.empty() ? "" : "," + members) + "}";
  }

  std::string glb(const std::string& members) const {
    std::string text = asJson(json(members, true)), data = data_;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4);

    const std::string chunks =
        word(text.size()) + "JSON" + text + word(data.size()) + std::string("BIN\0", 4) + data;
    return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
  }

 private:
  // As glTF numbers them: bytes, words of 16 bits and words of 32 bits, with a sign and without.
  template <typename T>
  static constexpr int kComponentType =
      std::is_floating_point_v<T> ? 5126
                                  : 5120 + 2 * std::countr_zero(sizeof(T)) + std::is_unsigned_v<T>;

  // Returns a member that names the extensions in `members`, each once, or nothing if there are
  // none.
  static std::string extensionsIn(const std::string& members) {
    std::set<std::string> names;
    for (std::size_t at = 0; (at = members.find('\'', at)) != std::string::npos; ++at) {
      const std::string name = members.substr(at, members.find('\'', at + 1) + 1 - at);
      if (name.starts_with("'KHR_") || name.starts_with("'EXT_")) names.insert(name);
    }

    std::string list;
    for (const std::string& name : names) addItem(list, name);
    return list.empty() ? "" : ",'extensionsUsed':[" + list + "]";
  }

  std::string data_, views_, accessors_;
  int viewCount_ = 0, accessorCount_ = 0;
};

// The unit triangle in the plane z = 0, seen from +z.
inline const std::vector<float> kTriangleXyz = {0, 0, 0, 1, 0, 0, 0, 1, 0};

inline const std::vector<Vec3d> kTriangleCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

// Returns a primitive whose positions are an accessor. `attributes` has further attributes and
// `rest` further members; both begin with a comma.
inline std::string primitive(const std::string& positions, const std::string& attributes = "",
                             const std::string& rest = "") {
  return "{'attributes':{'POSITION':" + positions + attributes + "}" + rest + "}";
}

// A scene whose only node shows a mesh of one primitive.
inline std::string oneMesh(const std::string& primitive) {
  return "'meshes':[{'primitives':[" + primitive +
         "]}],'nodes':[{'mesh':0}],'scenes':[{'nodes':[0]}],'scene':0";
}

// A test of files that it builds.
class GltfTest : public SceneFileTest, protected GltfBuilder {
 protected:
  // Returns a primitive that shows the unit triangle.
  std::string triangle(const std::string& rest = "") {
    return primitive(positions(kTriangleXyz), "", rest);
  }

  SceneDescription loadText(const std::string& text) { return load(save("m.gltf", text)); }

  // Loads a file whose only node shows these primitives.
  SceneDescription loadShown(const std::string& primitives) {
    return loadText(json(oneMesh(primitives)));
  }

  std::string errorOfText(const std::string& text) {
    return errorOf([&] { loadText(text); });
  }

  // Expects the errors of files that differ from this one in a text, which occurs there.
  struct Damage {
    std::string what, by, error;
  };
  void expectErrorsOfDamage(const std::string& whole, const std::vector<Damage>& damages) {
    for (const auto& [what, by, error] : damages) {
      SCOPED_TRACE(by);
      expectLike(errorOfText(replaced(whole, what, by)), error);
    }
  }

  static void expectTriangle(const SceneDescription& scene, const std::vector<Vec3d>& corners,
                             std::size_t i = 0, double tolerance = kPoseRounding) {
    for (std::size_t k = 0; k < 3; ++k)
      expectNearInFloat(cornerOf(scene, k, i), corners[k], tolerance);
  }
};

}  // namespace whit
