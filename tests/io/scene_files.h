// Scene files, models and images written by tests, and what loading them gives.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "as_json.h"
#include "core/error.h"
#include "core/warnings.h"
#include "decoded_texel.h"
#include "has_text.h"
#include "io/load_scene.h"
#include "pi.h"
#include "rounding.h"
#include "scene/texture.h"
#include "source_files.h"
#include "temporary_folder.h"

namespace whit {

inline const std::string kTriangleObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// The texels of an image, row by row from the top, by hexadecimal codes: gray as "80", RGB as
// "ff8000" and RGBA as "ff800080".
using Texels = std::vector<std::string>;

// Returns an uncompressed TGA file.
inline std::string tga(const Texels& texels, std::size_t height = 1) {
  const std::size_t channels = texels[0].size() / 2, width = texels.size() / height;
  std::string file(18, '\0');
  file[2] = channels == 1 ? 3 : 2;
  file[12] = static_cast<char>(width & 255);
  file[13] = static_cast<char>(width >> 8);
  file[14] = static_cast<char>(height);
  file[16] = static_cast<char>(8 * channels);
  file[17] = static_cast<char>(0x20 | (channels == 4 ? 8 : 0));

  for (const std::string& texel : texels) {
    std::string codes;
    for (std::size_t i = 0; i < texel.size(); i += 2) {
      codes += static_cast<char>(std::stoi(texel.substr(i, 2), nullptr, 16));
    }
    if (channels >= 3) std::swap(codes[0], codes[2]);  // the format has blue first
    file += codes;
  }

  return file;
}

// Returns all parts, one after the other. Numbers keep every bit of a double.
template <typename... Parts>
std::string joined(const Parts&... parts) {
  std::ostringstream all;
  all.precision(17);
  (all << ... << parts);
  return all.str();
}

// Appends an item to a list that has commas between its items.
inline void addItem(std::string& list, const std::string& item) {
  list += (list.empty() ? "" : ",") + item;
}

// Replaces the first occurrence of a text that has to occur.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

// Expects a text whose end may be anything if `wanted` ends in a "*", or one that contains what
// stands between two of them.
inline void expectLike(const std::string& text, std::string wanted) {
  const bool anyBegin = wanted.starts_with('*'), anyEnd = wanted.ends_with('*');
  if (anyEnd) wanted.pop_back();
  if (anyBegin) {
    EXPECT_TRUE(hasText(text, wanted.substr(1)));
  } else {
    EXPECT_EQ(anyEnd ? text.substr(0, wanted.size()) : text, wanted);
  }
}

// What a test gives to a reader, and the error to expect, as expectLike() takes it.
struct Refusal {
  std::string given, error;
};

using ErrorOf = std::function<std::string(const std::string&)>;

inline void expectErrors(const ErrorOf& errorOf, const std::vector<Refusal>& refusals) {
  for (const auto& [given, error] : refusals) {
    SCOPED_TRACE(given.substr(0, 1000));
    expectLike(errorOf(given), error);
  }
}

inline std::size_t triangleCount(const SceneDescription& scene) {
  std::size_t count = 0;
  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) count += mesh.triangles.size();
  }
  return count;
}

// A new folder for each test, removed afterwards.
class SceneFileTest : public testing::Test {
 protected:
  SceneFileTest() { std::filesystem::create_directory(root_); }

