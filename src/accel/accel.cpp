// Rays through Embree: in packets of 4, 8 or 16 that kernels fill and empty, or one by one.
#include "accel/accel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "accel/embree_scene.h"
#include "bake/facet.h"
#include "core/index.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "simd/kernels.h"
#include "stages/packet_words.h"

namespace whit {

struct Accel::Impl {
  Impl(const Scene& scene, const RenderOptions& options, EffectSet effects, int threads,
       Progress* progress)
      : embree(scene, options, effects, threads, progress) {}

  // The width of a packet of shadow rays.
  int shadowPacket(bool coherent) const {
    return coherent && embree.coherentAnyHitMayHang(packet) ? 8 : packet;
  }

  void placeInstances(const Scene& scene) {
    instances.resize(scene.instances.size());
    for (const auto i : indices(instances)) {
      instances[i].setToWorld(scene.instances[i].toWorld);
    }
    tables = {scene.triangles.data(), scene.triangles.size(), scene.firstSphere, instances.data(),
              instances.size()};
  }

  EmbreeScene embree;
  std::vector<InstanceTransform> instances;
  simd::HitTables tables;
  simd::PacketKernels kernels = simd::findPacketKernels();
  int packet = 8;
  std::string description;
};

namespace {

// Rays that are traced with one kind of call. Closest hits belong to one segment of a chunk.
struct HitRange {
  RayColumns rays;
  HitColumns hits;
  std::size_t n = 0;
  bool coherent = false;
  bool instances = false;  // the column of instances is written, too
};
struct ShadowRange {
  ShadowColumns rays;
  float* visible = nullptr;
  std::size_t n = 0;
  bool coherent = false;
};

void store(const Hit& hit, const HitRange& range, std::size_t i) {
  const HitColumns& hits = range.hits;
  hits.triangle[i] = hit.triangle;
  hits.t[i] = hit.t;
  hits.u[i] = hit.u;
  hits.v[i] = hit.v;
  if (range.instances) hits.instance[i] = hit.instance;
}

// Embree ends the program at a NaN or beyond its range of coordinates (hard case H28). Such a ray
// is replaced by an empty one that starts where no triangle is. Kernels do the same (packRays).
RTCRayHit singleRay(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction,
                    float tNear, float tFar, unsigned mask) {
  const Vec3f size = abs(origin), way = abs(direction);
  const float reach = scene.reach(), place = 0.25f * reach;

  // The comparison fails for a NaN as well.
  const bool traceable =
      size.x + size.y + size.z + way.x + way.y + way.z <= reach && direction != Vec3f();
  const Vec3f o = traceable ? origin : Vec3f(place);
  const Vec3f d = traceable ? direction : Vec3f{0, 0, 1};
  RTCRayHit r{};
  r.ray = {o.x, o.y, o.z, tNear, d.x, d.y, d.z, 0, traceable ? tFar : -1, mask, 0, 0};
  r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return r;
}

// Returns the hit with Embree's own t, u and v, which other processors round differently.
Hit findUnrefined(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction,
                  bool coherent, float tNear) noexcept {
  constexpr float kUnbounded = kInfinity;
  RTCRayHit r = singleRay(scene, origin, direction, tNear, kUnbounded, kSeenMask);
  QueryContext context(coherent);
  context.setRay(origin, direction);
  context.trace(scene.top(), r);

  const unsigned instance = r.hit.instID[0];
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    return {kMiss, kNoInstance, r.ray.tfar, r.hit.u, r.hit.v};
  }
  return {scene.triangleOf(instance, r.hit.geomID, r.hit.primID), instanceOf(instance), r.ray.tfar,
          r.hit.u, r.hit.v};
}

bool isOccluded(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction, float tFar,
                bool coherent = false) noexcept {
  RTCRayHit r = singleRay(scene, origin, direction, 0, tFar, kShadowMask);
  QueryContext context(coherent);
  context.setRay(origin, direction);
  context.trace(scene.top(), r.ray);

  // Embree sets tfar to minus infinity where it finds an occluder.
  return !(r.ray.tfar >= 0);
}

Hit findHit(const Accel::Impl& impl, const Vec3f& origin, const Vec3f& direction,
            float tNear = 0) noexcept {
  Hit hit = findUnrefined(impl.embree, origin, direction, false, tNear);
  if (!hit.found()) return hit;

  // The kernel refines whole blocks of hits; this one holds a single hit in its first slot.
  alignas(64) float words[9][kBlock] = {};
  alignas(64) std::uint32_t triangle[kBlock], instance[kBlock];
  std::fill_n(triangle, kBlock, kMiss);
  std::fill_n(instance, kBlock, kNoInstance);
  for (int i = 0; i < 3; ++i) {
    words[i][0] = origin[i];
    words[3 + i][0] = direction[i];
  }
  triangle[0] = hit.triangle;
  instance[0] = hit.instance;
  words[6][0] = hit.t;
  words[7][0] = hit.u;
  words[8][0] = hit.v;
  RayColumns rays{{words[0], words[1], words[2]}, {words[3], words[4], words[5]}};
  impl.kernels.refineHits(impl.tables, rays, 1, {triangle, words[6], words[7], words[8], instance});
  return {hit.triangle, hit.instance, words[6][0], words[7][0], words[8][0]};
}

// Packets are filled, traced and emptied in groups of this many rays, so that the clock around
// Embree's calls is read rarely and sees nothing but them.
constexpr std::size_t kGroup = 128;

template <int kWidth, typename Packet>
struct Group {
  // `rays` is the largest number of rays that the group will hold.
  Group(unsigned mask, std::size_t rays) {
    setLanes(rays);
    const auto start = [&](auto& ray, std::size_t first) {
      ray = {};
      std::fill_n(ray.mask, kWidth, mask);
      std::iota(ray.id, ray.id + kWidth, static_cast<unsigned>(first));
    };

    // Kernels write origins, directions and ends only; masks and ids are the same in each group.
    for (const auto p : indices(count)) {
      if constexpr (kWantsHits<Packet>) {
        start(packets[p].ray, p * kWidth);
      } else {
        start(packets[p], p * kWidth);
      }
    }
  }

