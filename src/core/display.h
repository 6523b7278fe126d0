// Scalar post-processing: from linear radiance to 8-bit display codes. The scalar reference of
// updateImage's encoding.
#pragma once

#include <array>
#include <span>

#include "core/image.h"
#include "core/options.h"
#include "core/srgb.h"

namespace whit {

// Tone curve on linear values at or above 0. `none` is the identity, reinhard x / (1 + x), filmic
// Hable's curve as published by J. Hable, "Filmic Tonemapping Operators" (2010), white point 11.2.
double applyToneCurve(ToneCurve curve, double x);

// One pixel's codes, with exposure given as a factor.
std::array<std::uint8_t, 3> displayCodes(const Rgb& pixel, double exposureScale, ToneCurve curve);

// Exposure (2^EV), tone curve, encoding. The window's pixels only.
DisplayImage toDisplay(const Image& image, float exposure, ToneCurve curve);

// The same before the background of the options; the image is black where `alpha`, the share of
// each pixel that surfaces cover, is 0. Transparent pixels are not multiplied by their alpha.
DisplayImage overBackground(const Image& image, std::span<const float> alpha,
                            const RenderOptions& options);

}  // namespace whit
