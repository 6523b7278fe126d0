// updateImage: from the radiance of a pixel's samples to the codes that a display shows.
#pragma once

#include <cstdint>

#include "core/options.h"
#include "core/vec3.h"

namespace whit::reference {

// Sample `number`, counted from 1, into the mean of those before. A running mean: samples that are
// all equal give just that, without any rounding.
inline void addSample(RgbD& mean, const RgbD& sample, double number) {
  mean += (sample - mean) / number;
}

// r | g << 8 | b << 16, with exposure given as a factor.
std::uint32_t displayCode(const Rgb& pixel, double exposureScale, ToneCurve curve,
                          SrgbEncoding encoding);

// The row that the step writes for a pixel as the film keeps it. Exposure is a product of floats in
// both, or codes would differ by it at their borders.
std::uint32_t updateImage(const RenderOptions& options, const Rgb& pixel);

}  // namespace whit::reference
