// updateImage: from the radiance of a pixel's samples to the codes that a display shows.
#pragma once

#include <cmath>

#include "core/display.h"
#include "core/options.h"

namespace whit::reference {

// Adds sample `number`, counted from 1, to the mean of the samples before. The mean of equal
// samples is exact, because a running mean then adds 0.
inline void addSample(RgbD& mean, const RgbD& sample, double number) {
  mean += (sample - mean) / number;
}

// Returns r | g << 8 | b << 16, with exposure given as a factor.
inline std::uint32_t displayCode(const Rgb& pixel, double exposureScale, ToneCurve curve) {
  const auto codes = displayCodes(pixel, exposureScale, curve);
  return codes[0] | std::uint32_t{codes[1]} << 8 | std::uint32_t{codes[2]} << 16;
}

// Returns the row that the step writes for a pixel as the film keeps it. Exposure is a product of
// floats here and in the kernel, or codes would differ at their borders.
inline std::uint32_t updateImage(const RenderOptions& options, const Rgb& pixel) {
  return displayCode(pixel * std::exp2(options.exposure.ev), 1, options.toneCurve);
}

}  // namespace whit::reference
