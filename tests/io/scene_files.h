// Scene files, models and images written by tests, and what loading them gives.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/warnings.h"
#include "io/load_scene.h"
#include "temporary_folder.h"

namespace whit {

inline constexpr char kTriangleObj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// A new folder for each test, removed afterwards.
class SceneFileTest : public testing::Test {
 protected:
  SceneFileTest() { std::filesystem::create_directory(root_); }

  // Saves a file beside the scene. A name that begins with "../" leaves the scene's folder.
  std::string save(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(root_ + name).parent_path());
    std::ofstream(root_ + name, std::ios::binary) << text;
    return root_ + name;
  }

  // Returns the bytes of a file of the fuzzers' corpus.
  static std::string corpusFile(const std::string& name) {
    const char* source = std::getenv("WHIT_SOURCE_DIR");
    const std::string path = std::string(source ? source : ".") + "/tests/fuzz/corpus/" + name;
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path;
    return {std::istreambuf_iterator<char>(in), {}};
  }

  SceneDescription load(const std::string& name) { return loadScene(name, options_, warnings_); }

  // Loads a scene file with these members between its braces.
  SceneDescription loadMembers(const std::string& members, const std::string& query = "") {
    return load(save("s.json", "{\"whit\": 1, " + members + "}") + query);
  }

  SceneDescription loadObj(const std::string& text) { return load(save("m.obj", text)); }

  // Returns "STATUS text" of the error, without the test's folder in the text.
  template <typename Action>
  std::string errorOf(Action action) {
    try {
      action();
    } catch (const Error& error) {
      std::string what = error.what();
      for (std::size_t at; (at = what.find(root_)) != std::string::npos;) {
        what.erase(at, root_.size());
      }

      return std::to_string(static_cast<int>(error.status())) + " " + what;
    }
    return "no error";
  }

  std::string errorOfFile(const std::string& path) {
    return errorOf([&] { load(path); });
  }

  std::string errorOfScene(const std::string& text) { return errorOfFile(save("s.json", text)); }
  std::string errorOfObj(const std::string& text) { return errorOfFile(save("m.obj", text)); }

  // Returns the error of a file whose warnings are refused.
  std::string errorIfStrict(const std::string& path) {
    Warnings strict(true);
    return errorOf([&] { loadScene(path, options_, strict); });
  }

  std::string errorOfMembers(const std::string& members) {
    return errorOf([&] { loadMembers(members); });
  }

  std::uint64_t warned(const std::string& kind) const {
    const auto entries = warnings_.entries();
    const auto entry = entries.find(kind);
    return entry == entries.end() ? 0 : entry->second.count;
  }

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

// Returns an uncompressed TGA file with rows from the top. Texels of 1 value are gray, of 3 RGB and
// of 4 RGBA.
inline std::string tga(int width, int height, const std::vector<std::vector<int>>& texels) {
  const std::size_t channels = texels[0].size();
  std::string file(18, '\0');
  file[2] = channels == 1 ? 3 : 2;
  file[12] = static_cast<char>(width);
  file[14] = static_cast<char>(height);
  file[16] = static_cast<char>(8 * channels);
  file[17] = static_cast<char>(0x20 | (channels == 4 ? 8 : 0));

  for (const std::vector<int>& t : texels) {
    std::vector<int> stored = t;
    if (channels >= 3) std::swap(stored[0], stored[2]);  // the format has blue first
    for (const int c : stored) file += static_cast<char>(c);
  }

  return file;
}

// Returns the mesh of a scene that has a single one, or the first one.
inline const Mesh& meshOf(const SceneDescription& scene) {
  return scene.objects.at(0).meshes.at(0);
}

inline std::size_t triangleCount(const SceneDescription& scene) {
  std::size_t count = 0;
  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) count += mesh.triangles.size();
  }
  return count;
}

}  // namespace whit
