// A glTF file, read and checked: its structure as tinygltf has it, its bytes within their bounds.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/warnings.h"
#include "io/gltf/loose_json.h"
#include "io/memory_budget.h"
#include "io/paths.h"
#include "io/scene/json_text.h"

namespace whit {

using Bytes = std::span<const std::uint8_t>;

// An image that is not decoded: `path`, or the bytes of a file.
struct GltfImageSource {
  std::string where;  // "file#/images/3"
  std::string path;   // empty: `bytes`
  std::string own;    // of a data URI
  Bytes bytes;
};

class GltfDocument {
 public:
  // Throws Error: io where the file cannot be read, limit where it does not fit into `budget`,
  // badScene with "file", "file:line" or "file#/pointer" where it is not well-formed, where
  // checkGltf() refuses it, for a required extension that is not supported, for URIs that leave the
  // folder of the file (PathRules), and for buffers, views of them or images that reach beyond
  // their ends. Other extensions that are not supported are warnings, once each.
  GltfDocument(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
               Warnings& warnings);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  // Everything but buffers and images, whose lists are empty. Indices are in range.
  const tinygltf::Model& model() const { return model_; }
  const std::string& name() const { return name_; }
  // "file#/list/index" + rest.
  std::string where(const std::string& list, std::size_t index, const std::string& rest = "") const;
  Bytes view(std::size_t bufferView) const;
  const std::vector<GltfImageSource>& images() const { return images_; }
  // As the file has them: nothing about them is checked.
  LooseJson animations() const { return LooseJson(animations_); }
  LooseJson skins() const { return LooseJson(skins_); }
  Warnings& warnings() const { return warnings_; }
  MemoryBudget& budget() const { return budget_; }

 private:
  struct Source;  // what the buffers and images are read from

  void checkExtensions(const Source& source) const;
  void readBuffers(Source& source);
  void checkViews(const Source& source) const;
  void readImages(const Source& source);
  void readStructure(Source& source);
  void readWithTinygltf(Json& json);

  std::string name_;
  MemoryBudget& budget_;
  Warnings& warnings_;
  std::vector<std::string> buffers_;
  std::vector<GltfImageSource> images_;
  Json animations_, skins_;
  tinygltf::Model model_;
};

// Null where there is none of this name.
inline const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions,
                                            const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

inline double numberOf(const tinygltf::Value& object, const char* key, double fallback) {
  return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

}  // namespace whit
