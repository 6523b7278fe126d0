// Rays that Embree cannot take: it ends the program at a NaN or beyond its range of coordinates
// (hard case H28).
#pragma once

#include <cmath>

namespace whit {

// One sum, because nearly all rays are fine. `reach` is that of the scene (EmbreeScene::reach).
inline bool isTraceable(float reach, float ox, float oy, float oz, float dx, float dy, float dz) {
  return std::fabs(ox) + std::fabs(oy) + std::fabs(oz) + std::fabs(dx) + std::fabs(dy) +
             std::fabs(dz) <=
         reach;
}

// Replaces rays that are none by empty ones.
template <int kWidth, typename Ray>
void leaveOutBadRays(Ray& ray, float reach) {
  const auto traceable = [&](int lane) {
    return isTraceable(reach, ray.org_x[lane], ray.org_y[lane], ray.org_z[lane], ray.dir_x[lane],
                       ray.dir_y[lane], ray.dir_z[lane]);
  };
  int good = 0;
  for (int lane = 0; lane < kWidth; ++lane) good += traceable(lane);
  if (good == kWidth) return;
  for (int lane = 0; lane < kWidth; ++lane) {
    if (traceable(lane)) continue;
    // Where none can start: an empty ray finds nothing there.
    ray.org_x[lane] = ray.org_y[lane] = ray.org_z[lane] = 0.25f * reach;
    ray.dir_x[lane] = ray.dir_y[lane] = 0;
    ray.dir_z[lane] = 1;
    ray.tfar[lane] = -1;
  }
}

}  // namespace whit
