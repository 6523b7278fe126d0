// Rays through Embree one by one: packets of one, the reference's, and those that are traced once
// more.
#pragma once

#include "accel/accel.h"
#include "accel/embree_scene.h"

namespace whit {

// As packRays decides for packets (simd/kernels.h): Embree ends the program at a NaN or beyond its
// range of coordinates (hard case H28). `reach` is that of the scene (EmbreeScene::reach).
bool isTraceable(float reach, const Vec3f& origin, const Vec3f& direction);

RTCRay singleRay(const Vec3f& origin, const Vec3f& direction, float tFar, unsigned mask);
RTCRayHit withoutHit(const RTCRay& ray);

Hit findHit(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction,
            bool coherent = false, float tNear = 0) noexcept;
bool isOccluded(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction, float tFar,
                bool coherent = false) noexcept;

// Takes the rays from columns.
template <typename Columns>
Vec3f originAt(const Columns& c, std::size_t i) {
  return {c.orgX[i], c.orgY[i], c.orgZ[i]};
}
template <typename Columns>
Vec3f directionAt(const Columns& c, std::size_t i) {
  return {c.dirX[i], c.dirY[i], c.dirZ[i]};
}

}  // namespace whit
