// updateImage: from the radiance of a pixel's samples to the codes that a display shows.
#pragma once

#include <cmath>

#include "core/display.h"
#include "core/options.h"

namespace whit::reference {

// Sample `number`, counted from 1, into the mean of those before. A running mean: samples that are
// all equal give just that, without any rounding.
inline void addSample(RgbD& mean, const RgbD& sample, double number) {
  mean += (sample - mean) / number;
}

// r | g << 8 | b << 16, with exposure given as a factor.
inline std::uint32_t displayCode(const Rgb& pixel, double exposureScale, ToneCurve curve) {
  const auto codes = displayCodes(pixel, exposureScale, curve);
  return codes[0] | std::uint32_t{codes[1]} << 8 | std::uint32_t{codes[2]} << 16;
}

// The row that the step writes for a pixel as the film keeps it. Exposure is a product of floats in
// both, or codes would differ by it at their borders.
inline std::uint32_t updateImage(const RenderOptions& options, const Rgb& pixel) {
  return displayCode(pixel * std::exp2(options.exposure.ev), 1, options.toneCurve);
}

}  // namespace whit::reference
