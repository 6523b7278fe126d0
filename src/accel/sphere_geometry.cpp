#include "accel/sphere_geometry.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "bake/sphere.h"
#include "stages/packet_words.h"

namespace whit {

namespace {

constexpr std::size_t kWidestPacket = 16;

simd::SphereInverse inverseOf(const Affine& map) {
  const std::array<Vec3d, 3> rows = inverseRows(map);
  simd::SphereInverse inverse{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) inverse.rows[row][column] = rows[row][column];
    inverse.center[row] = map.p[row];
  }

  const auto& r = inverse.rows;
  inverse.diagonal =
      r[0][1] == 0 && r[0][2] == 0 && r[1][0] == 0 && r[1][2] == 0 && r[2][0] == 0 && r[2][1] == 0;
  return inverse;
}

// Copies the rays as they are in the world. On an instance, Embree hands over rays in the space of
// the instance, with the rounding of its processor.
void carryRays(const EmbreeContext* context, const float* words, unsigned width, const int* valid,
               float* to) {
  const auto* const ids = reinterpret_cast<const unsigned*>(words) + packet_column::id * width;
  for (unsigned i = 0; i < width; ++i) {
    for (std::size_t k = 0; k < 6 && valid[i] != 0; ++k) {
      const std::size_t column = k < 3 ? packet_column::orgX + k : packet_column::dirX + k - 3;
      to[column * width + i] = raysOf(context)[k][ids[i]];
    }
  }
}

}  // namespace

SphereGeometry::SphereGeometry(const Scene& scene, const std::vector<Mask>& masks,
                               const Geometry& of)
    : scene_(scene),
      records_(scene.triangles.data() + of.firstSphere),
      firstPrimitive_(of.firstSphere - of.firstTriangle) {
  spheres_.reserve(of.spheres);
  for (std::uint32_t i = 0; i < of.spheres; ++i) {
    const Material& material = scene.materials[records_[i].material];
    Sphere& sphere = spheres_.emplace_back();
    sphere.inverse = inverseOf(sphereMap(records_[i]));
    sphere.castsShadow = material.castsShadow;
    const Mask& mask = masks[records_[i].material];
    if (mask.map) sphere.mask = &mask;
  }
}

void SphereGeometry::attachTo(RTCGeometry geometry) {
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres_.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(geometry, bound, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occlude);
}

void SphereGeometry::bound(const RTCBoundsFunctionArguments* args) {
  const auto& own = *static_cast<const SphereGeometry*>(args->geometryUserPtr);
  const Box box = sphereBounds(sphereMap(own.records_[args->primID]));
  *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0,
                     box.upper.x, box.upper.y, box.upper.z, 0};
}

// Returns one number for the world, which is above those of all instances.
unsigned SphereGeometry::placeOf(unsigned instance) {
  return isInWorld(instance) ? RTC_INVALID_GEOMETRY_ID : instance;
}

// Returns the index of the sphere in Scene::triangles.
std::uint32_t SphereGeometry::numberOf(const HitId& hit) const {
  const std::uint32_t instance = instanceOf(hit.instance);
  const std::uint32_t geometry = instance == kNoInstance ? 0 : scene_.instances[instance].geometry;
  return scene_.geometries[geometry].firstTriangle + hit.primitive;
}

// True if a sphere is chosen instead of the sphere that the ray has hit at the same distance,
// possibly in another geometry, so that the order of the tests does not matter.
bool SphereGeometry::comesBefore(const HitId& sphere, const HitId& other) const {
  if (other.geometry != sphere.geometry) return false;
  const std::uint32_t own = numberOf(sphere), its = numberOf(other);
  return scene_.isSphere(its) && std::tie(sphere.instance, own) > std::tie(other.instance, its);
}

