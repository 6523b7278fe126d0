// Embree's packet types and calls by width, and whatever differs between its major versions.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#if WHIT_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "core/vec3.h"
#include "stages/packet_words.h"

namespace whit {

// Packets of this width, with and without hits.
template <int kWidth>
using RayHits = std::conditional_t<kWidth == 4, RTCRayHit4,
                                   std::conditional_t<kWidth == 8, RTCRayHit8, RTCRayHit16>>;
template <int kWidth>
using Rays =
    std::conditional_t<kWidth == 4, RTCRay4, std::conditional_t<kWidth == 8, RTCRay8, RTCRay16>>;

// Kernels find the columns of a packet in these places.
constexpr bool isColumn(std::size_t offset, std::size_t column) {
  return offset == column * 8 * sizeof(float);
}
static_assert(isColumn(offsetof(RTCRay8, org_x), packet_column::orgX) &&
              isColumn(offsetof(RTCRay8, tnear), packet_column::tNear) &&
              isColumn(offsetof(RTCRay8, dir_x), packet_column::dirX) &&
              isColumn(offsetof(RTCRay8, tfar), packet_column::tFar) &&
              isColumn(offsetof(RTCRay8, id), packet_column::id) &&
              isColumn(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, u), packet_column::u) &&
              isColumn(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, geomID),
                       packet_column::geometry) &&
              isColumn(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, instID),
                       packet_column::instance));

// Embree's function for a packet: closest hits if there is room for them, otherwise any hit.
template <typename Packet>
inline constexpr auto kCall = nullptr;
template <>
inline constexpr auto kCall<RTCRayHit> = rtcIntersect1;
template <>
inline constexpr auto kCall<RTCRayHit4> = rtcIntersect4;
template <>
inline constexpr auto kCall<RTCRayHit8> = rtcIntersect8;
template <>
inline constexpr auto kCall<RTCRayHit16> = rtcIntersect16;
template <>
inline constexpr auto kCall<RTCRay> = rtcOccluded1;
template <>
inline constexpr auto kCall<RTCRay4> = rtcOccluded4;
template <>
inline constexpr auto kCall<RTCRay8> = rtcOccluded8;
template <>
inline constexpr auto kCall<RTCRay16> = rtcOccluded16;
template <typename Packet>
inline constexpr bool kWantsHits = requires(Packet packet) {
  packet.hit;
};

// The columns of a query's rays in world space, three of origins and three of directions. On an
// instance, Embree's callbacks get transformed rays, which other processors round differently. A
// ray's id is its index in the columns.
#if WHIT_EMBREE_MAJOR == 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif
struct ContextWithRays : EmbreeContext {
  std::array<const float*, 6> rays;
  void* batch;  // a RayBatch in place of the columns (query_batch.h)
};
inline const std::array<const float*, 6>& raysOf(const EmbreeContext* context) {
  return static_cast<const ContextWithRays*>(context)->rays;
}
inline void* batchOf(const EmbreeContext* context) {
  return static_cast<const ContextWithRays*>(context)->batch;
}

// Traces coherent or incoherent rays. A packet comes with the mask of its active lanes; the ids of
// its rays are indices into the columns that were set last.
class QueryContext {
 public:
  template <typename Columns>
  void setRays(const Columns& c) {
    context_.rays = {c.org.x, c.org.y, c.org.z, c.dir.x, c.dir.y, c.dir.z};
  }
  void setRay(const Vec3f& o, const Vec3f& d) {
    context_.rays = {&o.x, &o.y, &o.z, &d.x, &d.y, &d.z};
  }
  void setBatch(void* batch) { context_.batch = batch; }

#if WHIT_EMBREE_MAJOR == 4
  explicit QueryContext(bool coherent) {
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    rtcInitRayQueryContext(&context_);
    intersect_.context = occluded_.context = &context_;
    intersect_.flags = occluded_.flags =
        coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  }

  QueryContext(const QueryContext&) = delete;
  QueryContext& operator=(const QueryContext&) = delete;

  template <typename Packet, typename... Live>
  void trace(RTCScene scene, Packet& rays, Live... live) {
    if constexpr (kWantsHits<Packet>) {
      kCall<Packet>(live..., scene, &rays, &intersect_);
    } else {
      kCall<Packet>(live..., scene, &rays, &occluded_);
    }
  }

  static constexpr bool kStreams = false;
  template <typename Packet>
  void traceStream(RTCScene, Packet*, int, std::size_t) {}

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
#else
  explicit QueryContext(bool coherent) {
    rtcInitIntersectContext(&context_);
    context_.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }

  template <typename Packet, typename... Live>
  void trace(RTCScene scene, Packet& rays, Live... live) {
    kCall<Packet>(live..., scene, &context_, &rays);
  }

  // Leads n packets of coherent rays through the BVH together and finds the same hits.
  static constexpr bool kStreams = true;
  template <typename Packet>
  void traceStream(RTCScene scene, Packet* packets, int width, std::size_t n) {
    const auto w = static_cast<unsigned>(width), count = static_cast<unsigned>(n);
    if constexpr (kWantsHits<Packet>) {
      auto* const rays = reinterpret_cast<RTCRayHitN*>(packets);
      rtcIntersectNM(scene, &context_, rays, w, count, sizeof(Packet));
    } else {
      auto* const rays = reinterpret_cast<RTCRayN*>(packets);
      rtcOccludedNM(scene, &context_, rays, w, count, sizeof(Packet));
    }
  }

 private:
#endif
  ContextWithRays context_;
};

}  // namespace whit
