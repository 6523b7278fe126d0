// Models of formats that the library assimp reads: STL, FBX, Collada, 3DS and OFF.
#pragma once

#include <cstdint>
#include <string>

namespace whit {

// Each bit names a part of a model that the conversion leaves out or changes.
enum AssimpNote : std::uint32_t {
  kSkinLeftOut = 1,
  kViewLeftOut = 2,
  kMapLeftOut = 4,
  kMadeOpaque = 8,
  kPositionMended = 16,
};

// A model as GLB, or an empty text and what went wrong.
struct ConvertedModel {
  std::string glb, failure;
  std::uint32_t notes = 0;
};

// Converts the content of a file of that extension (".stl") in a child process that can only
// compute (io/confined.h), because damaged files break the library. The child may take `mostBytes`
// of memory. Nothing but `bytes` is read, so that files which consist of several lack the others.
ConvertedModel convertByAssimp(const std::string& bytes, const std::string& extension,
                               std::uint64_t mostBytes);

}  // namespace whit
