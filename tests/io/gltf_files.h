// glTF files built by tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "scene_files.h"

namespace whit {

inline std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    // Three bytes are 24 bits, which four digits of 6 bits encode.
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool there = i + k < bytes.size();
      group = group << 8 | (there ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }

    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

template <typename T>
std::string bytesOf(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// Gathers buffer views and accessors over one buffer.
class GltfBuilder {
 public:
  // Returns the number of the view.
  int view(const std::string& bytes, int stride = 0) {
    // Accessors of floats need views that are aligned to 4 bytes.
    while (data_.size() % 4 != 0) data_ += '\0';

    views_ += std::string(views_.empty() ? "" : ",") +
              "{\"buffer\":0,\"byteOffset\":" + std::to_string(data_.size()) +
              ",\"byteLength\":" + std::to_string(bytes.size()) +
              (stride > 0 ? ",\"byteStride\":" + std::to_string(stride) : "") + "}";

    data_ += bytes;
    return viewCount_++;
  }

  // Returns the number of the accessor, as it is written into the file. `rest` has further members
  // and begins with a comma. A negative `view` means that there is none.
  std::string accessor(int view, int componentType, const std::string& type, std::size_t count,
                       const std::string& rest = "") {
    accessors_ += std::string(accessors_.empty() ? "" : ",") +
                  (view >= 0 ? "{\"bufferView\":" + std::to_string(view) + "," : "{") +
                  "\"componentType\":" + std::to_string(componentType) + ",\"type\":\"" + type +
                  "\",\"count\":" + std::to_string(count) + rest + "}";
    return std::to_string(accessorCount_++);
  }

  std::string positions(const std::vector<float>& xyz) {
    return accessor(view(bytesOf(xyz)), 5126, "VEC3", xyz.size() / 3, boundsOf(xyz));
  }

  std::string uvs(const std::vector<float>& uv) {
    return accessor(view(bytesOf(uv)), 5126, "VEC2", uv.size() / 2);
  }

  std::string indices(const std::vector<std::uint16_t>& i) {
    return accessor(view(bytesOf(i)), 5123, "SCALAR", i.size());
  }

  // `members` are those of the root object besides asset, buffers, views and accessors.
  std::string json(const std::string& members, bool binary = false) const {
    std::string text = "{\"asset\":{\"version\":\"2.0\"}";
    if (!data_.empty()) {
      text += ",\"buffers\":[{\"byteLength\":" + std::to_string(data_.size());
      if (!binary)
        text += ",\"uri\":\"data:application/octet-stream;base64," + base64(data_) + "\"";
      text += "}],\"bufferViews\":[" + views_ + "]";
    }

    if (!accessors_.empty()) text += ",\"accessors\":[" + accessors_ + "]";
    const std::string names = extensionsIn(members);
    if (!names.empty()) text += ",\"extensionsUsed\":[" + names + "]";

    return text + (members.empty() ? "" : "," + members) + "}";
  }

  std::string glb(const std::string& members) const {
    std::string text = json(members, true), data = data_;
    while (text.size() % 4 != 0) text += ' ';
    while (data.size() % 4 != 0) data += '\0';

    const auto word = [](std::size_t x) {
      return bytesOf<std::uint32_t>({static_cast<std::uint32_t>(x)});
    };

    const std::string chunks =
        word(text.size()) + "JSON" + text + word(data.size()) + std::string("BIN\0", 4) + data;
    return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
  }

 private:
  // Returns the names in quotes, each once, or nothing where the members declare the extensions
  // themselves.
  static std::string extensionsIn(const std::string& members) {
    std::set<std::string> names;
    if (members.find("extensionsUsed") != std::string::npos) return "";

    for (const std::string beginning : {"\"KHR_", "\"EXT_"}) {
      for (std::size_t at = members.find(beginning); at != std::string::npos;) {
        const std::size_t end = members.find('"', at + 1);
        names.insert(members.substr(at, end + 1 - at));
        at = members.find(beginning, end);
      }
    }

    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
    return list;
  }

  // Positions need bounds by the specification.
  static std::string boundsOf(const std::vector<float>& xyz) {
    std::ostringstream low, high;
    low.precision(9);
    high.precision(9);

    for (std::size_t k = 0; k < 3 && xyz.size() >= 3; ++k) {
      float least = xyz[k], largest = xyz[k];
      for (std::size_t i = k; i < xyz.size(); i += 3) {
        least = std::min(least, xyz[i]);
        largest = std::max(largest, xyz[i]);
      }

      low << (k ? "," : "") << least;
      high << (k ? "," : "") << largest;
    }

    return ",\"min\":[" + low.str() + "],\"max\":[" + high.str() + "]";
  }

  std::string data_, views_, accessors_;
  int viewCount_ = 0, accessorCount_ = 0;
};

// A scene whose only node shows a mesh of one primitive.
inline std::string oneMesh(const std::string& primitive) {
  return "\"meshes\":[{\"primitives\":[" + primitive +
         "]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0";
}

class GltfTest : public SceneFileTest {
 protected:
  SceneDescription loadText(const std::string& text) { return load(save("m.gltf", text)); }

  // Loads a file whose only node shows these primitives.
  SceneDescription loadShown(const GltfBuilder& b, const std::string& primitives) {
    return loadText(b.json(oneMesh(primitives)));
  }

  std::string errorOfText(const std::string& text) {
    return errorOf([&] { loadText(text); });
  }

  // Returns a corner of a triangle of instance `i`, in the world.
  static Vec3d cornerOf(const SceneDescription& scene, std::size_t i, std::size_t triangle,
                        std::size_t corner) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.objects[instance.object].meshes[0];
    return instance.toWorld.point(Vec3d(mesh.positions[mesh.triangles[triangle][corner]]));
  }
};

// Positions and matrices are floats of about 1, as exact as this.
inline constexpr double kPoseRounding = 1e-6;

inline void expectNear(const Vec3d& a, const Vec3d& b, double tolerance = kPoseRounding) {
  EXPECT_LT(length(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

// The unit triangle in the plane z = 0, seen from +z.
inline const std::vector<float> kTriangleXyz = {0, 0, 0, 1, 0, 0, 0, 1, 0};

// Returns a primitive whose positions are an accessor. `attributes` has further attributes and
// `rest` further members; both begin with a comma.
inline std::string primitive(const std::string& positions, const std::string& attributes = "",
                             const std::string& rest = "") {
  return "{\"attributes\":{\"POSITION\":" + positions + attributes + "}" + rest + "}";
}

// Returns a primitive that shows this triangle.
inline std::string triangle(GltfBuilder& b, const std::string& rest = "") {
  return primitive(b.positions(kTriangleXyz), "", rest);
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

}  // namespace whit
