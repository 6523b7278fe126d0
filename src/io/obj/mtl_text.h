// MTL files: the text, checked and brought into the form that tinyobjloader understands.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/warnings.h"

namespace whit {

// Each takes kilobytes and may be a line of a few letters.
inline constexpr std::size_t kMaterialLimit = 65536;

// The statements of a material's text that tinyobjloader does not keep.
struct MtlSummary {
  std::string name;
  std::string where;          // file:line of newmtl
  std::set<std::string> has;  // statements, in their usual spelling
};

struct MtlText {
  std::string text;
  std::vector<MtlSummary> materials;  // in the file's order
};

// Spelling of keywords, numbers that may be left out (`Kd 0.5`, `-s 2 2`), `-halo`. Statements
// whose form is not understood (`Kd spectral`) are left out with a warning. Throws badScene
// "file:line" where a number is missing.
MtlText normalizeMtl(const std::string& text, const std::string& file, Warnings& warnings);

}  // namespace whit
