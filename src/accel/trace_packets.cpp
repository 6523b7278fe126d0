#include "accel/trace_packets.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "accel/bad_rays.h"

namespace whit {

namespace {

template <int kWidth>
struct RayGroup {
  static constexpr std::size_t kPackets = kGroup / kWidth;
  alignas(64) std::array<typename PacketTypes<kWidth>::RayHit, kPackets> packets;
  std::array<Lanes<kWidth>, kPackets> lanes;
  std::size_t count = 0;  // packets in use
};
template <int kWidth>
struct ShadowGroup {
  static constexpr std::size_t kPackets = kGroup / kWidth;
  alignas(64) std::array<typename PacketTypes<kWidth>::Ray, kPackets> packets;
  std::array<Lanes<kWidth>, kPackets> lanes;
  std::size_t count = 0;
};

// Full packets have these lanes; the last one of a queue may have fewer.
template <int kWidth, typename Group>
void setAllLanes(Group& group) {
  for (Lanes<kWidth>& lanes : group.lanes) std::fill(lanes.live, lanes.live + kWidth, -1);
}

// Embree's robust traversal accepts hits at tnear, so the origin must not lie on the surface: it
// has been moved off by its error bound.
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

template <int kWidth, typename Ray, typename Columns>
void loadRay(Ray& ray, const Columns& rays, std::size_t i) {
  std::memcpy(ray.org_x, rays.orgX + i, sizeof(ray.org_x));
  std::memcpy(ray.org_y, rays.orgY + i, sizeof(ray.org_y));
  std::memcpy(ray.org_z, rays.orgZ + i, sizeof(ray.org_z));
  std::memcpy(ray.dir_x, rays.dirX + i, sizeof(ray.dir_x));
  std::memcpy(ray.dir_y, rays.dirY + i, sizeof(ray.dir_y));
  std::memcpy(ray.dir_z, rays.dirZ + i, sizeof(ray.dir_z));
}

// Masked lanes get a harmless empty ray: where Embree splits a packet that is wider than the CPU,
// it looks at their coordinates all the same.
template <int kWidth, typename Ray>
void emptyLanes(Ray& ray, Lanes<kWidth>& lanes, std::size_t live) {
  for (std::size_t lane = live; lane < kWidth; ++lane) {
    lanes.live[lane] = 0;
    ray.org_x[lane] = ray.org_y[lane] = ray.org_z[lane] = 0;
    ray.dir_x[lane] = ray.dir_y[lane] = 0;
    ray.dir_z[lane] = 1;
    ray.tfar[lane] = -1;
  }
}

template <int kWidth>
void fillGroup(RayGroup<kWidth>& group, const RayColumns& rays, std::size_t begin, std::size_t end,
               float reach) {
  group.count = 0;
  for (std::size_t i = begin; i < end; i += kWidth, ++group.count) {
    auto& packet = group.packets[group.count];
    loadRay<kWidth>(packet.ray, rays, i);
    for (int lane = 0; lane < kWidth; ++lane) {
      packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    emptyLanes<kWidth>(packet.ray, group.lanes[group.count], end - i);
    leaveOutBadRays<kWidth>(packet.ray, reach);
  }
}

template <int kWidth>
void storeHits(const EmbreeScene& scene, const typename PacketTypes<kWidth>::RayHit& packet,
               const HitColumns& hits, std::size_t i) {
  std::memcpy(hits.t + i, packet.ray.tfar, sizeof(packet.ray.tfar));
  std::memcpy(hits.u + i, packet.hit.u, sizeof(packet.hit.u));
  std::memcpy(hits.v + i, packet.hit.v, sizeof(packet.hit.v));
  if (scene.plain()) {
    std::memcpy(hits.triangle + i, packet.hit.primID, sizeof(packet.hit.primID));
    if (!hits.instance) return;
  }
  for (int lane = 0; lane < kWidth; ++lane) {
    const std::size_t slot = i + static_cast<std::size_t>(lane);
    const unsigned instance = packet.hit.instID[0][lane];
    const bool placed = instance != RTC_INVALID_GEOMETRY_ID;
    const std::uint32_t* base = scene.triangleBase(placed ? 1 + (instance - kFirstInstanceId) : 0);
    const unsigned geometry = packet.hit.geomID[lane];
    hits.triangle[slot] = geometry == RTC_INVALID_GEOMETRY_ID
                              ? kMiss
                              : base[geometry % kTriangleClasses] + packet.hit.primID[lane];
    if (hits.instance) hits.instance[slot] = placed ? instance - kFirstInstanceId : kMiss;
  }
}

}  // namespace

template <int kWidth>
void traceHits(const EmbreeScene& scene, const RayColumns& rays, std::size_t n, bool coherent,
               const HitColumns& hits, TraceMeter& meter) {
  QueryContext context(coherent);
  const bool together = coherent && scene.streamWidth() == kWidth;
  RayGroup<kWidth> group;
  setAllLanes<kWidth>(group);
  for (auto& packet : group.packets) setConstants<kWidth>(packet.ray, kSeenMask);
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t end = std::min(n, begin + kGroup);
    fillGroup<kWidth>(group, rays, begin, end, scene.reach());
    const auto start = TraceClock::now();
    intersectAll(group.lanes.data(), scene.top(), context, together, group.packets.data(),
                 group.count);
    meter.embreeMs += millisecondsSince(start);
    for (std::size_t p = 0; p < group.count; ++p) {
      storeHits<kWidth>(scene, group.packets[p], hits, begin + p * kWidth);
    }
    meter.tally->lanes += group.count * kWidth;
  }
}

template <int kWidth>
void traceShadows(const EmbreeScene& scene, const ShadowColumns& shadows, std::size_t n,
                  bool coherent, float* visible, TraceMeter& meter) {
  QueryContext context(coherent);
  const bool together = coherent && scene.streamWidth() == kWidth;
  ShadowGroup<kWidth> group;
  setAllLanes<kWidth>(group);
  for (auto& packet : group.packets) setConstants<kWidth>(packet, kShadowMask);
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t end = std::min(n, begin + kGroup);
    group.count = 0;
    for (std::size_t i = begin; i < end; i += kWidth, ++group.count) {
      auto& packet = group.packets[group.count];
      loadRay<kWidth>(packet, shadows, i);
      std::memcpy(packet.tfar, shadows.tFar + i, sizeof(packet.tfar));
      emptyLanes<kWidth>(packet, group.lanes[group.count], end - i);
      leaveOutBadRays<kWidth>(packet, scene.reach());
    }
    const auto start = TraceClock::now();
    occludedAll(group.lanes.data(), scene.top(), context, together, group.packets.data(),
                group.count);
    meter.embreeMs += millisecondsSince(start);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t lane = i - begin;
      // Embree marks an occluded ray with a tfar of minus infinity. No branch: which way it goes
      // cannot be foretold.
      const bool clear = group.packets[lane / kWidth].tfar[lane % kWidth] >= 0;
      visible[shadows.slot[i]] = static_cast<float>(static_cast<int>(clear));
    }
    meter.tally->lanes += group.count * kWidth;
  }
}

template void traceHits<4>(const EmbreeScene&, const RayColumns&, std::size_t, bool,
                           const HitColumns&, TraceMeter&);
template void traceHits<8>(const EmbreeScene&, const RayColumns&, std::size_t, bool,
                           const HitColumns&, TraceMeter&);
template void traceHits<16>(const EmbreeScene&, const RayColumns&, std::size_t, bool,
                            const HitColumns&, TraceMeter&);
template void traceShadows<4>(const EmbreeScene&, const ShadowColumns&, std::size_t, bool, float*,
                              TraceMeter&);
template void traceShadows<8>(const EmbreeScene&, const ShadowColumns&, std::size_t, bool, float*,
                              TraceMeter&);
template void traceShadows<16>(const EmbreeScene&, const ShadowColumns&, std::size_t, bool, float*,
                               TraceMeter&);

}  // namespace whit