// Calls accept(ray, t, u, v) for each valid ray that hits the sphere within its tFar. A masked
// sphere may be cut where the ray enters it, and also where the ray leaves it.
template <float Mask::*kCutoff, typename Accept>
void SphereGeometry::meet(unsigned primitive, const EmbreeContext* context, float* words,
                          unsigned width, const int* valid, const Accept& accept) const {
  const Sphere& sphere = spheres_[primitive];
  const float* rays = words;
  const simd::SphereInverse* inverse = &sphere.inverse;
  simd::SphereInverse inverseInWorld;
  std::array<float, (packet_column::dirZ + 1) * kWidestPacket> inWorld;

  // On an instance, the test takes place in the world, so that Embree's rounding has no effect.
  const unsigned instance = context->instID[0];
  if (!isInWorld(instance)) {
    carryRays(context, words, width, valid, inWorld.data());
    rays = inWorld.data();
    const std::uint32_t number = numberOf({instance, 0, firstPrimitive_ + primitive});
    inverseInWorld = inverseOf(sphereInWorld(scene_, {number, instanceOf(instance)}));
    inverse = &inverseInWorld;
  }

  // A shadow ray needs the point that it hits only if a mask may cut it there.
  std::array<float, kWidestPacket> t, u, v;
  const bool asksWhere = kCutoff == &Mask::cutoff || sphere.mask;
  const simd::SphereHits hits{t.data(), asksWhere ? u.data() : nullptr, v.data()};
  const float* const tNear = words + packet_column::tNear * width;
  const float* const tFar = words + packet_column::tFar * width;
  std::uint32_t hitLanes = meeter_(*inverse, rays, width, valid, tNear, tFar, hits);

  const auto isCut = [&](unsigned i) {
    const auto [s, r] = sphereUv(spherePoint(double{u[i]}, double{v[i]}));
    return marginAt<kCutoff>(*sphere.mask, static_cast<float>(s), static_cast<float>(r)) < 0;
  };

  // Where the mask cuts the first hit, the ray goes on to the second.
  if (sphere.mask) {
    std::array<float, kWidestPacket> after{};
    for (unsigned i = 0; i < width; ++i) {
      const bool cut = (hitLanes >> i & 1) != 0 && isCut(i);
      after[i] = cut ? std::nextafter(t[i], std::numeric_limits<float>::infinity()) : tNear[i];
    }
    hitLanes = meeter_(*inverse, rays, width, valid, after.data(), tFar, hits);
  }

  for (; hitLanes != 0; hitLanes &= hitLanes - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(hitLanes));
    if (sphere.mask && isCut(i)) continue;
    accept(i, t[i], u[i], v[i]);
  }
}

void SphereGeometry::intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& own = *static_cast<const SphereGeometry*>(args->geometryUserPtr);
  const unsigned width = args->N;
  auto* const words = reinterpret_cast<float*>(args->rayhit);
  auto* const numbers = reinterpret_cast<unsigned*>(args->rayhit);
  const HitId here{placeOf(args->context->instID[0]), 0, own.firstPrimitive_ + args->primID};

  const auto put = [&](unsigned i, float t, float u, float v) {
    const auto number = [&](std::size_t column) -> unsigned& {
      return numbers[column * width + i];
    };
    float& tFar = words[packet_column::tFar * width + i];
    // Between spheres at one distance a fixed order decides, whichever of them Embree tests first.
    if (t == tFar) {
      const HitId before{placeOf(number(packet_column::instance)), number(packet_column::geometry),
                         number(packet_column::primitive)};
      if (!own.comesBefore(here, before)) return;
    }

    tFar = t;
    words[packet_column::u * width + i] = u;
    words[packet_column::v * width + i] = v;
    number(packet_column::instance) = here.instance;
    number(packet_column::geometry) = here.geometry;
    number(packet_column::primitive) = here.primitive;
  };

  own.meet<&Mask::cutoff>(args->primID, args->context, words, width, args->valid, put);
}

void SphereGeometry::occlude(const RTCOccludedFunctionNArguments* args) {
  const auto& own = *static_cast<const SphereGeometry*>(args->geometryUserPtr);
  if (!own.spheres_[args->primID].castsShadow) return;
  auto* const words = reinterpret_cast<float*>(args->ray);
  const unsigned width = args->N;

  // Embree takes a tFar of minus infinity as occlusion.
  own.meet<&Mask::shadowCutoff>(args->primID, args->context, words, width, args->valid,
                                [&](unsigned i, float, float, float) {
                                  words[packet_column::tFar * width + i] = -kInfinity;
                                });
}

}  // namespace whit
