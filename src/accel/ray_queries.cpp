#include "accel/ray_queries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "accel/alpha_filter.h"
#include "accel/embree_scene.h"
#include "bake/facet.h"
#include "bake/sphere.h"
#include "core/error.h"
#include "core/worker_pool.h"

namespace whit {

// Maps the space of a geometry to Embree's: (point - center) / scale.
struct QueryFrame {
  Vec3d center;
  double scale = 1;
  Vec3d of(const Vec3d& point) const { return (point - center) / scale; }
};

namespace {

// Embree gets the scene moved and scaled into the unit ball, and each ray from the point where it
// enters a slightly larger ball. Embree's errors then have one size, however far away a ray starts.
constexpr double kBall = 1.25;
// Bounds on Embree's rounding errors, in units of the ball. kRim bounds the error across a
// triangle's edges as seen along the ray, unless an edge is foreshortened to less than a sixteenth
// of its length. kAlong bounds the error along the ray, unless a triangle is seen at less than a
// thousandth of its area.
constexpr double kRim = 0x1p-17, kAlong = 0x1p-13;
// The point where a ray enters the ball is not known to kRim if its origin is farther away than
// this.
constexpr double kFarthestOrigin = 0x1p30;
// Corners with a smaller sine than this are lengthened as if they had this sine.
constexpr double kSharpest = 0x1p-10;
// Upper bound on the enlargement of triangles in objects that are tiny beside the scene, so that
// floats can hold them.
constexpr double kWidestRim = 1e6;
// Products with shorter or longer directions could leave the range of doubles.
constexpr double kShortest = 1e-100, kLongest = 1e100;

// Numbers of Embree geometries.
constexpr unsigned kTriangles = 0, kSpheres = 1, kFirstInstance = 2;

constexpr std::size_t kPacket = 16;
constexpr float kNowhere = -std::numeric_limits<float>::infinity();
// Upper bound on the squared differences of origins and directions, added, in a coherent packet.
constexpr float kCoherent = 0.02f;

QueryFrame frameAround(const Box& box) {
  if (box.empty()) return {};

  // A power of two as the scale makes the division exact.
  int exponent = 0;
  std::frexp(std::max(box.diagonal() / 2, 0x1p-120), &exponent);
  return {box.center(), std::ldexp(1.0, exponent)};
}

// Moves the edges of a triangle outwards, in its plane.
Corners enlarged(const Corners& corners, double by) {
  Corners result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d one = normalized(corners[(i + 1) % 3] - corners[i]);
    const Vec3d other = normalized(corners[(i + 2) % 3] - corners[i]);

    // Both edges move outwards by `by` if their corner moves along each of them by `by` over its
    // sine.
    result[i] = corners[i] - (one + other) * (by / std::max(length(cross(one, other)), kSharpest));
  }
  return result;
}

double sumOf(const Vec3d& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

// The sign of a number that is known up to an error.
enum class Lies { below, unknown, above };
Lies lies(double value, double error) {
  if (value > error) return Lies::above;
  return value < -error ? Lies::below : Lies::unknown;
}

// Returns false where the hit surely lies outside the interval from tNear to tFar. A hit that may
// lie on either side of an end becomes uncertain.
bool isOnRay(const QueryRay& ray, QueryHit& hit) {
  if (hit.t + hit.tError < ray.tNear || hit.t - hit.tError > ray.tFar) return false;
  hit.certain = hit.certain && hit.t - hit.tError >= ray.tNear && hit.t + hit.tError <= ray.tFar;
  return true;
}

}  // namespace

// The triangles of an Embree geometry, as its filter reads them.
struct EnlargedTriangles {
  std::uint32_t first = 0;  // in Scene::triangles
  // A hit on the enlarged triangle surely lies within the triangle if all of its weights are above
  // this margin. The margin is infinite where a mask or the side counts as well.
  std::vector<float> margins;
};

// The spheres of an Embree geometry. Each is tested where Embree finds its box.
struct QuerySpheres {
  std::uint32_t first = 0;  // in Scene::triangles
  std::vector<Box> boxes;
};

struct RayQueries::Parts {
  Parts(const Scene& scene_, int threads, Progress* progress);

  void addTriangles(std::size_t index, double rim, int threads);
  void addSpheres(std::size_t index, double rim);
  void addInstance(std::uint32_t number);
  float marginOf(std::uint32_t number, const Corners& corners, double rim) const;

  std::optional<QueryHit> meetTriangle(const QueryRay& ray, PlacedTriangleId id) const;
  int meetSphere(const QueryRay& ray, PlacedTriangleId id, QueryHit (&hits)[2]) const;
  bool arePartners(PlacedTriangleId a, PlacedTriangleId b) const;
  bool comesBefore(PlacedTriangleId a, PlacedTriangleId b) const;
  bool areNeighbors(const QueryHit& a, const QueryHit& b) const;
  QueryHit nearestOf(std::vector<QueryHit>& hits) const;
  void keepDistinct(std::vector<QueryHit>& hits) const;

