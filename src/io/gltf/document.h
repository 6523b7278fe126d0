// A glTF file: its JSON, the bytes of its buffers and the places of its images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/warnings.h"
#include "io/json_reader.h"
#include "io/memory_budget.h"
#include "io/paths.h"

namespace whit {

using Bytes = std::span<const std::uint8_t>;

// An image that is not decoded yet: `path`, or the bytes of a file.
struct GltfImageSource {
  std::string where;  // "file#/images/3"
  std::string path;   // empty: `bytes`
  std::string own;    // content of a data URI
  Bytes bytes;
};

struct GltfBufferView {
  Bytes bytes;
  std::size_t index = 0;
  std::uint64_t stride = 0;  // 0: tightly packed
};

class GltfDocument {
 public:
  // Throws Error: io where the file cannot be read, limit where it does not fit into `budget`,
  // badScene with "file", "file:line" or "file#/pointer" where it is not well-formed, for a
  // required extension that is not supported, for URIs that leave the folder of the file
  // (PathRules), and for buffers and images without their data. Other extensions that are not
  // supported are warnings, once each. Everything else is checked by whoever reads it.
  GltfDocument(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
               Warnings& warnings);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  const std::string& name() const { return name_; }
  JsonValue root() const { return JsonValue(*json_); }
  // A list of the root object, "nodes" for example.
  JsonValue list(const std::string& name) const { return root()[name]; }
  // The buffer view whose index is `reference`. Throws badScene where it does not exist or reaches
  // beyond its buffer.
  GltfBufferView view(const JsonValue& reference) const;
  const std::vector<GltfImageSource>& images() const { return images_; }
  Warnings& warnings() const { return warnings_; }
  MemoryBudget& budget() const { return budget_; }

 private:
  void checkExtensions() const;
  void readBuffers(const std::filesystem::path& folder, const PathRules& rules);
  void readImages(const std::filesystem::path& folder, const PathRules& rules);
  std::string decodeUri(const JsonValue& uri) const;

  struct Buffer {
    std::string bytes;
    bool hasData = false;
  };

  std::string name_;
  MemoryBudget& budget_;
  Warnings& warnings_;
  std::unique_ptr<const JsonDocument> json_;
  std::vector<Buffer> buffers_;
  std::vector<GltfImageSource> images_;
};

}  // namespace whit
