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
  kIndexMended = 16,
};

// A model as GLB, or an empty text and what went wrong.
struct ConvertedModel {
  std::string glb, failure;
  std::uint32_t notes = 0, badFaces = 0;
};

// Converts `bytes`, the content of the file of that name, in a child process that can only compute
// (io/confined.h), because damaged files break the library. The child may take `mostBytes` of
// memory. No file is read, so that models which consist of several files lack the others.
ConvertedModel convertByAssimp(const std::string& file, const std::string& bytes,
                               std::uint64_t mostBytes);

}  // namespace whit