  const Scene& scene;
  std::vector<Mask> masks;
  std::vector<QueryFrame> frames;  // one a geometry; the first is the world's
  std::deque<EnlargedTriangles> triangles;
  std::deque<QuerySpheres> spheres;
  DeviceHandle device;
  std::vector<SceneHandle> scenes;  // one a geometry
};

namespace {

enum class Ask { closest, any, all };

// Rays that are traced together, and the hits of each.
class RayBatch {
 public:
  static constexpr std::size_t kRays = 256;

  RayBatch(const RayQueries::Parts& parts, Ask ask) : parts_(parts), ask_(ask) {}

  // Traces at most kRays rays.
  void trace(std::span<const QueryRay> rays);
  // Returns what is known about a ray of the last trace().
  const Blocked& answer(std::size_t ray) const { return answers_[ray]; }
  // Returns the first hit that was kept for the ray. Unless hasOthers(), no ray of the batch has
  // another.
  const QueryHit& first(std::size_t ray) const { return first_[ray]; }
  bool hasOthers() const { return !others_.empty(); }
  std::vector<QueryHit>& hits(std::size_t ray);

  // Decides about a candidate of a ray. Returns true if the ray ends there, at Embree's distance
  // `tFar`.
  bool meet(unsigned ray, PlacedTriangleId id, float& tFar);
  // Accepts a triangle that is surely hit at `tFar`, and leaves its exact hit for later, when
  // nothing nearer is found. Returns false if that is not possible.
  bool postpone(unsigned ray, PlacedTriangleId id, float& tFar);

 private:
  // A ray in Embree's space.
  struct Start {
    Vec3f origin, direction;
    double perT = 1, shift = 0;  // Embree's distance is t * perT - shift
    float tFar = kNowhere;       // below 0: the ray hits nothing
    float end = 0;               // tFar before any hit
    // The nearest postponed triangle, and Embree's distance of its hit.
    PlacedTriangleId postponed{kMiss, kNoInstance};
    float at = 0;
  };

  using Other = std::pair<std::uint32_t, QueryHit>;  // a ray's number and a hit of it

  bool start(const QueryRay& ray, Start& to) const;
  bool keep(unsigned ray, const QueryHit& hit, float& tFar);
  template <typename Single, typename Packet>
  void traceAs();

  const RayQueries::Parts& parts_;
  Ask ask_;
  std::span<const QueryRay> rays_;
  std::array<Start, kRays> starts_;
  std::array<Blocked, kRays> answers_;
  std::array<QueryHit, kRays> first_;  // the first hit that was kept for each ray
  std::vector<Other> others_;
  std::vector<QueryHit> hits_;
};

PlacedTriangleId placed(const EmbreeContext* context, std::uint32_t number) {
  const unsigned instance = context->instID[0];
  const bool inWorld = instance == RTC_INVALID_GEOMETRY_ID;
  return {number, inWorld ? kNoInstance : instance - kFirstInstance};
}

// True where single precision is enough to know that the ray hits the triangle, and where.
bool isSurelyHit(const RTCFilterFunctionNArguments& args, unsigned lane, float margin) {
  RTCHitN* const hit = args.hit;
  RTCRayN* const ray = args.ray;
  const unsigned n = args.N;
  const float u = RTCHitN_u(hit, n, lane), v = RTCHitN_v(hit, n, lane);
  if (!(std::min({u, v, 1 - u - v}) > margin)) return false;

  // At a grazing angle the distance of the hit is not reliable.
  constexpr float kLeastSlope = 0x1p-6f;
  const Vec3f normal{RTCHitN_Ng_x(hit, n, lane), RTCHitN_Ng_y(hit, n, lane),
                     RTCHitN_Ng_z(hit, n, lane)};
  const Vec3f way{RTCRayN_dir_x(ray, n, lane), RTCRayN_dir_y(ray, n, lane),
                  RTCRayN_dir_z(ray, n, lane)};
  const float slope = dot(normal, way);
  return slope * slope > kLeastSlope * kLeastSlope * dot(normal, normal) * dot(way, way);
}

void filterCandidates(const RTCFilterFunctionNArguments* args) {
  RayBatch& batch = *static_cast<RayBatch*>(batchOf(args->context));
  const auto& triangles = *static_cast<const EnlargedTriangles*>(args->geometryUserPtr);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    const std::uint32_t primitive = RTCHitN_primID(args->hit, args->N, lane);
    const PlacedTriangleId id = placed(args->context, triangles.first + primitive);
    const unsigned ray = RTCRayN_id(args->ray, args->N, lane);
    float& tFar = RTCRayN_tfar(args->ray, args->N, lane);

    // Most candidates are hit far from their edges and need no exact test yet.
    const bool ends =
        (isSurelyHit(*args, lane, triangles.margins[primitive]) && batch.postpone(ray, id, tFar)) ||
        batch.meet(ray, id, tFar);
    args->valid[lane] = ends ? -1 : 0;
  }
}

void boundBox(const RTCBoundsFunctionArguments* args) {
  const Box& box = static_cast<const QuerySpheres*>(args->geometryUserPtr)->boxes[args->primID];
  *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0,
                     box.upper.x, box.upper.y, box.upper.z, 0};
}

