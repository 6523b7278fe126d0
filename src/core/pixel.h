// A pixel's place in the image as one number, as the queues of the pipeline carry it: images are at
// most kImageSideLimit, 2^16, wide and high.
#pragma once

#include <cstdint>

namespace whit {

constexpr std::uint32_t packedPixel(int x, int y) {
  return static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << 16;
}
constexpr int pixelX(std::uint32_t pixel) { return static_cast<int>(pixel & 0xFFFFu); }
constexpr int pixelY(std::uint32_t pixel) { return static_cast<int>(pixel >> 16); }

}  // namespace whit
