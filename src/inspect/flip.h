// FLIP, for pictures as they are displayed (LDR-FLIP) and for linear ones (HDR-FLIP: P. Andersson,
// J. Nilsson, P. Shirley, T. Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic Range
// Images", Eurographics 2021 short papers).
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

// Computes FLIP for two encoded images of the same size.
std::vector<float> flipOfCodes(const DisplayImage& a, const DisplayImage& b);

// Both images are shown at a range of exposures that follows from the reference, tone mapped, and
// compared by FLIP; what counts is the worst exposure of each pixel. The range goes from where the
// reference's brightest pixel is just within the display to where its median pixel is: 0.85 after
// the ACES curve. Steps are at most one stop, and at least two. (Pixels without light are left out
// of the median, else a picture that is mostly black would have no last exposure.)
class HdrFlip {
 public:
  // Prepares the reference, whose pixels must be finite, once for all comparisons with it.
  explicit HdrFlip(const Image& reference);

  // Per pixel, in [0, 1]; of the reference's size and window, else Error(usage). A pixel that is
  // not finite counts as black.
  std::vector<float> map(const Image& image) const;
  double mean(const Image& image) const;

  const std::vector<double>& exposures() const { return exposures_; }  // EV

 private:
  Image shape_;  // without pixels
  std::vector<double> exposures_;
  std::vector<FlipSide> sides_;  // one an exposure
};

// The tone curve of HDR-FLIP: K. Narkowicz's fit of ACES (2016), without its exposure of 0.6,
// clamped to [0, 1].
double hdrFlipToneCurve(double x);

}  // namespace whit
