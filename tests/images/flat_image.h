#pragma once

#include "core/image.h"

namespace whit {

// Every pixel of one colour.
inline Image flat(int width, int height, const Rgb& colour) {
  Image image(width, height);
  for (Rgb& pixel : image.pixels) pixel = colour;
  return image;
}

}  // namespace whit
