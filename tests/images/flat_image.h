#pragma once

#include "core/image.h"

namespace whit {

// Makes an image whose pixels all have one color.
inline Image flat(int width, int height, const Rgb& color) {
  Image image(width, height);
  for (Rgb& pixel : image.pixels) pixel = color;
  return image;
}

}  // namespace whit