  // Activates the lanes of the first `rays` rays; the other rays of the last packet are empty.
  void setLanes(std::size_t rays) {
    count = (rays + kWidth - 1) / kWidth;
    for (const auto i : indices(count * kWidth)) {
      live[i / kWidth].lanes[i % kWidth] = i < rays ? -1 : 0;
    }
  }

  PacketWords words() {
    return {reinterpret_cast<float*>(packets), sizeof(Packet) / sizeof(float), kWidth};
  }

  struct alignas(64) Lanes {
    int lanes[kWidth];
  };
  // Embree's robust traversal accepts hits at tnear, which is 0, so the origin must not lie on the
  // surface: it has been moved off by its error bound.
  alignas(64) Packet packets[kGroup / kWidth];
  Lanes live[kGroup / kWidth];
  std::size_t count = 0;  // packets in use
};

// Calls pack(group, first ray, number of rays), Embree and unpack(...) for one group of the range's
// rays after the other. Returns the number of lanes, and adds to the time inside Embree.
template <int kWidth, typename Packet, typename Range, typename Pack, typename Unpack>
std::size_t traceGroups(const EmbreeScene& scene, unsigned mask, const Range& range,
                        double& embreeMs, const Pack& pack, const Unpack& unpack) {
  const std::size_t n = range.n;
  QueryContext context(range.coherent);
  const bool together = range.coherent && scene.streamWidth() == kWidth;
  Group<kWidth, Packet> group(mask, std::min(n, kGroup));

  std::size_t lanes = 0;
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t rest = std::min(n - begin, kGroup);
    if (rest < kGroup) group.setLanes(rest);
    pack(group, begin, rest);
    context.setRays(advanced(range.rays, begin));

    // Only Embree's calls are timed.
    const Stopwatch stopwatch;
    if (together) {
      context.traceStream(scene.top(), group.packets, kWidth, group.count);
    } else {
      for (const auto p : indices(group.count)) {
        context.trace(scene.top(), group.packets[p], group.live[p].lanes);
      }
    }
    embreeMs += stopwatch.ms();

    unpack(group, begin, rest);
    lanes += group.count * kWidth;
  }
  return lanes;
}

