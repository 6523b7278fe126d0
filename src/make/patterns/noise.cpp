#include "make/patterns/noise.h"

#include <cmath>
#include <span>

namespace whit::procedural {
namespace {

std::uint32_t mix(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  return h ^ (h >> 16);
}

// Applies the finalizer of MurmurHash3 after each word.
std::uint32_t hash(std::uint32_t seed, std::int32_t x, std::int32_t y, std::int32_t z) {
  std::uint32_t h = mix(seed + 0x9e3779b9u);
  h = mix(h ^ (static_cast<std::uint32_t>(x) + 0x7f4a7c15u));
  h = mix(h ^ (static_cast<std::uint32_t>(y) + 0x94d049bbu));
  return mix(h ^ (static_cast<std::uint32_t>(z) + 0x2545f491u));
}

// Mixes once and not four times as hash() does, because patterns take millions of these hashes.
std::uint32_t latticeHash(std::uint32_t seed, std::int32_t x, std::int32_t y) {
  return mix(static_cast<std::uint32_t>(x) * 0x8da6b343u ^
             static_cast<std::uint32_t>(y) * 0xd8163841u ^ seed * 0xcb1ab31fu);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// Computes std::floor() without a call, for numbers that fit into 32 bits.
std::int32_t floorOf(double x) {
  const auto i = static_cast<std::int32_t>(x);
  return i - (i > x);
}

std::int32_t wrapped(std::int32_t i, int period) {
  if (period <= 0 || (i >= 0 && i < period)) return i;  // the usual case needs no slow division

  const std::int32_t r = i % period;
  return r < 0 ? r + period : r;
}

// Eight directions in the plane give enough variety without trigonometry. They are a table, because
// a switch on random bits is mispredicted most of the time. The table is global, because sanitizers
// would fill and watch a local one millions of times.
constexpr double kDiagonal = 0.70710678118654752440;
constexpr double kSlopeX[8] = {1, -1, 0, 0, kDiagonal, kDiagonal, -kDiagonal, -kDiagonal};
constexpr double kSlopeY[8] = {0, 0, 1, -1, kDiagonal, -kDiagonal, kDiagonal, -kDiagonal};

// Returns a ramp whose slope points to the middle of one of a cube's twelve edges (Perlin 2002).
double slope3(std::uint32_t h, double x, double y, double z) {
  const std::uint32_t k = h % 12u;
  const double a = k < 8 ? x : y;
  const double b = k < 4 ? y : z;
  const double signedA = (h & 16u) ? -a : a;
  return signedA + ((h & 32u) ? -b : b);
}

}  // namespace

double unitHash(std::uint32_t seed, std::int32_t x, std::int32_t y, std::int32_t z) {
  return hash(seed, x, y, z) * (1.0 / 4294967296.0);
}

double lerp(double a, double b, double t) { return a + (b - a) * t; }

double smoothStep(double low, double high, double x) {
  if (x <= low) return 0;
  if (x >= high) return 1;
  const double t = (x - low) / (high - low);
  return t * t * (3 - 2 * t);
}

void NoiseCell::enter(std::uint32_t seed, std::int32_t x, std::int32_t y, int period) {
  seed_ = seed;
  x_ = x;
  y_ = y;
  isKnown_ = true;

  const std::int32_t x0 = wrapped(x, period), x1 = wrapped(x + 1, period);
  const std::int32_t y0 = wrapped(y, period), y1 = wrapped(y + 1, period);
  const std::uint32_t hashes[4] = {latticeHash(seed, x0, y0), latticeHash(seed, x1, y0),
                                   latticeHash(seed, x0, y1), latticeHash(seed, x1, y1)};
  for (int i = 0; i < 4; ++i) {
    slopes_[i][0] = kSlopeX[hashes[i] & 7u];
    slopes_[i][1] = kSlopeY[hashes[i] & 7u];
  }
}

double NoiseCell::at(std::uint32_t seed, double x, double y, int period) {
  const std::int32_t ix = floorOf(x), iy = floorOf(y);
  if (ix != x_ || iy != y_ || seed != seed_ || !isKnown_) enter(seed, ix, iy, period);

  // Weights are quintic in the position within the cell, so that slopes and curvatures are
  // continuous.
  const double tx = x - ix, ty = y - iy, u = fade(tx), v = fade(ty);

  // Each corner has a linear ramp with a random slope; the four are interpolated.
  const auto ramp = [&](int i, double dx, double dy) {
    return slopes_[i][0] * dx + slopes_[i][1] * dy;
  };
  const double low = lerp(ramp(0, tx, ty), ramp(1, tx - 1, ty), u);
  const double high = lerp(ramp(2, tx, ty - 1), ramp(3, tx - 1, ty - 1), u);
  return lerp(low, high, v) * 1.5;  // brings the usual extremes of about 0.66 to 1
}

double gradientNoise(std::uint32_t seed, double x, double y, int period) {
  return NoiseCell().at(seed, x, y, period);
}

double gradientNoise3(std::uint32_t seed, double x, double y, double z) {
  const std::int32_t ix = floorOf(x), iy = floorOf(y), iz = floorOf(z);
  const double tx = x - ix, ty = y - iy, tz = z - iz, u = fade(tx), v = fade(ty);

  const auto plane = [&](int k) {
    const auto corner = [&](int i, int j) {
      return slope3(hash(seed, ix + i, iy + j, iz + k), tx - i, ty - j, tz - k);
    };
    return lerp(lerp(corner(0, 0), corner(1, 0), u), lerp(corner(0, 1), corner(1, 1), u), v);
  };
  return lerp(plane(0), plane(1), fade(tz));
}

double FractalNoise::operator()(std::uint32_t seed, double x, double y) {
  double sum = 0, amplitude = 1, total = 0;
  int period = period_;
  for (NoiseCell& cell : std::span(cells_).first(octaves_)) {
    sum += amplitude * cell.at(seed++, x, y, period);
    total += amplitude;
    amplitude *= 0.5;
    // The period counts cells, so it doubles with the frequency.
    x *= 2;
    y *= 2;
    period *= 2;
  }
  return total > 0 ? sum / total : 0;
}

double fractalNoise(std::uint32_t seed, double x, double y, int octaves, int period) {
  return FractalNoise(octaves, period)(seed, x, y);
}

double ridgedNoise(std::uint32_t seed, double x, double y, int octaves) {
  double sum = 0, amplitude = 0.5, weight = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    // The absolute value folds the noise at its zero crossings, which become the crests.
    double crest = 1 - std::fabs(gradientNoise(seed + static_cast<std::uint32_t>(i), x, y));
    crest = crest < 0 ? 0 : crest * crest;

    sum += amplitude * weight * crest;
    total += amplitude;
    weight = crest;  // valleys stay smooth, crests gather detail
    amplitude *= 0.5;
    x *= 2;
    y *= 2;
  }
  return total > 0 ? sum / total : 0;
}

}  // namespace whit::procedural
