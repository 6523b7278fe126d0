// Columns of rays through Embree in packets of kWidth: 4, 8 or 16. The last packet of a column may
// have empty lanes.
#pragma once

#include <chrono>
#include <cstddef>

#include "accel/accel.h"
#include "accel/embree_scene.h"

namespace whit {

// Packets are filled, traced and emptied in groups of this many rays, so that the clock around
// Embree's calls is read rarely and sees nothing but them.
inline constexpr std::size_t kGroup = 128;

using TraceClock = std::chrono::steady_clock;

inline double millisecondsSince(TraceClock::time_point start) {
  return std::chrono::duration<double, std::milli>(TraceClock::now() - start).count();
}

template <int kWidth>
void traceHits(const EmbreeScene& scene, const RayColumns& rays, std::size_t n, bool coherent,
               const HitColumns& hits, TraceMeter& meter);
template <int kWidth>
void traceShadows(const EmbreeScene& scene, const ShadowColumns& shadows, std::size_t n,
                  bool coherent, float* visible, TraceMeter& meter);

}  // namespace whit
