// What accessors of a glTF document hold. glTF 2.0 specification, section 3.6.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec3.h"
#include "io/gltf/document.h"

namespace whit {

// Every component type, normalized or not, with any stride, sparse or not. Each throws badScene
// "file#/accessors/i" where the accessor is of another type (VEC3, VEC4, VEC2, SCALAR; indices:
// unsigned)
// or reaches beyond its buffer view, limit where its elements do not fit into memory.
std::vector<Vec3f> readVectors(const GltfDocument& document, std::size_t accessor);
std::vector<std::array<double, 4>> readQuaternions(const GltfDocument& document,
                                                   std::size_t accessor);
std::vector<Vec2f> readUvs(const GltfDocument& document, std::size_t accessor);
// VEC3 or VEC4; tells whether some alpha is below 1.
struct GltfColors {
  std::vector<Rgb> colors;
  bool translucent = false;
};
GltfColors readColors(const GltfDocument& document, std::size_t accessor);
// The components of all elements, one after the other; `type` is a TINYGLTF_TYPE of floats without
// padding: SCALAR, VEC3, VEC4, MAT4 (column by column).
std::vector<float> readTuples(const GltfDocument& document, std::size_t accessor, int type);
std::vector<std::uint32_t> readIndices(const GltfDocument& document, std::size_t accessor);

}  // namespace whit