template <typename Arguments>
void meetSpheres(const Arguments& args, RTCRayN* rays) {
  RayBatch& batch = *static_cast<RayBatch*>(batchOf(args.context));
  const auto& spheres = *static_cast<const QuerySpheres*>(args.geometryUserPtr);
  const PlacedTriangleId id = placed(args.context, spheres.first + args.primID);
  for (unsigned lane = 0; lane < args.N; ++lane) {
    if (args.valid[lane] == 0) continue;
    float& tFar = RTCRayN_tfar(rays, args.N, lane);
    float end = tFar;
    if (batch.meet(RTCRayN_id(rays, args.N, lane), id, end)) tFar = std::min(tFar, end);
  }
}

void intersectSpheres(const RTCIntersectFunctionNArguments* args) {
  meetSpheres(*args, RTCRayHitN_RayN(args->rayhit, args->N));
}
void occludeSpheres(const RTCOccludedFunctionNArguments* args) { meetSpheres(*args, args->ray); }

// Computes where the ray enters and leaves the ball. Returns false where it is unknown which part
// of the scene the ray crosses.
bool RayBatch::start(const QueryRay& ray, Start& to) const {
  to.tFar = kNowhere;
  to.postponed.triangle = kMiss;

  // A ray with an empty interval hits nothing. A NaN or a direction out of range leaves the answer
  // unknown.
  const double size = length(ray.direction);
  if (!isFinite(ray.origin) || !(size > kShortest && size < kLongest)) return false;
  if (!(ray.tNear <= ray.tFar)) return ray.tNear > ray.tFar;

  // A ray crosses the ball if its point closest to the center lies inside.
  const QueryFrame& frame = parts_.frames[0];
  const Vec3d unit = ray.direction / size;
  const Vec3d origin = frame.of(ray.origin);
  const double along = -dot(origin, unit);  // to the point next to the center
  const Vec3d nearest = origin + unit * along;
  const double room = kBall * kBall - dot(nearest, nearest);
  const bool known = maxComponent(abs(origin)) < kFarthestOrigin;
  if (!(room > 0)) return known;

  // Embree's ray starts at tNear or where the ray enters the ball, moved back by the error along
  // it.
  const double half = std::sqrt(room);
  to.perT = size / frame.scale;
  to.shift = std::max(along - half, ray.tNear * to.perT) - kAlong;
  to.origin = Vec3f(nearest + unit * (to.shift - along));
  to.direction = Vec3f(unit);
  to.tFar = static_cast<float>(std::min(along + half, ray.tFar * to.perT) + kAlong - to.shift);
  to.end = to.tFar;
  return known;
}

bool RayBatch::postpone(unsigned ray, PlacedTriangleId id, float& tFar) {
  // The tolerance is the error of distances along the ray, in Embree's units.
  constexpr auto kApart = static_cast<float>(kAlong);
  if (ask_ == Ask::all) return false;
  Start& start = starts_[ray];
  const float t = tFar;
  // The exact test decides near the ends of the ray.
  if (!(t > 2 * kApart && t < start.end - 2 * kApart)) return false;

  if (ask_ == Ask::any) {
    answers_[ray] = {true, true};
    tFar = kNowhere;
    return true;
  }

  // An earlier postponed triangle is replaced only by one that is surely not behind it.
  if (start.postponed.triangle != kMiss && t >= start.at - kApart) return false;
  start.postponed = id;
  start.at = t;
  __builtin_prefetch(&parts_.scene.triangles[id.triangle]);

  // Embree goes on with candidates that the error may put behind this one.
  tFar = start.tFar = std::min(start.tFar, t + kApart);
  return true;
}

bool RayBatch::keep(unsigned ray, const QueryHit& hit, float& tFar) {
  if (ask_ == Ask::any) {
    answers_[ray] = {true, hit.certain};
    tFar = kNowhere;
    return hit.certain;
  }

  const auto isSurelyBefore = [](const QueryHit& a, const QueryHit& b) {
    return a.certain && a.t + a.tError < b.t - b.tError;
  };
  QueryHit& first = first_[ray];
  const bool nearest = ask_ == Ask::closest;

  // Where only the nearest hit counts, hits that are surely behind the first one are dropped.
  if (!first.found() || (nearest && isSurelyBefore(hit, first))) {
    first = hit;
  } else if (!nearest || !isSurelyBefore(first, hit)) {
    others_.emplace_back(ray, hit);
  }

  if (!nearest || !hit.certain) return false;
  // Embree goes on to find all candidates at this distance, whichever of them it tests first.
  Start& start = starts_[ray];
  const double end = (hit.t + hit.tError) * start.perT - start.shift + kAlong;
  start.tFar = std::min(start.tFar, static_cast<float>(end));
  tFar = start.tFar;
  return true;
}