template <int kWidth>
std::size_t traceRange(const Accel::Impl& impl, const HitRange& range, double& embreeMs) {
  const EmbreeScene& scene = impl.embree;
  const auto pack = [&](auto& group, std::size_t begin, std::size_t n) {
    impl.kernels.packRays(advanced(range.rays, begin), n, scene.reach(), group.words());
    // Embree writes the ids of hits only, so the ids start as those of a miss.
    for (const auto p : indices(group.count)) {
      std::fill_n(group.packets[p].hit.geomID, kWidth, RTC_INVALID_GEOMETRY_ID);
      std::fill_n(group.packets[p].hit.instID[0], kWidth, RTC_INVALID_GEOMETRY_ID);
    }
  };

  const auto unpack = [&](auto& group, std::size_t begin, std::size_t n) {
    HitColumns to = advanced(range.hits, begin);
    if (!range.instances) to.instance = nullptr;
    impl.kernels.unpackHits(group.words(), n, scene.triangleBase(0), to);

    // refineHits() reads the corners once all rays of the chunk are traced.
    for (const auto i : indices(n)) {
      if (to.triangle[i] != kMiss) __builtin_prefetch(impl.tables.triangles + to.triangle[i]);
    }
  };

  return traceGroups<kWidth, RayHits<kWidth>>(scene, kSeenMask, range, embreeMs, pack, unpack);
}

template <int kWidth>
std::size_t traceRange(const Accel::Impl& impl, const ShadowRange& range, double& embreeMs) {
  const EmbreeScene& scene = impl.embree;
  const auto pack = [&](auto& group, std::size_t begin, std::size_t n) {
    impl.kernels.packShadowRays(advanced(range.rays, begin), n, scene.reach(), group.words());
  };
  const auto unpack = [&](auto& group, std::size_t begin, std::size_t n) {
    impl.kernels.unpackVisibility(group.words(), n, range.rays.slot + begin, range.visible);
  };

  return traceGroups<kWidth, Rays<kWidth>>(scene, kShadowMask, range, embreeMs, pack, unpack);
}

void traceSingly(const EmbreeScene& scene, const HitRange& range, std::size_t i) {
  store(findUnrefined(scene, range.rays.org.at(i), range.rays.dir.at(i), range.coherent, 0), range,
        i);
}

void traceSingly(const EmbreeScene& scene, const ShadowRange& range, std::size_t i) {
  const bool blocked = isOccluded(scene, range.rays.org.at(i), range.rays.dir.at(i),
                                  range.rays.tFar[i], range.coherent);
  range.visible[range.rays.slot[i]] = blocked ? 0.0f : 1.0f;
}

// Returns the number of lanes.
template <typename Range>
std::size_t traceAll(const Accel::Impl& impl, int packet, const Range& range, double& embreeMs) {
  if (packet == 16) return traceRange<16>(impl, range, embreeMs);
  if (packet == 8) return traceRange<8>(impl, range, embreeMs);
  if (packet == 4) return traceRange<4>(impl, range, embreeMs);

  const Stopwatch stopwatch;
  for (const auto i : indices(range.n)) traceSingly(impl.embree, range, i);
  embreeMs += stopwatch.ms();
  return range.n;
}

// A hit is taken to lie on the edge opposite to a corner whose weight is below this. Triangles that
// share the edge may both be hit there, at distances whose difference is lost in rounding; seen
// from a thousand times their size away, rounding moves the edge by 1e-4 of that size.
constexpr float kNearEdge = 0x1p-12f;

