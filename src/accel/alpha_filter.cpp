#include "accel/alpha_filter.h"

#include <cmath>

namespace whit {

namespace {

struct AxisTexels {
  int lower, upper;
  float fraction;
};

AxisTexels wrapAxis(Wrap wrap, float s, int size) noexcept {
  // Not finite, or too large for any fraction of a texel to be left.
  if (!(std::fabs(s) <= 1048576.0f)) s = 0;
  if (wrap == Wrap::repeat) {
    const float x = (s - std::floor(s)) * static_cast<float>(size) - 0.5f;
    const float base = std::floor(x);
    const int lower = static_cast<int>(base);
    return {lower < 0 ? size - 1 : lower, lower + 1 >= size ? 0 : lower + 1, x - base};
  }
  if (wrap == Wrap::mirror) {
    const float half = s * 0.5f, phase = (half - std::floor(half)) * 2.0f;
    s = std::fmin(phase, 2.0f - phase);
  } else {
    s = std::fmin(std::fmax(s, 0.0f), 1.0f);
  }
  const float x = s * static_cast<float>(size) - 0.5f;
  const float base = std::floor(x);
  const int lower = static_cast<int>(base);
  return {lower < 0 ? 0 : lower, lower + 1 >= size ? size - 1 : lower + 1, x - base};
}

float alphaAt(const Texture& texture, float u, float v) noexcept {
  const AxisTexels x = wrapAxis(texture.wrapU, u, texture.width);
  const AxisTexels y = wrapAxis(texture.wrapV, 1.0f - v, texture.height);
  const auto texel = [&](int row, int column) {
    const auto index = static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) +
                       static_cast<std::size_t>(column);
    return static_cast<float>(texture.texels[index] & 255u) * (1.0f / 255.0f);
  };
  const float top =
      texel(y.lower, x.lower) * (1 - x.fraction) + texel(y.lower, x.upper) * x.fraction;
  const float bottom =
      texel(y.upper, x.lower) * (1 - x.fraction) + texel(y.upper, x.upper) * x.fraction;
  return top * (1 - y.fraction) + bottom * y.fraction;
}

}  // namespace

bool isOpaqueAt(const MaskedGeometry& geometry, std::uint32_t primitive, float u,
                float v) noexcept {
  const Scene& scene = *geometry.scene;
  const TriangleRecord& t = scene.triangles[geometry.firstTriangle + primitive];
  const Material& material = scene.materials[t.material];
  if (material.alphaMap == kNoTexture) return true;
  const float w = 1.0f - u - v;
  const float s = t.uv[0] * w + t.uv[2] * u + t.uv[4] * v;
  const float r = t.uv[1] * w + t.uv[3] * u + t.uv[5] * v;
  const Texture& texture = scene.textures[static_cast<std::size_t>(material.alphaMap)];
  return alphaAt(texture, s, r) >= material.alphaCutoff;
}

}  // namespace whit
