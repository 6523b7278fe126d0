// Embree's packet types and calls by width, and whatever differs between its major versions.
#pragma once

#include <cstddef>

#if WHIT_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace whit {

template <int kWidth>
struct PacketTypes;
template <>
struct PacketTypes<4> {
  using RayHit = RTCRayHit4;
  using Ray = RTCRay4;
};
template <>
struct PacketTypes<8> {
  using RayHit = RTCRayHit8;
  using Ray = RTCRay8;
};
template <>
struct PacketTypes<16> {
  using RayHit = RTCRayHit16;
  using Ray = RTCRay16;
};

#if WHIT_EMBREE_MAJOR == 4

class QueryContext {
 public:
  explicit QueryContext(bool coherent) {
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    intersect_.flags = occluded_.flags =
        coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  }
  RTCIntersectArguments* intersect() { return &intersect_; }
  RTCOccludedArguments* occluded() { return &occluded_; }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
};

inline void intersect(const int*, RTCScene s, QueryContext& c, RTCRayHit& r) {
  rtcIntersect1(s, &r, c.intersect());
}
inline void intersect(const int* valid, RTCScene s, QueryContext& c, RTCRayHit4& r) {
  rtcIntersect4(valid, s, &r, c.intersect());
}
inline void intersect(const int* valid, RTCScene s, QueryContext& c, RTCRayHit8& r) {
  rtcIntersect8(valid, s, &r, c.intersect());
}
inline void intersect(const int* valid, RTCScene s, QueryContext& c, RTCRayHit16& r) {
  rtcIntersect16(valid, s, &r, c.intersect());
}
inline void occluded(const int*, RTCScene s, QueryContext& c, RTCRay& r) {
  rtcOccluded1(s, &r, c.occluded());
}
inline void occluded(const int* valid, RTCScene s, QueryContext& c, RTCRay4& r) {
  rtcOccluded4(valid, s, &r, c.occluded());
}
inline void occluded(const int* valid, RTCScene s, QueryContext& c, RTCRay8& r) {
  rtcOccluded8(valid, s, &r, c.occluded());
}
inline void occluded(const int* valid, RTCScene s, QueryContext& c, RTCRay16& r) {
  rtcOccluded16(valid, s, &r, c.occluded());
}

// Embree 4 has no streams.
inline constexpr bool kStreams = false;
template <typename Packet>
void intersectStream(RTCScene, QueryContext&, Packet*, int, std::size_t) {}
template <typename Packet>
void occludedStream(RTCScene, QueryContext&, Packet*, int, std::size_t) {}

#else

class QueryContext {
 public:
  explicit QueryContext(bool coherent) {
    rtcInitIntersectContext(&context_);
    context_.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  RTCIntersectContext* get() { return &context_; }

 private:
  RTCIntersectContext context_;
};

inline void intersect(const int*, RTCScene s, QueryContext& c, RTCRayHit& r) {
  rtcIntersect1(s, c.get(), &r);
}
inline void intersect(const int* valid, RTCScene s, QueryContext& c, RTCRayHit4& r) {
  rtcIntersect4(valid, s, c.get(), &r);
}
inline void intersect(const int* valid, RTCScene s, QueryContext& c, RTCRayHit8& r) {
  rtcIntersect8(valid, s, c.get(), &r);
}
inline void intersect(const int* valid, RTCScene s, QueryContext& c, RTCRayHit16& r) {
  rtcIntersect16(valid, s, c.get(), &r);
}
inline void occluded(const int*, RTCScene s, QueryContext& c, RTCRay& r) {
  rtcOccluded1(s, c.get(), &r);
}
inline void occluded(const int* valid, RTCScene s, QueryContext& c, RTCRay4& r) {
  rtcOccluded4(valid, s, c.get(), &r);
}
inline void occluded(const int* valid, RTCScene s, QueryContext& c, RTCRay8& r) {
  rtcOccluded8(valid, s, c.get(), &r);
}
inline void occluded(const int* valid, RTCScene s, QueryContext& c, RTCRay16& r) {
  rtcOccluded16(valid, s, c.get(), &r);
}

inline constexpr bool kStreams = true;
template <typename Packet>
void intersectStream(RTCScene s, QueryContext& c, Packet* packets, int width, std::size_t n) {
  rtcIntersectNM(s, c.get(), reinterpret_cast<RTCRayHitN*>(packets), static_cast<unsigned>(width),
                 static_cast<unsigned>(n), sizeof(Packet));
}
template <typename Packet>
void occludedStream(RTCScene s, QueryContext& c, Packet* packets, int width, std::size_t n) {
  rtcOccludedNM(s, c.get(), reinterpret_cast<RTCRayN*>(packets), static_cast<unsigned>(width),
                static_cast<unsigned>(n), sizeof(Packet));
}

#endif

// The lanes of a packet that are traced, -1, and the others, 0, whose rays are empty.
template <int kWidth>
struct alignas(64) Lanes {
  int live[kWidth];
};

// n packets of one ray kind, one after the other. `together`: by Embree's stream calls, which lead
// several packets of coherent rays through the BVH at once and find the same hits.
template <int kWidth, typename Packet>
void intersectAll(const Lanes<kWidth>* lanes, RTCScene scene, QueryContext& context, bool together,
                  Packet* packets, std::size_t n) {
  if (together) return intersectStream(scene, context, packets, kWidth, n);
  for (std::size_t p = 0; p < n; ++p) intersect(lanes[p].live, scene, context, packets[p]);
}
template <int kWidth, typename Packet>
void occludedAll(const Lanes<kWidth>* lanes, RTCScene scene, QueryContext& context, bool together,
                 Packet* packets, std::size_t n) {
  if (together) return occludedStream(scene, context, packets, kWidth, n);
  for (std::size_t p = 0; p < n; ++p) occluded(lanes[p].live, scene, context, packets[p]);
}

}  // namespace whit