  // Saves a file beside the scene. A name that begins with "../" leaves the scene's folder. Scenes
  // and glTF files may have ' in place of ".
  std::string save(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(root_ + name).parent_path());
    std::ofstream(root_ + name, std::ios::binary) << savedText(name, text);
    return root_ + name;
  }

  std::string saveImage(const std::string& name, const Texels& texels,
                        std::size_t height = 1) const {
    return save(name, tga(texels, height));
  }

  // Returns the bytes of a file of the fuzzers' corpus.
  static std::string corpusFile(const std::string& name) {
    return sourceText("tests/fuzz/corpus/" + name);
  }

  // Settings may have ' in place of ", as files of JSON.
  SceneDescription load(const std::string& name) {
    std::ranges::transform(options_.settings, options_.settings.begin(), asJson);
    return loadScene(name, options_, warnings_);
  }

  // Loads a scene file with these members between its braces.
  SceneDescription loadMembers(const std::string& members, const std::string& query = "") {
    return load(save("s.json", "{'whit': 1, " + members + "}") + query);
  }

  SceneDescription loadObj(const std::string& text) { return load(save("m.obj", text)); }

  Scene bake(SceneDescription description) {
    return Scene::finalize(std::move(description), warnings_);
  }

  std::string withoutFolder(std::string text) const {
    for (std::size_t at; (at = text.find(root_)) != std::string::npos;) {
      text.erase(at, root_.size());
    }
    return text;
  }

  // Returns "STATUS text" of the error, without the test's folder in the text. Errors are short,
  // and those of what a file contains, or of one that is not there, know the file.
  template <typename Action>
  std::string errorOf(Action action) {
    try {
      action();
    } catch (const Error& error) {
      const std::string what = withoutFolder(error.what());
      EXPECT_LT(what.size(), 400u) << what;
      const bool isOfFile =
          error.status() == ExitStatus::badScene || what.ends_with(": no such file");
      EXPECT_TRUE(!isOfFile || error.place().file != "") << what;
      return joined(static_cast<int>(error.status()), " ", what);
    }
    return "no error";
  }

  std::string errorOfFile(const std::string& path) {
    return errorOf([&] { load(path); });
  }

  std::string errorOfObj(const std::string& text) { return errorOfFile(save("m.obj", text)); }

  // Returns the error of a file whose warnings are refused.
  std::string errorIfStrict(const std::string& path) {
    Warnings strict(true);
    return errorOf([&] { loadScene(path, options_, strict); });
  }

  std::string errorOfMembers(const std::string& members) {
    return errorOf([&] { loadMembers(members); });
  }

  void expectErrorsOfMembers(const std::vector<Refusal>& refusals) {
    expectErrors([&](const std::string& members) { return errorOfMembers(members); }, refusals);
  }

  // Expects the errors of whole files of this name.
  void expectErrorsOf(const std::string& name, const std::vector<Refusal>& refusals) {
    expectErrors([&](const std::string& text) { return errorOfFile(save(name, text)); }, refusals);
  }

  // Expects what files of this name are read as: their number of triangles and all warnings, as
  // "1; KIND (COUNT from the first PLACE)".
  void expectRead(const std::string& name, const std::vector<Refusal>& files) {
    const auto read = [&](const std::string& text) {
      Warnings warnings;
      std::string all = joined(triangleCount(loadScene(save(name, text), options_, warnings)));
      for (const auto& [kind, entry] : warnings.entries()) {
        all += joined("; ", kind, " (", entry.count, " from ", withoutFolder(entry.first), ")");
      }
      return all;
    };
    expectErrors(read, files);
  }

  std::uint64_t warned(const std::string& kind) const {
    const auto entries = warnings_.entries();
    const auto entry = entries.find(kind);
    return entry == entries.end() ? 0 : entry->second.count;
  }

  void expectWarned(const std::string& kind, std::uint64_t count = 1) const {
    EXPECT_EQ(warned(kind), count) << kind << "\nall warnings: " << kinds();
  }

  void expectNoWarnings() const { EXPECT_EQ(kinds(), ""); }

  // Returns the kinds of all warnings, each on a line.
  std::string kinds() const {
    std::string all;
    for (const auto& [kind, entry] : warnings_.entries()) all += kind + "\n";
    return all;
  }

  const TemporaryFolder temporary_;
  const std::string folder_ = temporary_.path().string(), root_ = folder_ + "/inside/";
  LoadOptions options_;
  Warnings warnings_;
};

// Returns the mesh of a scene that has a single one, or the first one.
inline const Mesh& meshOf(const SceneDescription& scene) {
  return scene.objects.at(0).meshes.at(0);
}

// Returns a corner of the first triangle of an instance, in the world.
inline Vec3d cornerOf(const SceneDescription& scene, std::size_t corner, std::size_t i = 0) {
  const Instance& instance = scene.instances.at(i);
  const Mesh& mesh = scene.objects[instance.object].meshes[0];
  return instance.toWorld.point(Vec3d(mesh.positions[mesh.triangles[0][corner]]));
}

// Positions and matrices are floats of about 1, as exact as this.
inline constexpr double kPoseRounding = 1e-6;

template <typename Vector>
void expectNearInFloat(const Vector& got, const Vec3d& wanted, double tolerance = kPoseRounding) {
  expectNear(Vec3d(got), wanted, tolerance);
}

// Returns the texture of a map of a material.
inline const Texture& textureOf(const SceneDescription& scene, std::int32_t map) {
  return scene.textures.at(static_cast<std::size_t>(map));
}

// Returns the first channel of the texels of a texture that is read as data.
inline std::vector<int> dataOf(const SceneDescription& scene, std::int32_t map) {
  std::vector<int> values;
  for (const std::uint32_t texel : textureOf(scene, map).texels) {
    values.push_back(static_cast<int>(texel & 255u));
  }
  return values;
}

// Returns the colors of all texels of a texture that is read as color.
inline std::vector<Rgb> colorsOf(const SceneDescription& scene, std::int32_t map) {
  std::vector<Rgb> colors;
  for (const std::uint32_t texel : textureOf(scene, map).texels) {
    colors.push_back(decodeColorTexel(texel));
  }
  return colors;
}

}  // namespace whit
