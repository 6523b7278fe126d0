// Scalar post-processing: from linear radiance to what the film keeps of it, and to 8-bit display
// codes. The scalar reference of updateImage's encoding.
#pragma once

#include <array>

#include "core/image.h"
#include "core/options.h"
#include "core/srgb.h"

namespace whit {

// The nearest half (IEEE 754 binary16, ties to even) as a float. What is finite stays finite: at
// most 65504.
float roundedToHalf(float x);

// A pixel as the film keeps it. 8-bit film holds nothing outside [0, 1], and no NaN.
Rgb quantized(FilmPrecision precision, const Rgb& pixel);

// Tone curve on linear values at or above 0. `none` is the identity, reinhard x / (1 + x), filmic
// Hable's curve as published by J. Hable, "Filmic Tonemapping Operators" (2010), white point 11.2.
double applyToneCurve(ToneCurve curve, double x);

// One pixel's codes, with exposure given as a factor.
std::array<std::uint8_t, 3> displayCodes(const Rgb& pixel, double exposureScale, ToneCurve curve,
                                         SrgbEncoding encoding);

// Exposure (2^EV), tone curve, encoding. The window's pixels only.
DisplayImage toDisplay(const Image& image, float exposure, ToneCurve curve,
                       SrgbEncoding encoding = SrgbEncoding::exact);

}  // namespace whit
