#pragma once

#include "core/image.h"

namespace whit {

// Every pixel of one color.
inline Image flat(int width, int height, const Rgb& color) {
  Image image(width, height);
  for (Rgb& pixel : image.pixels) pixel = color;
  return image;
}

}  // namespace whit
