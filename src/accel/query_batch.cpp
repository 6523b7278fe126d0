#include "accel/query_batch.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/index.h"

namespace whit {

namespace {

// If the origin of a ray is farther from the ball's center than this (in radii of the scene's ball,
// see query_scene.h), rounding may move the point where the ray enters the ball by more than
// kAcrossError.
constexpr double kFarthestOrigin = 0x1p30;
// Products with directions shorter or longer than this could leave the range of doubles.
constexpr double kShortest = 1e-100, kLongest = 1e100;

constexpr std::size_t kPacket = 16;
// Embree's tFar of a ray that hits nothing, or that needs no more candidates.
constexpr float kNowhere = -kInfinity;
// The squared distance of a ray's origin from that of the packet's first ray, plus the squared
// difference of their directions, is below this for all rays of a coherent packet.
constexpr float kCoherent = 0.02f;

// Returns true if Embree's hit, in single precision, proves that the ray hits the exact triangle,
// and if the distance of the hit is accurate to kAlongError.
bool isSurelyHit(const RTCFilterFunctionNArguments& args, unsigned lane, float margin) {
  RTCHitN* const hit = args.hit;
  RTCRayN* const ray = args.ray;
  const unsigned n = args.N;
  const float u = RTCHitN_u(hit, n, lane), v = RTCHitN_v(hit, n, lane);
  if (!(std::min({u, v, 1 - u - v}) > margin)) return false;

  // At a grazing angle the distance is less accurate. kLeastSlope is the least sine of the angle
  // between ray and triangle.
  constexpr float kLeastSlope = 0x1p-6f;
  const Vec3f normal{RTCHitN_Ng_x(hit, n, lane), RTCHitN_Ng_y(hit, n, lane),
                     RTCHitN_Ng_z(hit, n, lane)};
  const Vec3f direction{RTCRayN_dir_x(ray, n, lane), RTCRayN_dir_y(ray, n, lane),
                        RTCRayN_dir_z(ray, n, lane)};
  const float slope = dot(normal, direction);
  return slope * slope >
         kLeastSlope * kLeastSlope * dot(normal, normal) * dot(direction, direction);
}

// Runs the exact test for the rays that hit the box of a sphere, and shortens them to their hits.
template <typename Arguments>
void testSpheres(const Arguments& args, RTCRayN* rays) {
  RayBatch& batch = *static_cast<RayBatch*>(batchOf(args.context));
  const auto& spheres = *static_cast<const QuerySpheres*>(args.geometryUserPtr);
  const PlacedTriangleId id = QueryScene::placed(args.context, spheres.first + args.primID);
  for (unsigned lane = 0; lane < args.N; ++lane) {
    if (args.valid[lane] == 0) continue;
    float& tFar = RTCRayN_tfar(rays, args.N, lane);
    float end = tFar;
    if (batch.test(RTCRayN_id(rays, args.N, lane), id, end)) tFar = std::min(tFar, end);
  }
}

template <typename Packet>
auto& rayOf(Packet& packet) {
  if constexpr (kWantsHits<Packet>) {
    return packet.ray;
  } else {
    return packet;
  }
}

}  // namespace

void filterCandidates(const RTCFilterFunctionNArguments* args) {
  RayBatch& batch = *static_cast<RayBatch*>(batchOf(args->context));
  const auto& triangles = *static_cast<const EnlargedTriangles*>(args->geometryUserPtr);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    const std::uint32_t primitive = RTCHitN_primID(args->hit, args->N, lane);
    const PlacedTriangleId id = QueryScene::placed(args->context, triangles.first + primitive);
    const unsigned ray = RTCRayN_id(args->ray, args->N, lane);
    float& tFar = RTCRayN_tfar(args->ray, args->N, lane);

    // Most candidates are hit far from their edges and need no exact test yet.
    const bool ends =
        (isSurelyHit(*args, lane, triangles.margins[primitive]) && batch.postpone(ray, id, tFar)) ||
        batch.test(ray, id, tFar);
    // With -1 Embree accepts the hit and ends the ray there. With 0 it rejects the hit, and goes on
    // with the candidates behind it.
    args->valid[lane] = ends ? -1 : 0;
  }
}

void intersectSpheres(const RTCIntersectFunctionNArguments* args) {
  testSpheres(*args, RTCRayHitN_RayN(args->rayhit, args->N));
}
void occludeSpheres(const RTCOccludedFunctionNArguments* args) { testSpheres(*args, args->ray); }

