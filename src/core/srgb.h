// The transfer function of sRGB (IEC 61966-2-1) with its exact branches, and its 8-bit codes.
#pragma once

#include <array>

namespace whit {

// Linear light of an sRGB value in [0, 1] (a code divided by its largest).
double srgbToLinear(double code);
// And back; `linear` in [0, 1].
double linearToSrgb(double linear);

// Linear light of an 8-bit code, rounded to float.
std::array<float, 256> makeLinearOfCode();
inline float linearOfCode(int code) {
  static const std::array<float, 256> table = makeLinearOfCode();
  return table[static_cast<std::size_t>(code)];
}

// round(255 * srgb(x)) with x clamped to [0, 1]; NaN and negatives give 0.
int srgbCode(double linear);

// The least float of each code, for the vector encoder; the last is out of reach.
const std::array<float, 257>& leastWithCodes();

}  // namespace whit
