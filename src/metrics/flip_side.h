// What FLIP sees of one image; private to this folder.
#pragma once

#include <vector>

#include "core/vec3.h"

namespace whit {

struct FlipSide {
  std::vector<Vec3f> lab;          // filtered, Hunt-adjusted
  std::vector<float> edge, point;  // magnitudes of the features
};

// `pixels` are linear, in [0, 1], width * height of them.
FlipSide flipSide(const std::vector<Rgb>& pixels, int width, int height);
// FLIP per pixel of two images of the same size.
std::vector<float> flipBetween(const FlipSide& a, const FlipSide& b);

}  // namespace whit