bool RayBatch::meet(unsigned ray, PlacedTriangleId id, float& tFar) {
  if (parts_.scene.isSphere(id.triangle)) {
    QueryHit hits[2];
    const int count = parts_.meetSphere(rays_[ray], id, hits);
    bool ends = false;
    for (int i = 0; i < count; ++i) ends = keep(ray, hits[i], tFar) || ends;
    return ends;
  }

  const std::optional<QueryHit> hit = parts_.meetTriangle(rays_[ray], id);
  return hit && keep(ray, *hit, tFar);
}

template <typename Packet>
auto& rayOf(Packet& packet) {
  if constexpr (kWantsHits<Packet>) {
    return packet.ray;
  } else {
    return packet;
  }
}

// Traces rays with similar origins and directions as a packet, others one by one.
template <typename Single, typename Packet>
void RayBatch::traceAs() {
  RTCScene const scene = parts_.scenes[0].get();

  // Any-hit queries of coherent packets may never return (EmbreeScene::coherentAnyHitMayHang).
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
      alignas(64) Packet packet{};
      alignas(64) int live[kPacket];
      auto& rays = rayOf(packet);
      for (std::size_t i = 0; i < kPacket; ++i) {
        const Start& s = run[i];
        rays.org_x[i] = s.origin.x;
        rays.org_y[i] = s.origin.y;
        rays.org_z[i] = s.origin.z;
        rays.dir_x[i] = s.direction.x;
        rays.dir_y[i] = s.direction.y;
        rays.dir_z[i] = s.direction.z;
        rays.tfar[i] = s.tFar;
        rays.mask[i] = ~0u;
        rays.id[i] = static_cast<unsigned>(begin + i);
        live[i] = -1;
      }

      // The ids start as those of a miss, because Embree writes the ids of hits only.
      if constexpr (kWantsHits<Packet>) {
        std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
      }
      together.trace(scene, packet, live);
      continue;
    }

    for (std::size_t i = 0; i < n; ++i) {
      const Start& s = run[i];
      if (!(s.tFar >= 0)) continue;

      const Vec3f &o = s.origin, &d = s.direction;
      const auto number = static_cast<unsigned>(begin + i);
      Single single{};
      rayOf(single) = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, s.tFar, ~0u, number, 0};
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
  for (std::size_t i = 0; i < rays.size(); ++i) {
    answers_[i] = {false, start(rays[i], starts_[i])};
    first_[i] = {};
  }

  if (ask_ == Ask::any) {
    traceAs<RTCRay, RTCRay16>();
  } else {
    traceAs<RTCRayHit, RTCRayHit16>();

    // Postponed triangles get their exact hits when nothing nearer can come any more.
    for (unsigned i = 0; i < rays.size(); ++i) {
      float tFar = 0;
      if (starts_[i].postponed.triangle != kMiss) meet(i, starts_[i].postponed, tFar);
    }
  }

  // hits() looks for a ray's other hits by its number.
  std::ranges::stable_sort(others_, {}, [](const auto& other) { return other.first; });
}

std::vector<QueryHit>& RayBatch::hits(std::size_t ray) {
  hits_.clear();
  if (!first_[ray].found()) return hits_;
  hits_.push_back(first_[ray]);
  const auto isBefore = [](const Other& other, std::size_t own) { return other.first < own; };
  auto next = std::lower_bound(others_.begin(), others_.end(), ray, isBefore);
  for (; next != others_.end() && next->first == ray; ++next) hits_.push_back(next->second);
  return hits_;
}

}  // namespace

