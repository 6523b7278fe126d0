// The container of glTF files: JSON text, or JSON and a binary chunk in a .glb file. glTF 2.0
// specification, section 4 (GLB).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/json_text.h"
#include "io/memory_budget.h"

namespace whit {

struct GltfFile {    // NOLINT(bugprone-exception-escape): moving Json does not throw
  std::string name;  // for errors
  Json json;         // an object
  bool hasBinary = false;
  std::vector<std::uint8_t> binary;  // the chunk of a .glb
};

// Told by its content. Throws Error: io where it cannot be read, badScene with "file", "file:line"
// or "file#/pointer" where it is not well-formed, limit where it does not fit into `budget`.
GltfFile readGltfFile(const std::filesystem::path& path, MemoryBudget& budget);

}  // namespace whit
