#include "core/film.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/srgb.h"

namespace whit {

namespace {

constexpr float kLargestHalf = 65504.0f, kLeastNormalHalf = 0x1p-14f, kHalfStep = 0x1p-24f;
constexpr int kDroppedBits = 23 - 10;  // of the significand

}  // namespace

float roundedToHalf(float x) {
  if (!std::isfinite(x)) return x;
  const float magnitude = std::fabs(x);
  if (magnitude >= kLargestHalf) return std::copysign(kLargestHalf, x);
  if (magnitude < kLeastNormalHalf) return std::nearbyint(x / kHalfStep) * kHalfStep;
  auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t odd = bits >> kDroppedBits & 1u;
  bits += (1u << (kDroppedBits - 1)) - 1 + odd;
  return std::bit_cast<float>(bits >> kDroppedBits << kDroppedBits);
}

Rgb quantized(FilmPrecision precision, const Rgb& pixel) {
  const auto eachChannel = [&](auto&& keep) {
    return Rgb{keep(pixel.x), keep(pixel.y), keep(pixel.z)};
  };
  switch (precision) {
    case FilmPrecision::single:
      break;
    case FilmPrecision::half:
      return eachChannel(roundedToHalf);
    case FilmPrecision::eightBit:
      return eachChannel([](float x) { return linearOfCode(srgbCode(static_cast<double>(x))); });
  }
  return pixel;
}

}  // namespace whit