RayQueries::Parts::Parts(const Scene& scene_, int threads, Progress* progress)
    : scene(scene_), masks(makeMasks(scene_, true)), device(newDevice(threads)) {
  const Box world{scene.lower, scene.upper};
  std::vector<double> rims(scene.geometries.size(), kRim);

  // Each geometry has a frame of its own, so that floats are as fine as its extent allows.
  for (std::size_t g = 0; g < scene.geometries.size(); ++g) {
    const Geometry& geometry = scene.geometries[g];
    Box box = g == 0 ? world : Box();
    if (g != 0) {
      for (const Vec3f& p : geometry.position) box.add(p);
      for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
        const Box sphere = sphereBounds(sphereMap(scene.triangles[geometry.firstSphere + i]));
        box.add(sphere.lower);
        box.add(sphere.upper);
      }
    }

    frames.push_back(frameAround(box));
    scenes.emplace_back(rtcNewScene(device.get()));
    rtcSetSceneFlags(scenes[g].get(), RTC_SCENE_FLAG_ROBUST);
  }

  // Embree transforms rays into an instance with the error that they have in the world, so the
  // triangles of small instances are enlarged more.
  for (const InstanceRecord& instance : scene.instances) {
    const Affine& map = instance.toWorld;
    const double squares = dot(map.x, map.x) + dot(map.y, map.y) + dot(map.z, map.z);

    // This is a lower bound on the map's smallest singular value: determinant over the product of
    // the others, which is at most half the sum of their squares.
    const double least = 2 * std::abs(map.determinant()) / squares;
    double& rim = rims[instance.geometry];
    const double carried = 1 + frames[0].scale / (frames[instance.geometry].scale * least);
    rim = std::min(std::max(rim, kRim * carried), kWidestRim);
  }

  // The world comes last, because its instances need the Embree scenes of the other geometries.
  for (std::size_t g = scene.geometries.size(); g-- > 0;) {
    addTriangles(g, rims[g], threads);
    addSpheres(g, rims[g]);
    for (std::uint32_t i = 0; g == 0 && i < scene.instances.size(); ++i) addInstance(i);
    commitScene(device.get(), scenes[g].get(), progress);
  }
}

void RayQueries::Parts::addTriangles(std::size_t index, double rim, int threads) {
  const Geometry& source = scene.geometries[index];
  const std::size_t count = source.index.size();
  if (count == 0) return;
  const GeometryHandle held(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* const vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      held.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 3 * count));
  auto* const indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      held.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
  if (!vertices || !indices) throwLimit("rays: Embree is out of memory");

  // Enlarging moves the corners apart that triangles share, so each triangle has three vertices.
  std::iota(indices, indices + 3 * count, 0u);
  EnlargedTriangles& own = triangles.emplace_back();
  own.first = source.firstTriangle;
  own.margins.resize(count);

  constexpr std::size_t kChunk = 4096;
  parallelFor(threads, (count + kChunk - 1) / kChunk, [&](std::size_t chunk, int) {
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, count); ++i) {
      const auto number = own.first + static_cast<std::uint32_t>(i);
      Corners corners = worldCorners(scene, number, kNoInstance);
      for (Vec3d& corner : corners) corner = frames[index].of(corner);
      own.margins[i] = marginOf(number, corners, rim);
      corners = enlarged(corners, rim);
      std::ranges::transform(corners, vertices + 3 * i, [](const Vec3d& p) { return Vec3f(p); });
    }
  });

  rtcSetGeometryUserData(held.get(), &own);
  rtcSetGeometryIntersectFilterFunction(held.get(), filterCandidates);
  rtcSetGeometryOccludedFilterFunction(held.get(), filterCandidates);
  rtcCommitGeometry(held.get());
  rtcAttachGeometryByID(scenes[index].get(), held.get(), kTriangles);
}

