// Where the samples of a pixel lie: the same fixed pattern in every pixel, for reference and
// kernels alike, so that two renderings differ by arithmetic alone.
#pragma once

#include <vector>

#include "core/vec3.h"

namespace whit {

// Offsets in [0, 1)^2 from the pixel's top left corner. One sample: the centre. More: the R2
// sequence (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), centred.
inline std::vector<Vec2f> samplePattern(int spp) {
  if (spp == 1) return {{0.5f, 0.5f}};
  std::vector<Vec2f> samples;
  for (int i = 0; i < spp; ++i) {
    const double x = 0.5 + 0.75487766624669276005 * i, y = 0.5 + 0.56984029099805326591 * i;
    samples.push_back(
        {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))});
  }
  return samples;
}

}  // namespace whit
