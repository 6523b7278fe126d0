// Draws one value per pixel as a picture in false colors.
#pragma once

#include <string>
#include <vector>

#include "core/effects.h"
#include "core/image.h"

namespace whit {

struct WatchedPixel {
  Rgb sum{0, 0, 0};  // of `count` colors, or of amounts in x
  double count = 0;
  EffectSet effects;  // of all that was met, where those are watched
};

// The amounts that have the first and the last of the colors.
struct AmountScale {
  double low = 0, high = 0;
};

// Mean colors; `linear`: to be encoded.
void paintColors(const std::vector<WatchedPixel>& pixels, bool linear, DisplayImage& display);

// Distances: bright is near; what was not hit is black.
AmountScale depthScale(const std::vector<WatchedPixel>& pixels);
void paintDepth(const std::vector<WatchedPixel>& pixels, const AmountScale& scale,
                DisplayImage& display);
// The gray of a share of the way from the nearest to the farthest.
float depthGray(double share);

// Mean amounts of the pixels, a ray or a sample each.
std::vector<double> amountsOf(const std::vector<WatchedPixel>& pixels, double samples);
// Logarithmic: a few pixels take tens of times what most do.
AmountScale heatScale(const std::vector<double>& amounts);
void paintHeat(const std::vector<double>& amounts, const AmountScale& scale, DisplayImage& display);
void paintShare(const std::vector<double>& shares, DisplayImage& display);

}  // namespace whit