void RayQueries::Parts::addSpheres(std::size_t index, double rim) {
  const Geometry& source = scene.geometries[index];
  if (source.spheres == 0) return;
  QuerySpheres& own = spheres.emplace_back();
  own.first = source.firstSphere;
  for (std::uint32_t i = 0; i < source.spheres; ++i) {
    const Box box = sphereBounds(sphereMap(scene.triangles[own.first + i]));
    const Vec3d room(2 * rim + kRim);
    Box& to = own.boxes.emplace_back();
    to.lower = Vec3f(frames[index].of(Vec3d(box.lower)) - room);
    to.upper = Vec3f(frames[index].of(Vec3d(box.upper)) + room);
  }

  const GeometryHandle held(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(held.get(), source.spheres);
  rtcSetGeometryUserData(held.get(), &own);
  rtcSetGeometryBoundsFunction(held.get(), boundBox, nullptr);
  rtcSetGeometryIntersectFunction(held.get(), intersectSpheres);
  rtcSetGeometryOccludedFunction(held.get(), occludeSpheres);
  rtcCommitGeometry(held.get());
  rtcAttachGeometryByID(scenes[index].get(), held.get(), kSpheres);
}

// Returns twice the enlargement in units of a weight, which grows from 0 to 1 along the least
// height.
float RayQueries::Parts::marginOf(std::uint32_t number, const Corners& corners, double rim) const {
  const Mask& mask = masks[scene.triangles[number].material];
  if (mask.map || !mask.doubleSided) return std::numeric_limits<float>::infinity();

  const Vec3d ab = corners[1] - corners[0];
  const Vec3d bc = corners[2] - corners[1];
  const Vec3d ca = corners[0] - corners[2];
  const double longest = std::max({length(ab), length(bc), length(ca)});
  const double height = length(cross(ab, ca)) / longest;
  return static_cast<float>(std::min(2 * rim / height, 1.0));
}

void RayQueries::Parts::addInstance(std::uint32_t number) {
  const InstanceRecord& instance = scene.instances[number];
  const QueryFrame& own = frames[instance.geometry];
  const Affine& map = instance.toWorld;

  // The transform leads from the frame of the geometry to the frame of the world.
  const double factor = own.scale / frames[0].scale;
  const Vec3f columns[4] = {Vec3f(map.x * factor), Vec3f(map.y * factor), Vec3f(map.z * factor),
                            Vec3f(frames[0].of(map.point(own.center)))};

  const GeometryHandle held(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(held.get(), scenes[instance.geometry].get());
  rtcSetGeometryTransform(held.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcCommitGeometry(held.get());
  rtcAttachGeometryByID(scenes[0].get(), held.get(), kFirstInstance + number);
}

// The signs of three volumes say on which sides of its edges a ray passes a triangle. All errors
// are bounded by products of sums of magnitudes, which are above the lengths of the vectors.
std::optional<QueryHit> RayQueries::Parts::meetTriangle(const QueryRay& ray,
                                                        PlacedTriangleId id) const {
  // A product of three vectors has seven roundings in a row, each of at most twice the bound.
  constexpr double kRounding = 16 * 0x1p-53;

  const Corners corners = worldCorners(scene, id.triangle, id.instance);
  const Vec3d a = corners[0] - ray.origin, b = corners[1] - ray.origin, c = corners[2] - ray.origin;
  const Vec3d ab = corners[1] - corners[0];
  const Vec3d bc = corners[2] - corners[1];
  const Vec3d ca = corners[0] - corners[2];
  const double sizeA = sumOf(a), sizeB = sumOf(b), sizeC = sumOf(c), sizeD = sumOf(ray.direction);
  const double sizeAB = sumOf(ab), sizeBC = sumOf(bc), sizeCA = sumOf(ca);

  double moved = 0;  // bound on the error of a corner that an instance transforms
  if (id.instance != kNoInstance) {
    const Affine& map = scene.instances[id.instance].toWorld;
    const float* p = scene.triangles[id.triangle].position;
    for (int i = 0; i < 9; i += 3) {
      moved = std::max(moved, 8 * 0x1p-53 * magnitudeOf({p[i], p[i + 1], p[i + 2]}, &map));
    }
  }

  const auto errorOf = [&](double size, double edge) {
    return sizeD * (kRounding * size * edge + 4 * moved * (size + edge + moved));
  };

  // A weight is the volume that the ray's direction spans with an edge, as seen from its origin.
  const double wa = dot(ray.direction, cross(b, bc));
  const double wb = dot(ray.direction, cross(c, ca));
  const double wc = dot(ray.direction, cross(a, ab));
  const double ea = errorOf(sizeB, sizeBC);
  const double eb = errorOf(sizeC, sizeCA);
  const double ec = errorOf(sizeA, sizeAB);
  const Lies la = lies(wa, ea), lb = lies(wb, eb), lc = lies(wc, ec);

  // Two weights of opposite sign mean that the ray passes outside an edge.
  const bool below = la == Lies::below || lb == Lies::below || lc == Lies::below;
  const bool above = la == Lies::above || lb == Lies::above || lc == Lies::above;
  if (below && above) return std::nullopt;
  QueryHit hit;
  hit.id = id;
  hit.certain = la == lb && lb == lc && la != Lies::unknown;

  // The distance is the ratio of height and slope, each of which has its error.
  const Vec3d normal = cross(ab, -ca);
  const double height = dot(normal, a), slope = dot(normal, ray.direction);
  const double area = kRounding * sizeAB * sizeCA + 4 * moved * (sizeAB + sizeCA + moved);
  const double slopeError = area * sizeD;
  if (std::abs(slope) <= slopeError) {
    // A ray parallel to the plane hits nothing; close to the plane, double precision cannot tell.
    if (std::abs(height) > area * sizeA + moved * sizeAB * sizeCA) return std::nullopt;
    hit.t = dot(a, ray.direction) / dot(ray.direction, ray.direction);
    hit.tError = (sizeAB + sizeCA) / length(ray.direction);
    hit.certain = false;
    return isOnRay(ray, hit) ? std::optional(hit) : std::nullopt;
  }

  hit.t = height / slope;
  hit.tError = (area * sizeA + moved * sizeAB * sizeCA + std::abs(hit.t) * slopeError) /
                   (std::abs(slope) - slopeError) +
               0x1p-51 * std::abs(hit.t);
  if (!isOnRay(ray, hit)) return std::nullopt;

  const double sum = wa + wb + wc;
  hit.u = std::clamp(wb / sum, 0.0, 1.0);
  hit.v = std::clamp(wc / sum, 0.0, 1.0 - hit.u);

  // A mirroring transform swaps the sides of a triangle.
  const bool mirrored =
      id.instance != kNoInstance && scene.instances[id.instance].toWorld.determinant() < 0;
  hit.back = (slope > 0) != mirrored;

  // Rays pass single-sided surfaces from behind, and surfaces where a mask cuts them.
  const TriangleRecord& record = scene.triangles[id.triangle];
  const Mask& mask = masks[record.material];
  if (hit.back && !mask.doubleSided) return std::nullopt;
  if (mask.map) {
    const float margin = marginAt<&Mask::cutoff>(mask, record.uv, static_cast<float>(hit.u),
                                                 static_cast<float>(hit.v));
    if (margin < 0) return std::nullopt;
    hit.certain = hit.certain && margin > 0x1p-16f;
  }

  return hit;
}

// In the space of the unit sphere, the ray's point closest to the center shows without cancellation
// whether the sphere is hit (see meetSphere() in bake/sphere.h).
int RayQueries::Parts::meetSphere(const QueryRay& ray, PlacedTriangleId id,
                                  QueryHit (&hits)[2]) const {
  const Affine map = sphereInWorld(scene, id);
  const std::array<Vec3d, 3> rows = inverseRows(map);
  const Vec3d origin = multiply(rows, ray.origin - map.p), way = multiply(rows, ray.direction);
  const double square = dot(way, way), along = -dot(origin, way) / square;
  const Vec3d nearest = origin + way * along;

  // The condition number of the map bounds by how much it magnifies rounding errors.
  const double stretch = (sumOf(rows[0]) + sumOf(rows[1]) + sumOf(rows[2])) *
                         (sumOf(map.x) + sumOf(map.y) + sumOf(map.z));
  const double error = 64 * 0x1p-53 * stretch * (1 + sumOf(origin));

  const double room = 1 - dot(nearest, nearest);
  if (!(room > -error)) return 0;

  // The two hits lie half a chord before and behind that point.
  const double half = std::sqrt(std::max(room, 0.0));
  int count = 0;
  for (const double sign : {-1.0, 1.0}) {
    QueryHit hit;
    hit.id = id;
    hit.t = along + sign * half / std::sqrt(square);
    hit.tError = (error + error / std::max(half, std::sqrt(error))) / std::sqrt(square);
    hit.certain = room > error;
    hit.back = sign > 0;

    if (!isOnRay(ray, hit)) continue;
    const std::array<double, 2> weights = sphereWeights(origin + way * hit.t);
    hit.u = weights[0];
    hit.v = weights[1];

    const Mask& mask = masks[scene.triangles[id.triangle].material];
    if (mask.map) {
      const auto [s, t] = sphereUv(spherePoint(hit.u, hit.v));
      const float margin =
          marginAt<&Mask::cutoff>(mask, static_cast<float>(s), static_cast<float>(t));
      if (margin < 0) continue;
      hit.certain = hit.certain && margin > 0x1p-16f;
    }

    hits[count++] = hit;
  }
  return count;
}

// True for coincident surfaces, between which the scene decides by a rule.
bool RayQueries::Parts::arePartners(PlacedTriangleId a, PlacedTriangleId b) const {
  if (scene.isSphere(a.triangle)) {
    const auto place = scene.coincidentSpheres.find(orderOf(a));
    return place != scene.coincidentSpheres.end() &&
           std::ranges::find(*place->second, b) != place->second->end();
  }

  if (!scene.coplanar.any(a.triangle)) return false;
  const auto partners = scene.coplanar.partnersOf(a);
  return std::ranges::find(partners, b) != partners.end();
}

// Applies the rule of surfaces/choose_surface.h, which prefers `a` to `b` if this returns true.
bool RayQueries::Parts::comesBefore(PlacedTriangleId a, PlacedTriangleId b) const {
  const auto preference = [&](PlacedTriangleId id) {
    const std::uint32_t material = scene.triangles[id.triangle].material;
    const std::uint8_t medium = scene.mediumOfMaterial[material];
    const bool isSphere = scene.isSphere(id.triangle);
    const std::uint64_t rank = isSphere ? orderOf(id) : scene.coplanar.rankOf(id);
    return std::tuple(!scene.materials[material].passesLight(), medium == 0,
                      scene.media[medium].priority, rank);
  };

  return preference(a) > preference(b);
}

// True where both hits may lie on an edge or a corner that the triangles share, seen from one side.
bool RayQueries::Parts::areNeighbors(const QueryHit& a, const QueryHit& b) const {
  if (a.certain || b.certain || a.back != b.back || a.id.instance != b.id.instance ||
      scene.isSphere(a.id.triangle) || scene.isSphere(b.id.triangle)) {
    return false;
  }
  const Corners own = worldCorners(scene, a.id.triangle, kNoInstance);
  const Corners other = worldCorners(scene, b.id.triangle, kNoInstance);
  return std::ranges::find_first_of(own, other) != own.end();
}

namespace {

bool isNearer(const QueryHit& a, const QueryHit& b) {
  return std::tuple(a.t, orderOf(a.id)) < std::tuple(b.t, orderOf(b.id));
}
bool mayBeAtOnce(const QueryHit& a, const QueryHit& b) {
  return std::abs(a.t - b.t) <= a.tError + b.tError;
}

}  // namespace

QueryHit RayQueries::Parts::nearestOf(std::vector<QueryHit>& hits) const {
  if (hits.empty()) return {};
  if (hits.size() == 1) return hits[0];
  std::ranges::sort(hits, isNearer);
  QueryHit nearest = hits[0];

  // Among coincident surfaces, the scene's rule chooses.
  for (const QueryHit& hit : hits) {
    if (mayBeAtOnce(hit, hits[0]) && arePartners(nearest.id, hit.id) &&
        comesBefore(hit.id, nearest.id)) {
      nearest = hit;
    }
  }

  // Any other surface that may be as near makes the answer uncertain.
  for (const QueryHit& hit : hits) {
    if (hit.id == nearest.id || hit.t - hit.tError > nearest.t + nearest.tError) continue;
    // Coincident surfaces do not count, because the rule has chosen among them.
    if (!arePartners(nearest.id, hit.id)) nearest.certain = false;
  }

  return nearest;
}

void RayQueries::Parts::keepDistinct(std::vector<QueryHit>& hits) const {
  std::ranges::sort(hits, isNearer);
  std::vector<QueryHit> kept;
  double largestError = 0;  // of the kept hits

  for (const QueryHit& hit : hits) {
    bool isNew = true;

    // A hit repeats an earlier one if both surfaces coincide or share the edge that was hit. A hit
    // between them that is known more exactly may be at another place than both.
    for (std::size_t i = kept.size(); i-- > 0 && isNew;) {
      if (hit.t - kept[i].t > hit.tError + largestError) break;
      if (!mayBeAtOnce(kept[i], hit)) continue;

      if (arePartners(kept[i].id, hit.id)) {
        if (comesBefore(hit.id, kept[i].id)) kept[i] = hit;
        isNew = false;
      } else {
        isNew = kept[i].id != hit.id && !areNeighbors(kept[i], hit);
        // It is unknown which of the two comes first.
        if (isNew) kept[i].certain = false;
      }
    }

    if (isNew) kept.push_back(hit);
    largestError = std::max(largestError, hit.tError);
  }

  hits = std::move(kept);
}

RayQueries::RayQueries(const Scene& scene, int threads, Progress* progress)
    : parts_(std::make_unique<Parts>(scene, threads, progress)) {}
RayQueries::~RayQueries() = default;

namespace {

// Calls visit(batch, ray of the batch, ray) for each ray when it has been traced.
template <typename Visitor>
void ask(const RayQueries::Parts& parts, Ask what, std::span<const QueryRay> rays,
         const Visitor& visit) {
  RayBatch batch(parts, what);
  for (std::size_t begin = 0; begin < rays.size(); begin += RayBatch::kRays) {
    const std::size_t n = std::min(RayBatch::kRays, rays.size() - begin);
    batch.trace(rays.subspan(begin, n));
    for (std::size_t i = 0; i < n; ++i) visit(batch, i, begin + i);
  }
}

}  // namespace

void RayQueries::closest(std::span<const QueryRay> rays, QueryHit* hits) const {
  ask(*parts_, Ask::closest, rays, [&](RayBatch& batch, std::size_t i, std::size_t ray) {
    hits[ray] = batch.hasOthers() ? parts_->nearestOf(batch.hits(i)) : batch.first(i);
    hits[ray].certain = hits[ray].certain && batch.answer(i).certain;
  });
}

void RayQueries::blocked(std::span<const QueryRay> rays, Blocked* answers) const {
  ask(*parts_, Ask::any, rays,
      [&](RayBatch& batch, std::size_t i, std::size_t ray) { answers[ray] = batch.answer(i); });
}

void RayQueries::all(std::span<const QueryRay> rays, std::size_t limit, std::vector<QueryHit>& hits,
                     std::size_t* counts) const {
  ask(*parts_, Ask::all, rays, [&](RayBatch& batch, std::size_t i, std::size_t ray) {
    std::vector<QueryHit>& found = batch.hits(i);
    parts_->keepDistinct(found);
    counts[ray] = std::min(found.size(), limit);
    for (std::size_t k = 0; k < counts[ray]; ++k) {
      hits.push_back(found[k]);
      hits.back().certain = found[k].certain && batch.answer(i).certain;
    }
  });
}

}  // namespace whit
