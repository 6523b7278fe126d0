// Reads accessors of a glTF document. glTF 2.0 specification, section 3.6.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/vec3.h"
#include "io/gltf/document.h"

namespace whit {

// `reference` is the index of an accessor. Every component type, normalized or not, with any
// stride, sparse or not, is read. Each function throws badScene "file#/accessors/i" where the
// accessor is of another type (VEC3, VEC2, SCALAR; indices: unsigned) or reaches beyond its buffer
// view, and limit where its elements do not fit into memory.
std::vector<Vec3f> readVectors(const GltfDocument& document, const JsonValue& reference);
std::vector<Vec2f> readUvs(const GltfDocument& document, const JsonValue& reference);
// VEC3 or VEC4.
struct GltfColors {
  std::vector<Rgb> colors;
  bool translucent = false;  // some alpha is below 1
};
GltfColors readColors(const GltfDocument& document, const JsonValue& reference);
// The components of all elements, one after the other; `type` is SCALAR, VEC3, VEC4 or MAT4 (column
// by column).
std::vector<float> readTuples(const GltfDocument& document, const JsonValue& reference,
                              std::string_view type);
std::vector<std::uint32_t> readIndices(const GltfDocument& document, const JsonValue& reference);
// The accessor itself.
JsonValue accessorOf(const GltfDocument& document, const JsonValue& reference);

}  // namespace whit
