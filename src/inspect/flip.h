// LDR-FLIP of pictures as they are displayed.
#pragma once

#include <vector>

#include "core/image.h"
#include "core/vec3.h"

namespace whit {

// The filtered channels that FLIP computes from one image.
struct FlipSide {
  std::vector<Vec3f> lab;          // filtered, Hunt-adjusted
  std::vector<float> edge, point;  // magnitudes of the features
};

// `pixels` are linear, in [0, 1], width * height of them.
FlipSide flipSide(const std::vector<Rgb>& pixels, int width, int height);
// FLIP per pixel of two images of the same size.
std::vector<float> flipBetween(const FlipSide& a, const FlipSide& b);

// Computes FLIP for two encoded images of the same size.
std::vector<float> flipOfCodes(const DisplayImage& a, const DisplayImage& b);

}  // namespace whit
