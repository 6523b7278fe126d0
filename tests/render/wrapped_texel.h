// Which texel lies at an index beyond the border.
#pragma once

#include <algorithm>

#include "scene/texture.h"

namespace whit::test {

// Mirrored coordinates are folded before they become indices, and never wrap.
inline int wrappedTexel(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return (i % size + size) % size;
  return std::clamp(i, 0, size - 1);
}

}  // namespace whit::test
