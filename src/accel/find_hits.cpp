// Embree's part of findIntersections: rays through it in packets of 1, 4, 8 or 16, and once more,
// one by one, those that found nothing and those that met an edge.
#include <algorithm>
#include <cmath>

#include "accel/accel_parts.h"
#include "accel/packets.h"
#include "accel/single_rays.h"
#include "bake/eye_in_plane.h"

namespace whit {

namespace {

// The rays of one segment of a chunk.
struct HitRange {
  RayColumns rays;
  HitColumns hits;
  std::size_t n = 0;
  bool coherent = false;
  bool instances = false;  // hits say on which
};

void store(const Hit& hit, const HitRange& range, std::size_t i) {
  const HitColumns& hits = range.hits;
  hits.triangle[i] = hit.triangle;
  hits.t[i] = hit.t;
  hits.u[i] = hit.u;
  hits.v[i] = hit.v;
  if (range.instances) hits.instance[i] = hit.instance;
}

// The additional output of scenes with instances: the instance that was hit, and the numbers of its
// triangles.
template <int kWidth>
void storeInstances(const EmbreeScene& scene, const HitGroup<kWidth>& group, std::size_t n,
                    const HitColumns& hits) {
  for (std::size_t i = 0; i < n; ++i) {
    const auto& hit = group.packets[i / kWidth].hit;
    const std::size_t lane = i % kWidth;
    const unsigned instance = hit.instID[0][lane], geometry = hit.geomID[lane];
    hits.triangle[i] = geometry == RTC_INVALID_GEOMETRY_ID
                           ? kMiss
                           : scene.triangleOf(instance, geometry, hit.primID[lane]);
    hits.instance[i] = scene.instanceOf(instance);
  }
}

template <int kWidth>
std::size_t traceHits(const Accel::Parts& parts, const HitRange& range, double& embreeMs) {
  const EmbreeScene& scene = parts.embree;
  QueryContext context(range.coherent);
  const bool together = parts.together(kWidth, range.coherent);
  HitGroup<kWidth> group;
  for (auto& packet : group.packets) setConstants<kWidth>(packet.ray, kSeenMask);
  setLanes<kWidth>(group.lanes.data(), kGroup);
  const PacketWords words = wordsOf<kWidth>(group.packets.data());
  std::size_t lanes = 0;
  for (std::size_t begin = 0; begin < range.n; begin += kGroup) {
    const std::size_t rest = std::min(range.n - begin, kGroup), count = packetsFor<kWidth>(rest);
    if (rest < kGroup) setLanes<kWidth>(group.lanes.data(), rest);
    parts.kernels.packRays(advanced(range.rays, begin), rest, scene.reach(), words);
    forgetHits<kWidth>(group.packets.data(), count);
    const auto start = TraceClock::now();
    intersectAll(group.lanes.data(), scene.top(), context, together, group.packets.data(), count);
    embreeMs += millisecondsSince(start);
    const HitColumns to = advanced(range.hits, begin);
    parts.kernels.unpackHits(words, rest, scene.triangleBase(0), to);
    if (range.instances) storeInstances<kWidth>(scene, group, rest, to);
    lanes += count * kWidth;
  }
  return lanes;
}

std::size_t traceHitsSingly(const EmbreeScene& scene, const HitRange& range, double& embreeMs) {
  const auto start = TraceClock::now();
  for (std::size_t i = 0; i < range.n; ++i) {
    store(findHit(scene, originAt(range.rays, i), directionAt(range.rays, i), range.coherent),
          range, i);
  }
  embreeMs += millisecondsSince(start);
  return range.n;
}

// Weight of a corner below which the hit is taken to lie on the edge opposite. Triangles that share
// the edge may both be met there, at distances whose difference is lost in rounding; seen from a
// thousand times their size away, rounding moves the edge by 1e-4 of it.
constexpr float kNearEdge = 0x1p-12f;

// Three comparisons without branches, so that compilers make vectors of them.
int isNearEdge(float u, float v) {
  return static_cast<int>(u < kNearEdge) | static_cast<int>(v < kNearEdge) |
         static_cast<int>(1 - u - v < kNearEdge);
}

// Which of several triangles at one distance stays depends on the order in which Embree tests them,
// which a packet's other rays change. A ray alone has but one order.
void settleEdges(const EmbreeScene& scene, const HitRange& range) noexcept {
  constexpr std::size_t kRun = 4 * kBlock;  // hits looked at together before any is by itself
  const HitColumns& hits = range.hits;
  for (std::size_t begin = 0; begin < range.n; begin += kRun) {
    const std::size_t end = std::min(range.n, begin + kRun);
    const float *const u = hits.u, *const v = hits.v;
    int any = 0;
    for (std::size_t i = begin; i < end; ++i) any |= isNearEdge(u[i], v[i]);
    if (any == 0) continue;
    for (std::size_t i = begin; i < end; ++i) {
      if (hits.triangle[i] == kMiss || isNearEdge(u[i], v[i]) == 0) continue;
      const Hit hit = findHit(scene, originAt(range.rays, i), directionAt(range.rays, i));
      if (hit.found()) store(hit, range, i);
    }
  }
}

// True if a hit is so near that the ray may start in its plane (bake/eye_in_plane.h), if the cosine
// between ray and normal is at least 2^-10.
int isNearEye(const RayColumns& rays, const float* t, std::size_t i) {
  constexpr float kNear = 0x1p-12f;
  const float size = std::fabs(rays.orgX[i]) + std::fabs(rays.orgY[i]) + std::fabs(rays.orgZ[i]);
  return static_cast<int>(t[i] <= kNear * size);
}

// Finds the nearest triangle that a primary ray does not start in. Robust traversal accepts hits at
// a distance of 0, whatever the direction.
void lookPastEye(const Accel& accel, const Scene& scene, const HitRange& range) noexcept {
  const HitColumns& hits = range.hits;
  int any = 0;
  for (std::size_t i = 0; i < range.n; ++i) any |= isNearEye(range.rays, hits.t, i);
  if (any == 0) return;
  for (std::size_t i = 0; i < range.n; ++i) {
    if (isNearEye(range.rays, hits.t, i) == 0) continue;
    const Vec3f origin = originAt(range.rays, i), direction = directionAt(range.rays, i);
    for (int attempt = 0; attempt < kAttemptsPastEye && hits.triangle[i] != kMiss; ++attempt) {
      const std::uint32_t instance = range.instances ? hits.instance[i] : kNoInstance;
      if (!liesInSurface(scene, Vec3d(origin), hits.triangle[i], instance)) break;
      const auto tNear = static_cast<float>(wayPastEye(Vec3d(origin), attempt));
      store(accel.closest(origin, direction, tNear), range, i);
    }
  }
}

// Three directions next to `d`, each off by about a unit in the last place of its largest
// component, towards another side each.
Vec3f nudged(const Vec3f& d, int attempt) {
  const float step = maxComponent(abs(d)) * 0x1p-22f;
  Vec3f result = d;
  result[attempt] += d[attempt] < 0 ? -step : step;
  result[(attempt + 1) % 3] -= step;
  return result;
}

}  // namespace

void Accel::findHits(Chunk& c) const noexcept {
  for (std::size_t s = 0; s < c.segmentCount; ++s) {
    const Segment& segment = c.segments[s];
    const HitRange range{advanced(c.rays, segment.begin), advanced(c.hits, segment.begin),
                         segment.end - segment.begin, c.coherent, c.has(Feature::instances)};
    if (range.n == 0) continue;
    RayTally& tally = c.meter->tally[static_cast<std::size_t>(segment.kind)];
    double& embreeMs = c.meter->embreeMs;
    tally.rays += range.n;
    tally.lanes += parts_->packet == 16  ? traceHits<16>(*parts_, range, embreeMs)
                   : parts_->packet == 8 ? traceHits<8>(*parts_, range, embreeMs)
                   : parts_->packet == 4 ? traceHits<4>(*parts_, range, embreeMs)
                                         : traceHitsSingly(parts_->embree, range, embreeMs);
    if (parts_->packet != 1) settleEdges(parts_->embree, range);
    for (std::size_t i = 0; enclosed_ && i < range.n; ++i) {
      if (range.hits.triangle[i] != kMiss) continue;
      const Hit hit = closest(originAt(range.rays, i), directionAt(range.rays, i));
      if (hit.found()) store(hit, range, i);
    }
    if (c.depth == 0) lookPastEye(*this, scene_, range);
  }
  // Kernels run over whole vectors.
  std::fill(c.hits.triangle + c.n, c.hits.triangle + roundUpToBlock(c.n), kMiss);
}

Hit Accel::closest(const Vec3f& origin, const Vec3f& direction, float tNear) const noexcept {
  Hit hit = findHit(parts_->embree, origin, direction, false, tNear);
  for (int attempt = 0; enclosed_ && !hit.found() && attempt < 3; ++attempt) {
    hit = findHit(parts_->embree, origin, nudged(direction, attempt), false, tNear);
  }
  return hit;
}

void findHits(Chunk& c) { c.frame->accel->findHits(c); }

}  // namespace whit
