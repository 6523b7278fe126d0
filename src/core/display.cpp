#include "core/display.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace whit {

namespace {

// Hable's rational curve with the published parameters: shoulder, linear strength and angle, toe
// strength, toe numerator and denominator.
double hable(double x) {
  constexpr double kA = 0.15, kB = 0.50, kC = 0.10, kD = 0.20, kE = 0.02, kF = 0.30;
  return (x * (kA * x + kC * kB) + kD * kE) / (x * (kA * x + kB) + kD * kF) - kE / kF;
}

constexpr double kHableWhite = 11.2;
// Both curves have converged here; beyond it x * x could overflow.
constexpr double kCurveEnd = 1e30;

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

double applyToneCurve(ToneCurve curve, double x) {
  switch (curve) {
    case ToneCurve::none:
      return x;
    case ToneCurve::reinhard:
      x = std::min(x, kCurveEnd);
      return x / (1 + x);
    case ToneCurve::filmic:
      return hable(std::min(x, kCurveEnd)) / hable(kHableWhite);
  }
  return x;
}

std::array<std::uint8_t, 3> displayCodes(const Rgb& pixel, double exposureScale, ToneCurve curve,
                                         SrgbEncoding encoding) {
  const auto encode = [&](float channel) {
    const double exposed = exposureScale * static_cast<double>(channel);
    // NaN and negatives are black before the curve, which is only defined from 0 on.
    const double curved = exposed > 0 ? applyToneCurve(curve, exposed) : 0.0;
    return static_cast<std::uint8_t>(encoding == SrgbEncoding::table
                                         ? srgbCodeByTable(static_cast<float>(curved))
                                         : srgbCode(curved));
  };
  return {encode(pixel.x), encode(pixel.y), encode(pixel.z)};
}

DisplayImage toDisplay(const Image& image, float exposure, ToneCurve curve, SrgbEncoding encoding) {
  DisplayImage display;
  display.width = image.windowWidth();
  display.height = image.windowHeight();
  display.rgba.reserve(image.pixels.size() * 4);
  const double scale = std::exp2(static_cast<double>(exposure));
  for (const Rgb& pixel : image.pixels) {
    for (const std::uint8_t code : displayCodes(pixel, scale, curve, encoding)) {
      display.rgba.push_back(code);
    }
    display.rgba.push_back(255);
  }
  return display;
}

}  // namespace whit
