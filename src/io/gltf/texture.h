// References to textures in glTF's materials: which image it is and how it is looked up. glTF 2.0
// specification, section 3.8; KHR_texture_transform.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "io/gltf/document.h"
#include "scene/texture.h"

namespace whit {

// Which set of coordinates a texture is looked up with, and the affine map to apply to it: in the
// format's own sense, v pointing down.
struct GltfUvMap {
  std::size_t set = 0;
  double uu = 1, uv = 0, u0 = 0;  // u' = uu u + uv v + u0
  double vu = 0, vv = 1, v0 = 0;
  bool operator==(const GltfUvMap&) const = default;
};

struct GltfTexture {
  std::optional<std::size_t> image;
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  GltfUvMap uv;
  bool exists() const { return image.has_value(); }
};

// `info` is what a material names a texture by; none where it does not exist. What cannot be
// represented is counted in the document's warnings, as being at `where`.
GltfTexture readGltfTexture(const GltfDocument& document, const std::string& where,
                            const GltfValue& info);

}  // namespace whit
