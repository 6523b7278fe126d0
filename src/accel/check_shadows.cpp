// Embree's part of checkShadows: whether shadow rays meet anything, in packets of 1, 4, 8 or 16.
#include <algorithm>

#include "accel/accel_parts.h"
#include "accel/packets.h"
#include "accel/single_rays.h"

namespace whit {

namespace {

template <int kWidth>
std::size_t traceShadows(const Accel::Parts& parts, const Chunk& c, double& embreeMs) {
  const EmbreeScene& scene = parts.embree;
  const std::size_t n = c.shadowCount;
  const bool coherent = c.shadowsAreCoherent();
  QueryContext context(coherent);
  const bool together = parts.together(kWidth, coherent);
  ShadowGroup<kWidth> group;
  for (auto& packet : group.packets) setConstants<kWidth>(packet, kShadowMask);
  setLanes<kWidth>(group.lanes.data(), kGroup);
  const PacketWords words = wordsOf<kWidth>(group.packets.data());
  std::size_t lanes = 0;
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t rest = std::min(n - begin, kGroup), count = packetsFor<kWidth>(rest);
    if (rest < kGroup) setLanes<kWidth>(group.lanes.data(), rest);
    parts.kernels.packShadowRays(advanced(c.shadows, begin), rest, scene.reach(), words);
    const auto start = TraceClock::now();
    occludedAll(group.lanes.data(), scene.top(), context, together, group.packets.data(), count);
    embreeMs += millisecondsSince(start);
    parts.kernels.unpackVisibility(words, rest, c.shadows.slot + begin, c.unshadowed.visible);
    lanes += count * kWidth;
  }
  return lanes;
}

std::size_t traceShadowsSingly(const EmbreeScene& scene, const Chunk& c, double& embreeMs) {
  const auto start = TraceClock::now();
  const bool coherent = c.shadowsAreCoherent();
  for (std::size_t i = 0; i < c.shadowCount; ++i) {
    const bool blocked = isOccluded(scene, originAt(c.shadows, i), directionAt(c.shadows, i),
                                    c.shadows.tFar[i], coherent);
    c.unshadowed.visible[c.shadows.slot[i]] = blocked ? 0.0f : 1.0f;
  }
  embreeMs += millisecondsSince(start);
  return c.shadowCount;
}

}  // namespace

void Accel::checkShadows(Chunk& c) const noexcept {
  const RayKind kind = shadowKind(c.lightIsAmbient());
  RayTally& tally = c.meter->tally[static_cast<std::size_t>(kind)];
  double& embreeMs = c.meter->embreeMs;
  tally.rays += c.shadowCount;
  const int packet = parts_->shadowPacket(c.shadowsAreCoherent());
  tally.lanes += packet == 16  ? traceShadows<16>(*parts_, c, embreeMs)
                 : packet == 8 ? traceShadows<8>(*parts_, c, embreeMs)
                 : packet == 4 ? traceShadows<4>(*parts_, c, embreeMs)
                               : traceShadowsSingly(parts_->embree, c, embreeMs);
}

bool Accel::occluded(const Vec3f& origin, const Vec3f& direction, float tFar) const noexcept {
  return isOccluded(parts_->embree, origin, direction, tFar);
}

void checkShadows(Chunk& c) { c.frame->accel->checkShadows(c); }

}  // namespace whit
