#include "inspect/hdr_flip.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/quantile.h"
#include "core/vec3.h"
#include "inspect/metrics.h"

namespace whit {

namespace {

// (a x^2 + b x) / (c x^2 + d x + e), the fit's constants for x / 0.6.
constexpr double kA = 0.6 * 0.6 * 2.51, kB = 0.6 * 0.03, kC = 0.6 * 0.6 * 2.43, kD = 0.6 * 0.59,
                 kE = 0.14;
constexpr double kTarget = 0.85;  // of full scale

// Where the curve reaches the target: the larger root of (a - tc) x^2 + (b - td) x - te.
double inputForTarget() {
  const double a = kA - kTarget * kC, b = kB - kTarget * kD, c = -kTarget * kE;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

std::vector<double> exposuresFor(const Image& reference) {
  std::vector<double> lit;
  for (const Rgb& pixel : reference.pixels) {
    const double y = luminance(pixel);
    if (std::isfinite(y) && y > 0) lit.push_back(y);
  }
  if (lit.empty()) return {0, 0};
  const double target = inputForTarget();
  const double start = std::log2(target / quantile(lit, 1));
  const double stop = std::log2(target / quantile(lit, 0.5));
  const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
  std::vector<double> exposures;
  exposures.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) exposures.push_back(start + (stop - start) * i / (count - 1));
  return exposures;
}

FlipSide sideAt(const Image& image, double exposure) {
  const double scale = std::exp2(exposure);
  std::vector<Rgb> shown(image.pixels.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (!isFinite(image.pixels[i])) continue;
    for (int c = 0; c < 3; ++c) {
      const double x = static_cast<double>(image.pixels[i][c]);
      shown[i][c] = static_cast<float>(hdrFlipToneCurve(scale * x));
    }
  }
  return flipSide(shown, image.windowWidth(), image.windowHeight());
}

}  // namespace

double hdrFlipToneCurve(double x) {
  const double y = std::max(x, 0.0);
  return std::clamp((kA * y * y + kB * y) / (kC * y * y + kD * y + kE), 0.0, 1.0);
}

HdrFlip::HdrFlip(const Image& reference) : exposures_(exposuresFor(reference)) {
  checkComparable(reference, reference);
  shape_.width = reference.width;
  shape_.height = reference.height;
  shape_.window = reference.window;
  for (const double exposure : exposures_) sides_.push_back(sideAt(reference, exposure));
}

std::vector<float> HdrFlip::map(const Image& image) const {
  if (image.width != shape_.width || image.height != shape_.height ||
      image.window != shape_.window) {
    throwUsage("HDR-FLIP expected an image of the reference's size and crop");
  }
  std::vector<float> worst(image.pixels.size());
  for (std::size_t k = 0; k < exposures_.size(); ++k) {
    const std::vector<float> flip = flipBetween(sideAt(image, exposures_[k]), sides_[k]);
    for (std::size_t i = 0; i < worst.size(); ++i) worst[i] = std::max(worst[i], flip[i]);
  }
  return worst;
}

double HdrFlip::mean(const Image& image) const {
  const std::vector<float> flip = map(image);
  return std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
}

}  // namespace whit
