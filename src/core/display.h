// From linear radiance to 8-bit display codes: the transfer function of sRGB (IEC 61966-2-1) with
// its exact branches, and scalar post-processing, which is the reference of updateImage's encoding.
#pragma once

#include <array>
#include <span>

#include "core/image.h"
#include "core/options.h"

namespace whit {

// Linear light of an sRGB value in [0, 1] (a code divided by its largest).
double srgbToLinear(double code);
// And back; `linear` in [0, 1].
double linearToSrgb(double linear);

// Linear light of each 8-bit code, rounded to float.
std::array<float, 256> makeLinearOfCodes();
inline const std::array<float, 256>& linearOfCodes() {
  static const std::array<float, 256> table = makeLinearOfCodes();
  return table;
}
inline float linearOfCode(int code) { return entryOf(linearOfCodes(), code); }

// round(255 * srgb(x)) with x clamped to [0, 1]; NaN and negatives give 0.
int srgbCode(double linear);

// The least float of each code, for the vector encoder; the last is out of reach.
const std::array<float, 257>& leastWithCodes();

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
