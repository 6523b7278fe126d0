#include "accel/trace_packets.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "accel/packing.h"

namespace whit {

namespace {

template <int kWidth, typename Packet>
struct Group {
  static constexpr std::size_t kPackets = kGroup / kWidth;
  alignas(64) std::array<Packet, kPackets> packets;
  std::array<Lanes<kWidth>, kPackets> lanes;
};
template <int kWidth>
using RayGroup = Group<kWidth, typename PacketTypes<kWidth>::RayHit>;
template <int kWidth>
using ShadowGroup = Group<kWidth, typename PacketTypes<kWidth>::Ray>;

// What scenes with instances need besides: which of them was hit, and its triangles' numbers.
template <int kWidth>
void storeInstances(const EmbreeScene& scene, const RayGroup<kWidth>& group, std::size_t n,
                    const HitColumns& hits) {
  for (std::size_t i = 0; i < n; ++i) {
    const auto& hit = group.packets[i / kWidth].hit;
    const std::size_t lane = i % kWidth;
    const unsigned instance = hit.instID[0][lane], geometry = hit.geomID[lane];
    const bool placed = instance != RTC_INVALID_GEOMETRY_ID;
    const std::uint32_t* base = scene.triangleBase(placed ? 1 + (instance - kFirstInstanceId) : 0);
    hits.triangle[i] =
        geometry == RTC_INVALID_GEOMETRY_ID ? kMiss : base[geometry] + hit.primID[lane];
    hits.instance[i] = placed ? instance - kFirstInstanceId : kMiss;
  }
}

}  // namespace

template <int kWidth>
void traceHits(const EmbreeScene& scene, const RayColumns& rays, std::size_t n, bool coherent,
               const HitColumns& hits, TraceMeter& meter) {
  QueryContext context(coherent);
  const bool together = coherent && scene.streamWidth() == kWidth;
  RayGroup<kWidth> group;
  for (auto& packet : group.packets) setConstants<kWidth>(packet.ray, kSeenMask);
  setLanes<kWidth>(group.lanes.data(), kGroup);
  const PacketWords words = wordsOf<kWidth>(group.packets.data());
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t rest = std::min(n - begin, kGroup), count = packetsFor<kWidth>(rest);
    if (rest < kGroup) setLanes<kWidth>(group.lanes.data(), rest);
    simd::packRays(advanced(rays, begin), rest, scene.reach(), words);
    forgetHits<kWidth>(group.packets.data(), count);
    const auto start = TraceClock::now();
    intersectAll(group.lanes.data(), scene.top(), context, together, group.packets.data(), count);
    meter.embreeMs += millisecondsSince(start);
    const HitColumns to = advanced(hits, begin);
    simd::unpackHits(words, rest, scene.triangleBase(0), to);
    if (hits.instance) storeInstances<kWidth>(scene, group, rest, to);
    meter.tally->lanes += count * kWidth;
  }
}

template <int kWidth>
void traceShadows(const EmbreeScene& scene, const ShadowColumns& shadows, std::size_t n,
                  bool coherent, float* visible, TraceMeter& meter) {
  QueryContext context(coherent);
  const bool together = coherent && scene.streamWidth() == kWidth;
  ShadowGroup<kWidth> group;
  for (auto& packet : group.packets) setConstants<kWidth>(packet, kShadowMask);
  setLanes<kWidth>(group.lanes.data(), kGroup);
  const PacketWords words = wordsOf<kWidth>(group.packets.data());
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t rest = std::min(n - begin, kGroup), count = packetsFor<kWidth>(rest);
    if (rest < kGroup) setLanes<kWidth>(group.lanes.data(), rest);
    simd::packShadowRays(advanced(shadows, begin), rest, scene.reach(), words);
    const auto start = TraceClock::now();
    occludedAll(group.lanes.data(), scene.top(), context, together, group.packets.data(), count);
    meter.embreeMs += millisecondsSince(start);
    simd::unpackVisibility(words, rest, shadows.slot + begin, visible);
    meter.tally->lanes += count * kWidth;
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
