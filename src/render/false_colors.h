// What was seen of each pixel, as a picture. Functions that choose a scale return its legend.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"

namespace whit {

struct WatchedPixel {
  Rgb sum{0, 0, 0};  // of `count` colors, or of amounts in x
  double count = 0;
};

// Mean colors; `linear`: to be encoded.
void paintColors(const std::vector<WatchedPixel>& pixels, bool linear, DisplayImage& display);
// Bright is near; what was not hit is black.
std::string paintDepth(const std::vector<WatchedPixel>& pixels, DisplayImage& display);

// Mean amounts of the pixels, a ray or a sample each.
std::vector<double> amountsOf(const std::vector<WatchedPixel>& pixels, double samples);
// Logarithmic: a few pixels take tens of times what most do.
std::string paintHeat(const std::vector<double>& amounts, const char* what, DisplayImage& display);
std::string paintShare(const std::vector<double>& shares, const char* what, DisplayImage& display);

}  // namespace whit