// Three comparisons without branches, so that compilers make vectors of them.
int isNearEdge(float u, float v) {
  return static_cast<int>(u < kNearEdge) | static_cast<int>(v < kNearEdge) |
         static_cast<int>(1 - u - v < kNearEdge);
}

// Among triangles at one distance, Embree keeps one that depends on the order of its tests, and the
// other rays of a packet change that order. Hits near an edge are therefore traced again, each by
// itself, in the one order that a single ray has.
void retraceEdgeHits(const Accel::Impl& impl, const HitRange& range) noexcept {
  constexpr std::size_t kRun = 4 * kBlock;  // hits that are tested together for any near an edge
  const HitColumns& hits = range.hits;
  for (std::size_t begin = 0; begin < range.n; begin += kRun) {
    const std::size_t end = std::min(range.n, begin + kRun);
    const float *const u = hits.u, *const v = hits.v;

    // Few hits lie near an edge, so most runs end with this vector test.
    int any = 0;
    for (std::size_t i = begin; i < end; ++i) any |= isNearEdge(u[i], v[i]);
    if (any == 0) continue;

    for (std::size_t i = begin; i < end; ++i) {
      if (hits.triangle[i] == kMiss || isNearEdge(u[i], v[i]) == 0) continue;
      const Hit hit = findHit(impl, range.rays.org.at(i), range.rays.dir.at(i));
      if (hit.found()) store(hit, range, i);
    }
  }
}

// Returns 1 for a hit so near that the ray may start in its plane (bake/facet.h), provided that the
// cosine between ray and normal is at least 2^-10.
int isNearEye(const RayColumns& rays, const float* t, std::size_t i) {
  constexpr float kNear = 0x1p-12f;
  const Vec3f origin = abs(rays.org.at(i));
  const float size = origin.x + origin.y + origin.z;
  return static_cast<int>(t[i] <= kNear * size);
}

// Replaces the hits of primary rays on surfaces that the eye lies in by the next hits behind them.
// Robust traversal accepts hits at a distance of 0, whatever the direction.
void lookPastEye(const Accel& accel, const Scene& scene, const HitRange& range) noexcept {
  const HitColumns& hits = range.hits;
  // Hits this near are rare, so all are tested before any of them is examined.
  int any = 0;
  for (const auto i : indices(range.n)) any |= isNearEye(range.rays, hits.t, i);
  if (any == 0) return;

  for (const auto i : indices(range.n)) {
    if (isNearEye(range.rays, hits.t, i) == 0) continue;
    const Vec3f origin = range.rays.org.at(i), direction = range.rays.dir.at(i);

    // Each attempt passes over twice the distance of the one before.
    for (int attempt = 0; attempt < kAttemptsPastEye && hits.triangle[i] != kMiss; ++attempt) {
      const std::uint32_t instance = range.instances ? hits.instance[i] : kNoInstance;
      if (!liesInSurface(scene, Vec3d(origin), hits.triangle[i], instance)) break;
      const auto tNear = static_cast<float>(distancePastEye(Vec3d(origin), attempt));
      store(accel.closest(origin, direction, tNear), range, i);
    }
  }
}

// Returns one of three directions next to `d`. Each differs from it by about a unit in the last
// place of its largest component, and towards another side.
Vec3f nudged(const Vec3f& d, int attempt) {
  const float step = maxComponent(abs(d)) * 0x1p-22f;
  Vec3f result = d;
  result[attempt] += d[attempt] < 0 ? -step : step;
  result[(attempt + 1) % 3] -= step;
  return result;
}

// The instruction set of Embree, with which packets of at most `widest` rays come.
const char* instructionSet(int widest) {
  if (widest == 16) return "avx512";
  return widest == 8 ? "avx2" : "sse4.2";
}

}  // namespace

