// Which pixels of adaptive sampling get every sample: those whose first few differ, from one
// another or from those of the pixel next to them. The refinement of Whitted 1980 ("An improved
// illumination model for shaded display", section on aliasing), where a corner that pixels share
// tells each of them what begins at its border. The same rule for reference and kernels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "sampling/sample_pattern.h"

namespace whit {

// The probes of one pixel.
struct PixelProbes {
  std::array<std::uint32_t, kProbeSamples> codes{};  // as displayed: r | g << 8 | b << 16
  RgbD total;  // their sum, or their mean: for who goes on with more samples
};

class ProbeSamples {
 public:
  // Room for the window's pixels. `edges`, one a pixel: not 0 where probes are traced. They must
  // outlive the probes. The pattern is that of all samples, kProbeSamples or more.
  ProbeSamples(const Crop& window, const std::vector<std::uint8_t>& edges,
               const std::vector<Vec2f>& pattern);

  PixelProbes& at(int x, int y) { return samples_[index(x, y)]; }
  const PixelProbes& at(int x, int y) const { return samples_[index(x, y)]; }
  // True if the probes of this pixel and of its eight neighbors differ. All of them must have
  // probes.
  bool differ(int x, int y, int contrast) const;
  std::size_t bytes() const { return samples_.capacity() * sizeof(PixelProbes); }

 private:
  bool inside(int x, int y) const {
    return x >= window_.x0 && x < window_.x1 && y >= window_.y0 && y < window_.y1;
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - window_.y0) *
               static_cast<std::size_t>(window_.x1 - window_.x0) +
           static_cast<std::size_t>(x - window_.x0);
  }

  Crop window_;
  const std::vector<std::uint8_t>& edges_;
  std::array<std::size_t, 9> nearest_{};  // of each neighbor's probes, row by row
  std::vector<PixelProbes> samples_;
};

}  // namespace whit
