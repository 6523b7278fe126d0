// Rays that Embree cannot take: it ends the program at a NaN or beyond its range of coordinates
// (numerics H28).
#pragma once

#include <cmath>
#include <cstddef>

#include "scene/scene.h"

namespace whit {

// Where empty rays start, so that they find nothing.
inline constexpr float kNowhere = 0.25f * kLargestCoordinate;

// One sum, because nearly all rays are fine.
inline bool isTraceable(float ox, float oy, float oz, float dx, float dy, float dz) {
  return std::fabs(ox) + std::fabs(oy) + std::fabs(oz) + std::fabs(dx) + std::fabs(dy) +
             std::fabs(dz) <=
         kLargestCoordinate;
}

// Replaces rays that are none by empty ones.
template <int kWidth, typename Ray>
void leaveOutBadRays(Ray& ray) {
  const auto traceable = [&](int lane) {
    return isTraceable(ray.org_x[lane], ray.org_y[lane], ray.org_z[lane], ray.dir_x[lane],
                       ray.dir_y[lane], ray.dir_z[lane]);
  };
  int good = 0;
  for (int lane = 0; lane < kWidth; ++lane) good += traceable(lane);
  if (good == kWidth) return;
  for (int lane = 0; lane < kWidth; ++lane) {
    if (traceable(lane)) continue;
    ray.org_x[lane] = ray.org_y[lane] = ray.org_z[lane] = kNowhere;
    ray.dir_x[lane] = ray.dir_y[lane] = 0;
    ray.dir_z[lane] = 1;
    ray.tfar[lane] = -1;
  }
}

}  // namespace whit
