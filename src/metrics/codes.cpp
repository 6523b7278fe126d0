#include "metrics/codes.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "core/error.h"

namespace whit {

namespace {

std::string describe(const Image& image) {
  const Crop& w = image.window;
  return std::to_string(image.width) + "x" + std::to_string(image.height) + " with pixels " +
         std::to_string(w.x0) + "," + std::to_string(w.y0) + "," + std::to_string(w.x1) + "," +
         std::to_string(w.y1);
}

}  // namespace

void checkComparable(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.window != b.window)
    throwUsage("expected two images of the same size and crop, found " + describe(a) + " and " +
               describe(b));
  if (a.pixels.empty()) throwUsage("expected images with at least one pixel");
}

std::vector<std::uint8_t> codeDifferences(const DisplayImage& a, const DisplayImage& b) {
  std::vector<std::uint8_t> differences(a.rgba.size() / 4);
  for (std::size_t i = 0; i < differences.size(); ++i) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(int{a.rgba[4 * i + c]} - int{b.rgba[4 * i + c]}));
    differences[i] = static_cast<std::uint8_t>(largest);
  }
  return differences;
}

}  // namespace whit
