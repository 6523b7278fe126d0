#include "accel/alpha_filter.h"

namespace whit {

AlphaMaps makeAlphaMaps(const Scene& scene) {
  AlphaMaps maps(scene.textures.size());
  for (const Material& material : scene.materials) {
    if (material.alphaMap == kNoTexture) continue;
    const auto texture = static_cast<std::size_t>(material.alphaMap);
    if (!maps[texture]) maps[texture] = std::make_unique<AlphaMap>(scene.textures[texture]);
  }
  return maps;
}

bool isOpaqueAt(const MaskedGeometry& geometry, std::uint32_t primitive, float u,
                float v) noexcept {
  const Scene& scene = *geometry.scene;
  const TriangleRecord& t = scene.triangles[geometry.firstTriangle + primitive];
  const Material& material = scene.materials[t.material];
  if (material.alphaMap == kNoTexture) return true;
  const float w = 1.0f - u - v;
  const float s = t.uv[0] * w + t.uv[2] * u + t.uv[4] * v;
  const float r = t.uv[1] * w + t.uv[3] * u + t.uv[5] * v;
  const AlphaMap& map = *(*geometry.maps)[static_cast<std::size_t>(material.alphaMap)];
  return map.isOpaqueAt(s, r, material.alphaCutoff);
}

}  // namespace whit
