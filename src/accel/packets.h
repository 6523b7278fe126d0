// Embree's packets, made ready for rays that kernels pack (simd/kernels.h).
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

#include "accel/embree_calls.h"
#include "stages/packet_words.h"

namespace whit {

// Where in a packet kernels look for its columns.
template <int kWidth>
constexpr bool columnsAreWhereKernelsLook() {
  using RayHit = typename PacketTypes<kWidth>::RayHit;
  using Ray = typename PacketTypes<kWidth>::Ray;
  using Hit = decltype(RayHit::hit);
  const auto isAt = [](std::size_t offset, std::size_t column) {
    return offset == column * kWidth * sizeof(float);
  };
  const std::size_t hit = offsetof(RayHit, hit);
  return offsetof(RayHit, ray) == 0 && isAt(offsetof(Ray, org_x), packet_column::orgX) &&
         isAt(offsetof(Ray, org_y), packet_column::orgY) &&
         isAt(offsetof(Ray, org_z), packet_column::orgZ) &&
         isAt(offsetof(Ray, dir_x), packet_column::dirX) &&
         isAt(offsetof(Ray, dir_y), packet_column::dirY) &&
         isAt(offsetof(Ray, dir_z), packet_column::dirZ) &&
         isAt(offsetof(Ray, tfar), packet_column::tFar) &&
         isAt(hit + offsetof(Hit, u), packet_column::u) &&
         isAt(hit + offsetof(Hit, v), packet_column::v) &&
         isAt(hit + offsetof(Hit, primID), packet_column::primitive) &&
         isAt(hit + offsetof(Hit, geomID), packet_column::geometry);
}
static_assert(columnsAreWhereKernelsLook<4>() && columnsAreWhereKernelsLook<8>() &&
              columnsAreWhereKernelsLook<16>());

template <int kWidth, typename Packet>
PacketWords wordsOf(Packet* packets) {
  return {reinterpret_cast<float*>(packets), sizeof(Packet) / sizeof(float), kWidth};
}

template <int kWidth>
constexpr std::size_t packetsFor(std::size_t rays) {
  return (rays + kWidth - 1) / kWidth;
}

// Sets the members that all rays of a packet share. Embree's robust traversal accepts hits at
// tnear, so the origin must not lie on the surface: it has been moved off by its error bound.
template <int kWidth, typename Ray>
void setConstants(Ray& ray, unsigned mask) {
  for (int lane = 0; lane < kWidth; ++lane) {
    ray.tnear[lane] = 0;
    ray.time[lane] = 0;
    ray.mask[lane] = mask;
    ray.id[lane] = 0;
    ray.flags[lane] = 0;
  }
}

// Embree writes hits only; what a ray starts with says that there is none.
template <int kWidth, typename RayHit>
void forgetHits(RayHit* packets, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    std::fill_n(packets[p].hit.geomID, kWidth, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packets[p].hit.instID[0], kWidth, RTC_INVALID_GEOMETRY_ID);
  }
}

// The valid mask: only the first `count` lanes of the last packet are active.
template <int kWidth>
void setLanes(Lanes<kWidth>* lanes, std::size_t rays) {
  for (std::size_t i = 0; i < packetsFor<kWidth>(rays) * kWidth; ++i) {
    lanes[i / kWidth].live[i % kWidth] = i < rays ? -1 : 0;
  }
}

// Packets are filled, traced and emptied in groups of this many rays, so that the clock around
// Embree's calls is read rarely and sees nothing but them.
inline constexpr std::size_t kGroup = 128;

template <int kWidth, typename Packet>
struct Group {
  static constexpr std::size_t kPackets = kGroup / kWidth;
  alignas(64) std::array<Packet, kPackets> packets;
  std::array<Lanes<kWidth>, kPackets> lanes;
};
template <int kWidth>
using HitGroup = Group<kWidth, typename PacketTypes<kWidth>::RayHit>;
template <int kWidth>
using ShadowGroup = Group<kWidth, typename PacketTypes<kWidth>::Ray>;

using TraceClock = std::chrono::steady_clock;

inline double millisecondsSince(TraceClock::time_point start) {
  return std::chrono::duration<double, std::milli>(TraceClock::now() - start).count();
}

}  // namespace whit
