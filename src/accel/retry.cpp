// Rays that are traced once more, singly: those that found nothing, and those that met an edge.
#include <algorithm>
#include <cmath>

#include "accel/accel.h"

namespace whit {

namespace {

// Three directions next to `d`, each off by about a unit in the last place of its largest
// component, towards another side each.
Vec3f nudged(const Vec3f& d, int attempt) {
  const float step = maxComponent(abs(d)) * 0x1p-22f;
  Vec3f result = d;
  result[attempt] += d[attempt] < 0 ? -step : step;
  result[(attempt + 1) % 3] -= step;
  return result;
}

// Weight of a corner below which the hit is taken to lie on the edge opposite. Triangles that share
// the edge may both be met there, at distances whose difference is lost in rounding; seen from a
// thousand times their size away, rounding moves the edge by 1e-4 of it.
constexpr float kNearEdge = 0x1p-12f;

// Three comparisons without branches, so that compilers make vectors of them.
int isNearEdge(float u, float v) {
  return static_cast<int>(u < kNearEdge) | static_cast<int>(v < kNearEdge) |
         static_cast<int>(1 - u - v < kNearEdge);
}

// Hits that are looked at together before any is by itself.
constexpr std::size_t kRun = 4 * kBlock;

}  // namespace

// Which of several triangles at one distance stays depends on the order in which Embree tests them,
// which a packet's other rays change. A ray alone has but one order.
void Accel::settleEdges(const RayColumns& rays, std::size_t n,
                        const HitColumns& hits) const noexcept {
  for (std::size_t begin = 0; begin < n; begin += kRun) {
    const std::size_t end = std::min(n, begin + kRun);
    const float *const u = hits.u, *const v = hits.v;
    int any = 0;
    for (std::size_t i = begin; i < end; ++i) any |= isNearEdge(u[i], v[i]);
    if (any == 0) continue;
    for (std::size_t i = begin; i < end; ++i) {
      if (hits.triangle[i] == kMiss || isNearEdge(u[i], v[i]) == 0) continue;
      std::uint32_t instance = kMiss;
      const Vec3f origin{rays.orgX[i], rays.orgY[i], rays.orgZ[i]};
      const Vec3f direction{rays.dirX[i], rays.dirY[i], rays.dirZ[i]};
      if (!findHit(origin, direction, hits.triangle[i], instance, hits.t[i], hits.u[i],
                   hits.v[i])) {
        continue;
      }
      if (hits.instance) hits.instance[i] = instance;
    }
  }
}

void Accel::retryMisses(const RayColumns& rays, std::size_t n,
                        const HitColumns& hits) const noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    if (hits.triangle[i] != kMiss) continue;
    const Vec3f origin{rays.orgX[i], rays.orgY[i], rays.orgZ[i]};
    const Vec3f direction{rays.dirX[i], rays.dirY[i], rays.dirZ[i]};
    std::uint32_t instance = kMiss;
    if (!closest(origin, direction, hits.triangle[i], instance, hits.t[i], hits.u[i], hits.v[i])) {
      continue;
    }
    if (hits.instance) hits.instance[i] = instance;
  }
}

bool Accel::closest(const Vec3f& origin, const Vec3f& direction, std::uint32_t& triangle,
                    std::uint32_t& instance, float& t, float& u, float& v) const noexcept {
  if (findHit(origin, direction, triangle, instance, t, u, v)) return true;
  if (!enclosed_) return false;
  for (int attempt = 0; attempt < 3; ++attempt) {
    if (findHit(origin, nudged(direction, attempt), triangle, instance, t, u, v)) return true;
  }
  return false;
}

}  // namespace whit