// Computes the part of the ray that Embree traces, which lies within the ball. Returns false if
// this part is not known, so that the answer for the ray is not certain.
bool RayBatch::start(const QueryRay& ray, Start& to) const {
  to.tFar = kNowhere;
  to.postponed.triangle = kMiss;

  // A ray with an empty interval hits nothing. A NaN or a direction out of range leaves the answer
  // unknown.
  const double size = length(ray.direction);
  if (!isFinite(ray.origin) || !(size > kShortest && size < kLongest)) return false;
  if (!(ray.tNear <= ray.tFar)) return ray.tNear > ray.tFar;

  // The ray's line crosses the ball if its point closest to the center lies inside. `halfChord2` is
  // then the squared half of the chord.
  const QueryFrame& frame = scene_.frame();
  const Vec3d unit = ray.direction / size;
  const Vec3d origin = frame.of(ray.origin);
  const double along = -dot(origin, unit);  // distance to the point closest to the center
  const Vec3d nearest = origin + unit * along;
  const double halfChord2 = kBall * kBall - dot(nearest, nearest);
  const bool known = maxComponent(abs(origin)) < kFarthestOrigin;
  if (!(halfChord2 > 0)) return known;

  // Embree's ray starts at tNear or where the ray enters the ball, whichever is later. Both of its
  // ends are moved outwards by kAlongError, so that no hit is lost.
  const double half = std::sqrt(halfChord2);
  to.perT = size / frame.scale;
  to.shift = std::max(along - half, ray.tNear * to.perT) - kAlongError;
  to.origin = Vec3f(nearest + unit * (to.shift - along));
  to.direction = Vec3f(unit);
  to.tFar = static_cast<float>(std::min(along + half, ray.tFar * to.perT) + kAlongError - to.shift);
  to.end = to.tFar;
  return known;
}

bool RayBatch::postpone(unsigned ray, PlacedTriangleId id, float& tFar) {
  // The tolerance is the error of distances along the ray, in Embree's units.
  constexpr auto kTolerance = static_cast<float>(kAlongError);
  if (kind_ == QueryKind::all) return false;
  Start& start = starts_[ray];
  const float t = tFar;
  // The exact test decides near the ends of the ray.
  if (!(t > 2 * kTolerance && t < start.end - 2 * kTolerance)) return false;

  if (kind_ == QueryKind::any) {
    answers_[ray] = {true, true};
    tFar = kNowhere;
    return true;
  }

  // An earlier postponed triangle is dropped only for one that is surely nearer. Otherwise this one
  // is tested now.
  if (start.postponed.triangle != kMiss && t >= start.at - kTolerance) return false;
  start.postponed = id;
  start.at = t;
  __builtin_prefetch(&scene_.source().triangles[id.triangle]);

  // A candidate that seems up to kTolerance farther away may in fact be nearer, so Embree goes on
  // with such candidates.
  tFar = start.tFar = std::min(start.tFar, t + kTolerance);
  return true;
}

// Takes a hit that the exact test has found. Returns true if Embree's ray ends there.
bool RayBatch::keep(unsigned ray, const QueryHit& hit, float& tFar) {
  if (kind_ == QueryKind::any) {
    answers_[ray] = {true, hit.certain};
    tFar = kNowhere;
    return hit.certain;
  }

  const auto isSurelyBefore = [](const QueryHit& a, const QueryHit& b) {
    return a.certain && a.t + a.tError < b.t - b.tError;
  };
  QueryHit& best = best_[ray];
  const bool nearest = kind_ == QueryKind::closest;

  // If only the nearest hit counts, best_ becomes the hit that is surely nearer, and hits surely
  // behind it are dropped. All others are kept for hits().
  if (!best.found() || (nearest && isSurelyBefore(hit, best))) {
    best = hit;
  } else if (!nearest || !isSurelyBefore(best, hit)) {
    others_.emplace_back(ray, hit);
  }

  if (!nearest || !hit.certain) return false;
  // The ray is shortened to the far end of the hit's error bounds and no further, so that Embree
  // finds all candidates that may be as near, in whichever order it tests them.
  Start& start = starts_[ray];
  const double end = (hit.t + hit.tError) * start.perT - start.shift + kAlongError;
  start.tFar = std::min(start.tFar, static_cast<float>(end));
  tFar = start.tFar;
  return true;
}

