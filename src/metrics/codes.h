// 8-bit display codes of two images, side by side; private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace whit {

// Throws Error(usage) unless sizes and windows match and there are pixels.
void checkComparable(const Image& a, const Image& b);

// Per pixel, the largest difference of a channel of the encoded images, in codes.
std::vector<std::uint8_t> codeDifferences(const DisplayImage& a, const DisplayImage& b);

// LDR-FLIP of two encoded images of the same size.
std::vector<float> flipOfCodes(const DisplayImage& a, const DisplayImage& b);

}  // namespace whit
