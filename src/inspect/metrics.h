// Measures of the difference between two images.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/options.h"

namespace whit {

struct ImageDifference {
  // The linear means, and energyRatio, leave out the pixels that nonFinite counts.
  double rmse = 0;      // linear, over all channels
  double relmse = 0;    // mean of (a - b)^2 / (b^2 + 1e-2) (pbrt's imgtool)
  double psnrDb = 0;    // PSNR of the 8-bit encoded images; infinite when equal
  double flipMean = 0;  // LDR-FLIP (Andersson et al. 2020), 67 pixels a degree
  int maxCode = 0;      // 8-bit sRGB steps, largest channel difference
  double pixelsGe1CodePct = 0, pixelsGe2CodesPct = 0;
  double energyRatio = 1;          // mean(a) / mean(b); infinite when only b is black
  std::uint64_t nonFinite = 0;     // pixels of either image with a NaN or an infinity
  std::uint64_t incomparable = 0;  // of these, pixels that are not equal; two NaN are
};

// `b` is the reference. Sizes and windows must match and hold a pixel, else Error(usage). Exposure
// and tone curve as given are applied before anything that looks at codes.
ImageDifference compareImages(const Image& a, const Image& b, float exposure = 0,
                              ToneCurve curve = ToneCurve::none);

// Returns the largest difference of a channel for each pixel, in codes.
std::vector<std::uint8_t> codeDifferences(const DisplayImage& a, const DisplayImage& b);
// Paints the difference of each pixel, in the codes that compareImages() counts, with
// heatOfCodes().
DisplayImage heatMap(const Image& a, const Image& b, float exposure, ToneCurve curve);
// Returns the color of a difference in codes, on a logarithmic scale from 0 to kHeatCodes; larger
// differences have the last color.
std::array<std::uint8_t, 3> heatOfCodes(int codes);
inline constexpr int kHeatCodes = 16;
// Returns the 8-bit sRGB color at t in [0, 1]: from black over violet and orange to light yellow,
// with a lightness that grows all the way.
std::array<std::uint8_t, 3> heatColor(double t);

// Measures of the difference between two columns of values, a pixel each.
struct ValueDifference {
  std::uint64_t differing = 0;     // pixels whose values are not equal; two NaN are
  std::uint64_t incomparable = 0;  // number of values that are not finite
  double largest = 0, rms = 0;     // differences of all others; 0 for numbers
};

// Both have the same length.
ValueDifference differenceOf(std::span<const float> a, std::span<const float> b);
ValueDifference differenceOf(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b);

// Computes FLIP (LDR-FLIP) for two encoded images, as they are displayed, of the same size.
std::vector<float> flipOfCodes(const DisplayImage& first, const DisplayImage& second);

}  // namespace whit