Accel::Accel(const Scene& scene, const RenderOptions& options, EffectSet effects, int threads,
             Progress* progress)
    : scene_(scene), impl_(std::make_unique<Impl>(scene, options, effects, threads, progress)) {
  impl_->placeInstances(scene);
  const int widest = impl_->embree.widestPacket();
  impl_->packet = options.packet == 0 ? widest : options.packet;

  // Embree's version is a decimal number: 31305 stands for 3.13.5.
  const auto version = rtcGetDeviceProperty(impl_->embree.device(), RTC_DEVICE_PROPERTY_VERSION);
  impl_->description = formatted("%zd.%zd.%zd %s", version / 10000, version / 100 % 100,
                                 version % 100, instructionSet(widest));
}

Accel::~Accel() = default;

void Accel::sceneMoved() {
  impl_->embree.update(scene_);
  impl_->placeInstances(scene_);
}

int Accel::packet() const { return impl_->packet; }
std::string Accel::description() const { return impl_->description; }
std::uint64_t Accel::memoryBytes() const { return impl_->embree.memoryBytes(); }

void Accel::findHits(Chunk& c) const noexcept {
  const bool instances = c.has(Feature::instances);
  for (const auto s : indices(c.segmentCount)) {
    const Segment& segment = c.segments[s];
    const HitRange range{advanced(c.rays, segment.begin), advanced(c.hits, segment.begin),
                         segment.end - segment.begin, c.coherent, instances};
    if (range.n == 0) continue;
    RayTally& tally = entryOf(c.meter->tally, segment.kind);
    tally.rays += range.n;
    tally.lanes += traceAll(*impl_, impl_->packet, range, c.meter->embreeMs);
  }

  // Kernels run over whole vectors, so the slots behind the last ray must be misses.
  std::fill(c.hits.triangle + c.n, c.hits.triangle + roundUpToBlock(c.n), kMiss);
  impl_->kernels.refineHits(impl_->tables, c.rays, c.n, c.hits);

  // The rays of a packet must not influence which of two neighbors is hit on their edge.
  const HitRange all{c.rays, c.hits, c.n, c.coherent, instances};
  if (impl_->packet != 1) retraceEdgeHits(*impl_, all);

  // A ray that leaves an enclosed scene has slipped through a corner (hard case H14).
  if (enclosed_) {
    for (const auto i : indices(all.n)) {
      if (c.hits.triangle[i] != kMiss) continue;
      const Hit hit = closest(c.rays.org.at(i), c.rays.dir.at(i));
      if (hit.found()) store(hit, all, i);
    }
  }

  // The eye sees nothing of a surface that it lies in.
  if (c.depth == 0) lookPastEye(*this, scene_, all);
}

void Accel::checkShadows(Chunk& c) const noexcept {
  const RayKind kind = shadowKind(c.lightIsAmbient());
  const ShadowRange range{c.shadows, c.unshadowed.visible, c.shadowCount, c.shadowsAreCoherent()};
  RayTally& tally = entryOf(c.meter->tally, kind);
  tally.rays += range.n;
  tally.lanes += traceAll(*impl_, impl_->shadowPacket(range.coherent), range, c.meter->embreeMs);
}

Hit Accel::closest(const Vec3f& origin, const Vec3f& direction, float tNear) const noexcept {
  Hit hit = findHit(*impl_, origin, direction, tNear);

  // Directions next to this one do not meet the corner that let the ray through.
  for (int attempt = 0; enclosed_ && !hit.found() && attempt < 3; ++attempt) {
    hit = findHit(*impl_, origin, nudged(direction, attempt), tNear);
  }
  return hit;
}

bool Accel::occluded(const Vec3f& origin, const Vec3f& direction, float tFar) const noexcept {
  return isOccluded(impl_->embree, origin, direction, tFar);
}

void findHits(Chunk& c) { c.frame->accel->findHits(c); }

void checkShadows(Chunk& c) { c.frame->accel->checkShadows(c); }

}  // namespace whit
