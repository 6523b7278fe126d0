// Exact spheres as Embree's user geometry: their boxes, and the hits of rays.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/alpha_filter.h"
#include "accel/embree_calls.h"
#include "bake/scene.h"
#include "simd/meet_sphere.h"

namespace whit {

// If a scene moves, its top-level scene holds only instances, and the first of them is the world.
inline constexpr unsigned kWorldId = 0;
inline bool isInWorld(unsigned instance) {
  return instance == RTC_INVALID_GEOMETRY_ID || instance == kWorldId;
}
// Returns the index into Scene::instances, or kNoInstance in the world, from Embree's instance id.
inline std::uint32_t instanceOf(unsigned id) {
  return isInWorld(id) ? kNoInstance : id - kFirstInstanceId;
}

// The spheres of one of the scene's geometries, in their order. A hit looks as if it were on the
// first triangle class of that geometry: the primitive's number is counted from there.
class SphereGeometry {
 public:
  // The scene and `masks`, one a material, must outlive it.
  SphereGeometry(const Scene& scene, const std::vector<Mask>& masks, const Geometry& of);

  // Makes `geometry`, which this object must outlive, answer for the spheres.
  void attachTo(RTCGeometry geometry);

  // Memory without that of Embree's boxes.
  std::uint64_t memoryBytes() const { return spheres_.capacity() * sizeof(Sphere); }

 private:
  struct Sphere {
    simd::SphereInverse inverse;
    const Mask* mask = nullptr;  // none: opaque everywhere
    bool castsShadow = true;
  };
  // The ids of a hit as Embree's packets hold them.
  struct HitId {
    unsigned instance, geometry, primitive;
  };

  static void bound(const RTCBoundsFunctionArguments* args);
  static void intersect(const RTCIntersectFunctionNArguments* args);
  static void occlude(const RTCOccludedFunctionNArguments* args);
  template <float Mask::*kCutoff, typename Accept>
  void meet(unsigned primitive, const EmbreeContext* context, float* words, unsigned width,
            const int* valid, const Accept& accept) const;
  static unsigned placeOf(unsigned instance);
  std::uint32_t numberOf(const HitId& hit) const;
  bool comesBefore(const HitId& sphere, const HitId& other) const;

  simd::SphereMeeter meeter_ = simd::findMeetSphere();
  const Scene& scene_;
  const TriangleRecord* records_ = nullptr;  // record of the first sphere
  std::uint32_t firstPrimitive_ = 0;         // number of the first sphere, counted as in hits
  std::vector<Sphere> spheres_;
};

}  // namespace whit
