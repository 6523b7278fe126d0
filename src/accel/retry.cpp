// Rays that found nothing, once more.
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

}  // namespace

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
