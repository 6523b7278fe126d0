#include "accel/alpha_filter.h"

#include <cmath>

namespace whit {

namespace {

constexpr int kCellShift = 3;
// More than the rounding of a bilinear mean of values of at most 1, in units of 1/255.
constexpr float kRounding = 1e-3f;

struct AxisTexels {
  int lower, upper;
  float fraction;
};

// Floor of numbers that an int can hold. The library's function is a call where no instruction for
// it may be assumed.
int floorOf(float x) noexcept {
  const int towardsZero = static_cast<int>(x);
  return towardsZero - static_cast<int>(x < static_cast<float>(towardsZero));
}

inline AxisTexels wrapAxis(Wrap wrap, float s, int size) noexcept {
  // Coordinates that are not finite, or so large that no fraction of a texel is left, become 0.
  if (!(std::fabs(s) <= 1048576.0f)) s = 0;

  // Texel centers lie at half integers. The neighbor beyond the border is the opposite texel.
  if (wrap == Wrap::repeat) {
    const float x = (s - static_cast<float>(floorOf(s))) * static_cast<float>(size) - 0.5f;
    const int lower = floorOf(x);
    const int before = lower < 0 ? size - 1 : lower;
    const int after = lower + 1 >= size ? 0 : lower + 1;
    return {before, after, x - static_cast<float>(lower)};
  }

  // Mirrored and clamped coordinates lie in 0..1, where the outermost texels have no neighbor.
  if (wrap == Wrap::mirror) {
    const float half = s * 0.5f, phase = (half - static_cast<float>(floorOf(half))) * 2.0f;
    s = std::fmin(phase, 2.0f - phase);
  } else {
    s = std::fmin(std::fmax(s, 0.0f), 1.0f);
  }

  const float x = s * static_cast<float>(size) - 0.5f;
  const int lower = floorOf(x);
  return {std::max(lower, 0), std::min(lower + 1, size - 1), x - static_cast<float>(lower)};
}

}  // namespace

AlphaMap::AlphaMap(const Texture& texture)
    : wrapU_(texture.wrapU),
      wrapV_(texture.wrapV),
      nearest_(texture.nearest),
      width_(texture.width),
      height_(texture.height),
      cellsAcross_(((texture.width - 1) >> kCellShift) + 1),
      alpha_(cellsOf(width_, height_)) {
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      alpha_[index(y, x)] = static_cast<std::uint8_t>(texture.texel(x, y) & 255u);
    }
  }

  // Most lookups read this table of bounds and no texel.
  const int cellsDown = ((height_ - 1) >> kCellShift) + 1;
  cells_.reserve(cellsOf(cellsAcross_, cellsDown));
  for (int y = 0; y < cellsDown; ++y) {
    for (int x = 0; x < cellsAcross_; ++x) cells_.push_back(boundsOf(x, y));
  }
}

// The footprint of a bilinear lookup reaches one texel beyond its cell, and at the border of the
// texture to the opposite texel.
AlphaMap::Bounds AlphaMap::boundsOf(int cellX, int cellY) const {
  Bounds bounds;
  const int x0 = cellX << kCellShift, y0 = cellY << kCellShift;
  for (int y = y0; y <= std::min(y0 + (1 << kCellShift), height_); ++y) {
    for (int x = x0; x <= std::min(x0 + (1 << kCellShift), width_); ++x) {
      const std::uint8_t alpha = alpha_[index(y % height_, x % width_)];
      bounds.least = std::min(bounds.least, alpha);
      bounds.most = std::max(bounds.most, alpha);
    }
  }
  return bounds;
}

float AlphaMap::marginAt(float u, float v, float cutoff, bool cutoffVaries) const noexcept {
  const AxisTexels x = wrapAxis(wrapU_, u, width_);
  const AxisTexels y = wrapAxis(wrapV_, 1.0f - v, height_);

  // The bounds of the cell decide alone if all of its texels are clearly on one side of the cutoff.
  const int cell = (y.lower >> kCellShift) * cellsAcross_ + (x.lower >> kCellShift);
  const Bounds bounds = entryOf(cells_, cell);
  const float wanted = cutoff * 255.0f;
  const bool isEven = bounds.least == bounds.most && !cutoffVaries;
  const float slack = isEven ? kRounding : 255 * kCloseCall;

  // Opaque and transparent cells share one branch: a processor cannot predict which of the two a
  // cell is, but nearly always it is one of them.
  const bool everywhere = static_cast<float>(bounds.least) >= wanted + slack;
  const bool somewhere = static_cast<float>(bounds.most) >= wanted - slack;
  if (everywhere == somewhere) return everywhere ? 1.0f : -1.0f;
  const auto texel = [&](int row, int column) {
    return static_cast<float>(alpha_[index(row, column)]) * (1.0f / 255.0f);
  };

  // Without interpolation the alpha jumps at a texel's border, so the distance to it limits the
  // margin.
  if (nearest_) {
    const int row = y.fraction < 0.5f ? y.lower : y.upper;
    const int column = x.fraction < 0.5f ? x.lower : x.upper;
    const float margin = texel(row, column) - cutoff;
    const float toBorder = std::min(std::abs(x.fraction - 0.5f), std::abs(y.fraction - 0.5f));

    // The limit is above 0, so that the margin keeps its sign.
    const float room = std::max(toBorder, 0x1p-20f);
    return std::clamp(margin, -room, room);
  }

  const float top =
      texel(y.lower, x.lower) * (1 - x.fraction) + texel(y.lower, x.upper) * x.fraction;
  const float bottom =
      texel(y.upper, x.lower) * (1 - x.fraction) + texel(y.upper, x.upper) * x.fraction;
  return top * (1 - y.fraction) + bottom * y.fraction - cutoff;
}

std::vector<Mask> makeMasks(const Scene& scene, EffectSet effects) {
  // Materials with the same texture share one map.
  std::vector<std::shared_ptr<const AlphaMap>> maps(scene.textures.size());
  const auto mapOf = [&](std::int32_t number) {
    std::shared_ptr<const AlphaMap>& map = entryOf(maps, number);
    if (!map) map = std::make_shared<AlphaMap>(entryOf(scene.textures, number));
    return map;
  };

  std::vector<Mask> masks;
  for (const Material& material : scene.materials) {
    Mask& mask = masks.emplace_back();
    mask.doubleSided = material.doubleSided;
    if (!effects.has(Effect::alphaMasks) || material.alphaMap == kNoTexture) continue;
    mask.map = mapOf(material.alphaMap);
    mask.cutoff = material.alphaCutoff;
    mask.shadowCutoff = material.shadowCutoff();
    mask.byVertex = material.alphaByVertex && !scene.secondUvs.empty();

    // Shadows are also cut by the coverage where the alpha map does not contain it.
    if (!material.isCutBesidesCoverage()) continue;
    mask.coverage = mapOf(material.coverageMap);
    mask.coverageCutoff = material.coverageCutoff();
  }
  return masks;
}

}  // namespace whit
