// Where in a picture the dear pixels are: what blocks of it took to trace, as known from a coarser
// picture of the same.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/options.h"

namespace whit::view {

class CostMap {
 public:
  void clear() { cells_.fill(0); }

  // The samples of that part of a picture of so many pixels took `ms` each.
  void learn(const ImageSize& size, const Crop& block, double ms) {
    visit(size, block, 0, [&](double& cell) { cell = ms; });
  }
  // What the dearest sample in that part, or beside it, is likely to take; 0: not all is known.
  double highest(const ImageSize& size, const Crop& block) {
    double most = 0;
    bool known = true;
    visit(size, block, 1, [&](double& cell) {
      known &= cell > 0;
      most = std::max(most, cell);
    });
    return known ? most : 0;
  }

 private:
  static constexpr int kSide = 32;  // cells

  template <typename Use>
  void visit(const ImageSize& size, const Crop& block, int margin, const Use& use) {
    const auto cell = [](int pixel, int pixels) { return pixel * kSide / std::max(pixels, 1); };
    const auto inside = [](int index) { return std::clamp(index, 0, kSide - 1); };
    const int x0 = inside(cell(block.x0, size.width) - margin);
    const int x1 = inside(cell(block.x1 - 1, size.width) + margin);
    const int y0 = inside(cell(block.y0, size.height) - margin);
    const int y1 = inside(cell(block.y1 - 1, size.height) + margin);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) use(cells_[at(x, y)]);
    }
  }

  static std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x);
  }

  std::array<double, std::size_t{kSide} * kSide> cells_{};
};

}  // namespace whit::view
