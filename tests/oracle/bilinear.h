// The pixels of an image, and lookups between them.
#pragma once

#include "oracle/vector.h"

namespace oracle {

// Calls visit(x, y) for every pixel of a picture, row by row.
template <typename Visit>
void forEachPixel(int width, int height, const Visit& visit) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) visit(x, y);
  }
}

inline Color mix(const Color& a, const Color& b, double t) { return a * (1 - t) + b * t; }

inline int wrapped(int i, int count) { return ((i % count) + count) % count; }

// texel(x, y) at (x, y), in texels whose centers lie at half-integers.
template <typename Texel>
Color bilinear(double x, double y, const Texel& texel) {
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  const double s = x - 0.5 - left, t = y - 0.5 - top;
  return mix(mix(texel(i, j), texel(i + 1, j), s), mix(texel(i, j + 1), texel(i + 1, j + 1), s), t);
}

}  // namespace oracle
