// The check of a glTF file's JSON against what the format's schemas ask of each property that is
// read here: its kind, its range, and that what an index names exists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "io/scene/json_text.h"

namespace whit {

// Elements of one list, and in all: far beyond any real file.
inline constexpr std::uint64_t kGltfCountLimit = 1u << 20;

// Throws badScene "file#/pointer" where `json` differs from the specification's schemas, limit
// where a list is too long. Afterwards every property that the readers use is of its kind and every
// index refers to something; what lies behind the indices (sizes, offsets, cycles) is theirs to
// check, and whole numbers are spelt as such (1e0 is 1). Properties that nobody reads are not
// looked at.
void checkGltf(Json& json, const std::string& file);

// "file#/list/index".
std::string gltfPlace(const std::string& file, const std::string& list, std::size_t index);

}  // namespace whit