bool RayBatch::test(unsigned ray, PlacedTriangleId id, float& tFar) {
  if (scene_.source().isSphere(id.triangle)) {
    QueryHit hits[2];
    const int count = scene_.exact().hitSphere(rays_[ray], id, hits);
    bool ends = false;
    for (int i = 0; i < count; ++i) ends = keep(ray, hits[i], tFar) || ends;
    return ends;
  }

  const std::optional<QueryHit> hit = scene_.exact().hitTriangle(rays_[ray], id);
  return hit && keep(ray, *hit, tFar);
}

// Returns Embree's packet of kPacket rays, the first of which has the number `first`.
template <typename Packet>
Packet RayBatch::packetOf(std::span<const Start> starts, std::size_t first) {
  Packet packet{};
  auto& rays = rayOf(packet);
  for (const auto i : indices(kPacket)) {
    const Start& s = starts[i];
    rays.org_x[i] = s.origin.x;
    rays.org_y[i] = s.origin.y;
    rays.org_z[i] = s.origin.z;
    rays.dir_x[i] = s.direction.x;
    rays.dir_y[i] = s.direction.y;
    rays.dir_z[i] = s.direction.z;
    rays.tfar[i] = s.tFar;
    rays.mask[i] = ~0u;
    rays.id[i] = static_cast<unsigned>(first + i);
  }

  // The ids start as those of a miss, because Embree writes the ids of hits only.
  if constexpr (kWantsHits<Packet>) {
    std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
  }
  return packet;
}

// Traces rays with similar origins and directions as a packet, others one by one.
template <typename Single, typename Packet>
void RayBatch::traceAs() {
  RTCScene const scene = scene_.embree();

  // The flag declares the rays of packets coherent to Embree. Any-hit queries do not set it,
  // because rtcOccluded16 may then never return (EmbreeScene::coherentAnyHitMayHang).
  QueryContext alone(false), together(kWantsHits<Packet>);
  alone.setBatch(this);
  together.setBatch(this);

  for (std::size_t begin = 0; begin < rays_.size(); begin += kPacket) {
    const std::size_t n = std::min(kPacket, rays_.size() - begin);
    const auto run = std::span<const Start>(starts_).subspan(begin, n);
    const bool coherent = n == kPacket && std::ranges::all_of(run, [&](const Start& s) {
                            const Vec3f turn = s.direction - run[0].direction;
                            const Vec3f apart = s.origin - run[0].origin;
                            return s.tFar >= 0 && dot(turn, turn) + dot(apart, apart) < kCoherent;
                          });

    if (coherent) {
      alignas(64) int live[kPacket];
      std::fill_n(live, kPacket, -1);
      Packet packet = packetOf<Packet>(run, begin);
      together.trace(scene, packet, live);
      continue;
    }

    for (const auto i : indices(n)) {
      if (!(run[i].tFar >= 0)) continue;

      const Vec3f &o = run[i].origin, &d = run[i].direction;
      const auto number = static_cast<unsigned>(begin + i);
      Single single{};
      rayOf(single) = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, run[i].tFar, ~0u, number, 0};
      if constexpr (kWantsHits<Single>) {
        single.hit.geomID = single.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      }
      alone.trace(scene, single);
    }
  }
}

void RayBatch::trace(std::span<const QueryRay> rays) {
  rays_ = rays;
  others_.clear();
  for (const auto i : indices(rays)) {
    answers_[i] = {false, start(rays[i], starts_[i])};
    best_[i] = {};
  }

  if (kind_ == QueryKind::any) {
    traceAs<RTCRay, RTCRay16>();
  } else {
    traceAs<RTCRayHit, RTCRayHit16>();

    // Postponed triangles get their exact hits when nothing nearer can come any more.
    for (unsigned i = 0; i < rays.size(); ++i) {
      float tFar = 0;
      if (starts_[i].postponed.triangle != kMiss) test(i, starts_[i].postponed, tFar);
    }
  }

  // hits() searches others_ by the number of the ray.
  std::ranges::stable_sort(others_, {}, [](const auto& other) { return other.first; });
}

std::vector<QueryHit>& RayBatch::hits(std::size_t ray) {
  hits_.clear();
  if (!best_[ray].found()) return hits_;
  hits_.push_back(best_[ray]);
  const auto isBefore = [](const Other& other, std::size_t own) { return other.first < own; };
  auto next = std::lower_bound(others_.begin(), others_.end(), ray, isBefore);
  for (; next != others_.end() && next->first == ray; ++next) hits_.push_back(next->second);
  return hits_;
}

}  // namespace whit
