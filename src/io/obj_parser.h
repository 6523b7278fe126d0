// OBJ files: what tinyobjloader reads, as it stands in the file.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec3.h"
#include "io/obj_text.h"

namespace whit {

inline constexpr std::int32_t kNoIndex = -1;

struct ObjCorner {
  // Indices from 0. kNoIndex: not given. May be out of range: nothing is checked here.
  std::int32_t position = kNoIndex, uv = kNoIndex, normal = kNoIndex;
  bool operator==(const ObjCorner&) const = default;
};

struct ObjFace {
  std::uint64_t firstCorner = 0;
  std::uint64_t textOffset = 0;  // behind its line
  std::uint32_t cornerCount = 0;
  std::uint32_t material = 0;  // index into the summary's materials, their number: none
};

struct ObjContents {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
};

ObjContents parseObj(ObjText& text);

}  // namespace whit
