#include "accel/single_rays.h"

#include <cmath>
#include <limits>

namespace whit {

namespace {

// An empty ray, from where no triangle is, in the place of one that Embree cannot take.
RTCRay traceableRay(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction,
                    float tFar, unsigned mask) {
  const float reach = scene.reach();
  if (isTraceable(reach, origin, direction)) return singleRay(origin, direction, tFar, mask);
  const float place = 0.25f * reach;
  return singleRay({place, place, place}, {0, 0, 1}, -1, mask);
}

}  // namespace

bool isTraceable(float reach, const Vec3f& origin, const Vec3f& direction) {
  return std::fabs(origin.x) + std::fabs(origin.y) + std::fabs(origin.z) + std::fabs(direction.x) +
             std::fabs(direction.y) + std::fabs(direction.z) <=
         reach;
}

RTCRay singleRay(const Vec3f& origin, const Vec3f& direction, float tFar, unsigned mask) {
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = tFar;
  ray.mask = mask;
  return ray;
}

RTCRayHit withoutHit(const RTCRay& ray) {
  RTCRayHit rayHit{};
  rayHit.ray = ray;
  rayHit.hit.geomID = rayHit.hit.primID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return rayHit;
}

Hit findHit(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction, bool coherent,
            float tNear) noexcept {
  constexpr float kUnbounded = std::numeric_limits<float>::infinity();
  RTCRayHit r = withoutHit(traceableRay(scene, origin, direction, kUnbounded, kSeenMask));
  r.ray.tnear = tNear;
  QueryContext context(coherent);
  intersect(nullptr, scene.top(), context, r);
  const Hit miss{kMiss, kMiss, r.ray.tfar, r.hit.u, r.hit.v};
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return miss;
  return {scene.triangleOf(r.hit.instID[0], r.hit.geomID, r.hit.primID),
          scene.instanceOf(r.hit.instID[0]), r.ray.tfar, r.hit.u, r.hit.v};
}

bool isOccluded(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction, float tFar,
                bool coherent) noexcept {
  RTCRay ray = traceableRay(scene, origin, direction, tFar, kShadowMask);
  QueryContext context(coherent);
  occluded(nullptr, scene.top(), context, ray);
  return !(ray.tfar >= 0);
}

}  // namespace whit
