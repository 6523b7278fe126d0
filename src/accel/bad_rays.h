// Rays that Embree cannot take: it ends the program at a NaN or beyond its range of coordinates
// (hard case H28).
#pragma once

#include <cmath>

namespace whit {

// As simd::packRays decides for packets. `reach` is that of the scene (EmbreeScene::reach).
inline bool isTraceable(float reach, float ox, float oy, float oz, float dx, float dy, float dz) {
  return std::fabs(ox) + std::fabs(oy) + std::fabs(oz) + std::fabs(dx) + std::fabs(dy) +
             std::fabs(dz) <=
         reach;
}

}  // namespace whit
