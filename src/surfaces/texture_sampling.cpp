#include "surfaces/texture_sampling.h"

#include <algorithm>
#include <cmath>

#include "bake/sphere.h"

namespace whit {

namespace {

constexpr double kLargestCoordinate = 1 << 20;

double tame(double s) { return std::abs(s) <= kLargestCoordinate ? s : 0.0; }

// The two texels that a coordinate lies between; `fraction` is the weight of the upper one.
struct Between {
  int lower = 0, upper = 0;
  double fraction = 0;

  int nearest() const { return fraction < 0.5 ? lower : upper; }
};

// A repeated coordinate close to either border lies between the last texel and the first.
Between repeated(double s, int size) {
  const double x = (s - std::floor(s)) * size - 0.5;
  const int lower = static_cast<int>(std::floor(x));
  const int before = lower < 0 ? size - 1 : lower;
  const int after = lower + 1 < size ? lower + 1 : 0;
  return {before, after, x - std::floor(x)};
}

Between held(double s, int size) {
  const double x = s * size - 0.5;
  const int lower = static_cast<int>(std::floor(x));
  return {std::max(lower, 0), std::min(lower + 1, size - 1), x - std::floor(x)};
}

Between texelsAround(double s, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return repeated(s, size);
  if (wrap == Wrap::clamp) return held(std::clamp(s, 0.0, 1.0), size);

  // A mirrored texture has period 2 and runs backwards in the second half of it.
  const double phase = 2 * (s / 2 - std::floor(s / 2));
  return held(std::min(phase, 2 - phase), size);
}

double valueOf(TexelFormat format, std::uint32_t texel, int channel) {
  if (format == TexelFormat::radiance) return double{decodeRadianceTexel(texel)[channel]};
  if (format == TexelFormat::data) return (texel >> (8 * channel) & 255u) / 255.0;

  // Colors are stored as square roots of linear light.
  const double root = (texel >> (10 * channel) & 1023u) / 1023.0;
  return root * root;
}

}  // namespace

Textured texturedAt(const Scene& scene, std::uint32_t number, const TriangleHit& hit) {
  const TriangleRecord& record = scene.triangles[number];
  if (scene.isSphere(number)) {
    return {touchingTriangle(record, hit.u, hit.v), {hit.t, 0, 0}, nullptr};
  }
  return {record, hit, scene.secondUvs.empty() ? nullptr : scene.secondUvs[number].uv};
}

TexturePoint texturePoint(const float* uv, const TriangleHit& hit) {
  const double w = 1 - hit.u - hit.v;
  return {uv[0] * w + uv[2] * hit.u + uv[4] * hit.v, uv[1] * w + uv[3] * hit.u + uv[5] * hit.v};
}

double vertexAlpha(const Material& material, const Textured& at) {
  if (!material.alphaByVertex || at.secondUvs == nullptr) return 1;
  return 1 - texturePoint(at.secondUvs, at.hit).u;
}

RgbD sampleTexture(const Texture& texture, double u, double v, TextureFilter filter) {
  const Between x = texelsAround(tame(u), texture.width, texture.wrapU);
  const Between y = texelsAround(1 - tame(v), texture.height, texture.wrapV);

  const auto channel = [&](int number) {
    const auto value = [&](int column, int row) {
      return valueOf(texture.format, texture.texel(column, row), number);
    };

    if (filter == TextureFilter::nearest || texture.nearest) {
      return value(x.nearest(), y.nearest());
    }

    const double upperRow =
        value(x.lower, y.lower) * (1 - x.fraction) + value(x.upper, y.lower) * x.fraction;
    const double lowerRow =
        value(x.lower, y.upper) * (1 - x.fraction) + value(x.upper, y.upper) * x.fraction;
    return upperRow * (1 - y.fraction) + lowerRow * y.fraction;
  };

  return {channel(0), channel(1), channel(2)};
}

double mipLevel(double area) {
  return area > 1 ? 0.5 * std::log2(std::min(area, double{kLargestArea})) : 0;
}

RgbD sampleTexture(const MipMaps& maps, const ShownMap& map, double u, double v, double level) {
  const int lower = static_cast<int>(level);
  const double between = level - lower;
  const RgbD a = sampleTexture(maps.level(map, lower), u, v);
  const RgbD b = sampleTexture(maps.level(map, lower + 1), u, v);
  return a + (b - a) * between;
}

}  // namespace whit
