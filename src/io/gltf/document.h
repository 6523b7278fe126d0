// A glTF file: its JSON, the bytes of its buffers, its accessors and the places of its images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec3.h"
#include "core/warnings.h"
#include "io/files.h"
#include "io/json_reader.h"
#include "io/memory_budget.h"

namespace whit {

using Bytes = std::span<const std::uint8_t>;

// An image that is not decoded yet: `path`, or the bytes of a file.
struct GltfImageSource {
  std::string where;         // "file#/images/3"
  std::string path;          // empty: `bytes`
  std::exception_ptr error;  // thrown where the path cannot be used
  std::string own;           // content of a data URI
  Bytes bytes;
};

struct GltfBufferView {
  Bytes bytes;
  std::size_t index = 0;
  std::uint64_t stride = 0;  // 0: tightly packed
};

class GltfDocument {
 public:
  // `bytes` are the content of the file. Throws Error: limit where it does not fit into `budget`,
  // badScene with "file", "file:line" or "file#/pointer" where it is not well-formed, for a
  // required extension that is not supported, for URIs that leave the folder of the file
  // (PathRules), and for buffers and images without their data. Other extensions that are not
  // supported are warnings, once each. Everything else is checked by whoever reads it.
  GltfDocument(const std::filesystem::path& path, const std::string& bytes, const PathRules& rules,
               MemoryBudget& budget, Warnings& warnings);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  const std::string& name() const { return name_; }
  JsonValue root() const { return JsonValue(*json_); }

  // Returns a list of the root object, such as "nodes".
  JsonValue list(const std::string& name) const { return root()[name]; }

  // Returns true if this build reads the extension.
  static bool reads(const std::string& extension);

  // Returns the buffer view whose index is `reference`. Throws badScene where it does not exist or
  // reaches beyond its buffer.
  GltfBufferView view(const JsonValue& reference) const;

  // Returns the bytes of the buffer to which `source`, a buffer view or its compressed form,
  // refers.
  Bytes range(const JsonValue& source) const;

  // Returns the decoded bytes of a compressed accessor or buffer view, or nothing if it is not
  // compressed.
  std::optional<Bytes> decoded(const JsonValue& value) const;

  const std::vector<GltfImageSource>& images() const { return images_; }
  Warnings& warnings() const { return warnings_; }
  MemoryBudget& budget() const { return budget_; }

 private:
  void checkExtensions() const;
  void readBuffers(const std::filesystem::path& folder, const PathRules& rules);
  void readImages(const std::filesystem::path& folder, const PathRules& rules);
  std::string decodeUri(const JsonValue& uri) const;

  std::string name_;
  MemoryBudget& budget_;
  Warnings& warnings_;
  std::unique_ptr<const JsonDocument> json_;
  std::vector<std::optional<std::string>> buffers_;
  std::map<std::string, std::string> decoded_;  // accessors and buffer views, by their pointers
  std::vector<GltfImageSource> images_;
};

// In the following, `reference` is the index of an accessor. Every component type, normalized or
// not, with any stride, sparse or not, is read. Each function throws badScene "file#/accessors/i"
// where the accessor is of another type (VEC3, VEC2; indices: unsigned SCALAR) or reaches beyond
// its buffer view, and limit where its elements do not fit into memory.
std::vector<Vec3f> readVectors(const GltfDocument& document, const JsonValue& reference);
std::vector<Vec2f> readUvs(const GltfDocument& document, const JsonValue& reference);
std::vector<std::uint32_t> readIndices(const GltfDocument& document, const JsonValue& reference);

// Returns the components of all elements, one after the other: 1 (SCALAR), 3, 4 or 16 (MAT4, column
// by column) for each.
std::vector<float> readTuples(const GltfDocument& document, const JsonValue& reference,
                              std::size_t components);

struct GltfColors {
  std::vector<Rgb> colors;
  bool translucent = false;  // some alpha is below 1
};
GltfColors readColors(const GltfDocument& document, const JsonValue& reference);  // VEC3 or VEC4

// Returns the accessor itself.
JsonValue accessorOf(const GltfDocument& document, const JsonValue& reference);

// Decodes all buffer views that meshoptimizer has compressed (EXT_meshopt_compression), and all
// accessors without a buffer view that primitives compressed by Draco stand for
// (KHR_draco_mesh_compression), tightly packed and of the accessors' own types. A build without the
// library of an extension does not know it. Returns the bytes by the pointers of views and
// accessors. Throws badScene "file#/bufferViews/i/..." or "file#/meshes/i/primitives/k/..." where
// that fails.
std::map<std::string, std::string> decodeCompressed(const GltfDocument& document);

}  // namespace whit
