// A linear RGB picture, or a crop of one, and places of pixels in it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/index.h"
#include "core/options.h"
#include "core/vec3.h"

namespace whit {

// `window` is the part of the width x height image that `pixels` holds, row by row from the top.
struct Image {
  int width = 0, height = 0;
  Crop window;
  std::vector<Rgb> pixels;

  Image() = default;
  Image(int w, int h) : Image(w, h, Crop{0, 0, w, h}) {}
  Image(int w, int h, const Crop& c)
      : width(w), height(h), window(c), pixels(cellsOf(c.x1 - c.x0, c.y1 - c.y0)) {}

  int windowWidth() const { return window.x1 - window.x0; }
  int windowHeight() const { return window.y1 - window.y0; }
  // x, y in image coordinates, inside the window.
  std::size_t index(int x, int y) const {
    return cellAt(x - window.x0, y - window.y0, windowWidth());
  }
  Rgb& at(int x, int y) { return pixels[index(x, y)]; }
  const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }
};

// 8-bit sRGB, RGBA, row by row from the top.
struct DisplayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
  bool hasAlpha = false;  // else it is opaque
};

// A pixel's place in the image as one number, as the queues of the pipeline carry it: images are at
// most kImageSideLimit, 2^16, wide and high.
constexpr std::uint32_t packedPixel(int x, int y) {
  return static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << 16;
}
constexpr int pixelX(std::uint32_t pixel) { return static_cast<int>(pixel & 0xFFFFu); }
constexpr int pixelY(std::uint32_t pixel) { return static_cast<int>(pixel >> 16); }

}  // namespace whit
