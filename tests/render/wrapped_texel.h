// Indices of texels beyond the border.
#pragma once

#include <algorithm>

#include "scene/texture.h"

namespace whit::test {

// Returns the index of the texel in the place of `i`. Mirrored coordinates are folded before they
// become indices, and never wrap.
inline int wrappedTexel(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return (i % size + size) % size;
  return std::clamp(i, 0, size - 1);
}

}  // namespace whit::test
