#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "bake/facet.h"
#include "bake/sphere.h"
#include "core/error.h"
#include "core/huge_vector.h"
#include "core/index.h"
#include "core/worker_pool.h"
#include "library/internal.h"
#include "sampling/random_streams.h"

namespace whit::api {

namespace {

constexpr std::size_t kChunk = 2048;  // rays of a task

Vec3d pointAt(const Numbers& numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

void expect(bool fits, const char* what) {
  if (!fits) throwUsage(std::string("rays: expected ") + what);
}

std::size_t countOf(const Numbers& points, const char* what) {
  expect(points.size() % 3 == 0, what);
  return points.size() / 3;
}

// Calls task(first, end) for parts of the rays.
template <typename Task>
void inParts(const Queried& at, std::size_t count, const Task& task) {
  const std::size_t parts = (count + kChunk - 1) / kChunk;
  parallelFor(at.threads, parts, [&](std::size_t part, int) {
    reportProgress(at.progress, "tracing rays",
                   static_cast<double>(part) / static_cast<double>(parts));
    task(part * kChunk, std::min((part + 1) * kChunk, count));
  });
}

std::size_t checkedCount(const Rays& rays) {
  const std::size_t count = countOf(rays.directions, "x, y, z of each direction");
  expect(rays.origins.size() == rays.directions.size(), "as many origins as directions");
  for (const Numbers* limit : {&rays.near, &rays.far}) {
    expect(limit->size() <= 1 || limit->size() == count,
           "none, one or as many numbers `near` and `far` as rays");
  }
  return count;
}

// Reads rays from number `first` on. `origin` is that of the scene.
void readRays(const Rays& rays, const Vec3d& origin, std::size_t first, std::span<QueryRay> to) {
  const auto limitOf = [](const Numbers& numbers, std::size_t i, double fallback) {
    if (numbers.size() == 0) return fallback;
    return numbers[numbers.size() == 1 ? 0 : i];
  };

  for (const auto i : indices(to)) {
    const std::size_t ray = first + i;
    to[i].origin = pointAt(rays.origins, ray) - origin;
    to[i].direction = pointAt(rays.directions, ray);
    to[i].tNear = limitOf(rays.near, ray, 0);
    to[i].tFar = limitOf(rays.far, ray, kInfinity);
  }
}

// Allocates all columns in one piece of memory, so that the system has to supply few pages.
RayHits columnsFor(std::size_t count) {
  RayHits hits;
  std::size_t bytes = 0;

  const auto forEachColumn = [&](auto&& visit) {
    visit(hits.t, 1);
    visit(hits.tError, 1);
    visit(hits.points, 3);
    visit(hits.geometricNormals, 3);
    visit(hits.shadingNormals, 3);
    visit(hits.weights, 2);
    visit(hits.uvs, 2);
    visit(hits.triangles, 1);
    visit(hits.objects, 1);
    visit(hits.materials, 1);
    visit(hits.instances, 1);
    visit(hits.sides, 1);
    visit(hits.certain, 1);
  };
  const auto sizeOf = [&](auto span, std::size_t components) {
    return (components * count * sizeof(span[0]) + 63) / 64 * 64;
  };
  forEachColumn([&](auto& span, std::size_t n) { bytes += sizeOf(span, n); });

  HugePageAllocator<std::byte> allocator;
  std::byte* next = allocator.allocate(std::max<std::size_t>(bytes, 1));
  hits.memory = {static_cast<void*>(next), [](void* memory) { std::free(memory); }};

  forEachColumn([&](auto& span, std::size_t n) {
    using Element = typename std::remove_reference_t<decltype(span)>::element_type;
    span = {reinterpret_cast<Element*>(next), n * count};
    next += sizeOf(span, n);
  });
  return hits;
}

template <typename T>
void put(std::span<T> column, std::size_t i, const Vec3d& v) {
  for (int k = 0; k < 3; ++k) column[3 * i + k] = static_cast<T>(v[k]);
}

// Stores the point, the normals and the numbers of a hit.
void putSurface(const whit::Scene& scene, const QueryHit& hit, const RayHits& to, std::size_t i) {
  const std::uint32_t number = hit.id.triangle, instance = hit.id.instance;
  const TriangleRecord& record = scene.triangles[number];
  const Affine* const map = toWorldOf(scene, instance);

  Vec3d point, normal, shading;
  if (scene.isSphere(number)) {
    const Affine own = sphereInWorld(scene, hit.id);
    const Vec3d unit = spherePoint(hit.u, hit.v);
    point = own.point(unit);
    normal = shading = normalized(own.normal(unit));
  } else {
    const Corners corners = worldCorners(scene, number, instance);
    const double w = 1 - hit.u - hit.v;  // weight of corner 0
    point = corners[0] * w + corners[1] * hit.u + corners[2] * hit.v;
    const bool mirrored = map && map->determinant() < 0;
    normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0])) *
             (mirrored ? -1.0 : 1.0);
    shading = normal;

    if (!scene.normals.empty()) {
      const float* const n = scene.normals[number].normal;
      const auto at = [&](int k) { return n[k] * w + n[k + 3] * hit.u + n[k + 6] * hit.v; };
      const Vec3d mean{at(0), at(1), at(2)};
      shading = normalized(map ? map->normal(mean) : mean, normal);
    }
  }

  put(to.points, i, scene.inFile(point));
  put(to.geometricNormals, i, normal);
  put(to.shadingNormals, i, shading);

  const Vec2f uv = uvAt(scene, number, hit.u, hit.v);
  to.uvs[2 * i] = uv.x;
  to.uvs[2 * i + 1] = uv.y;

  const whit::Scene::HitNumbers numbers = scene.numbersOf(number, instance);
  to.triangles[i] = numbers.triangle;
  to.objects[i] = numbers.item;
  to.materials[i] = record.material;
  to.instances[i] = map ? scene.instances[instance].written : kNoInstance;
  to.sides[i] = hit.back ? -1 : 1;
}

void putHit(const whit::Scene& scene, const QueryHit& hit, const RayHits& to, std::size_t i) {
  to.t[i] = hit.t;
  to.tError[i] = hit.tError;
  to.weights[2 * i] = static_cast<float>(hit.u);
  to.weights[2 * i + 1] = static_cast<float>(hit.v);
  to.certain[i] = hit.certain ? 1 : 0;
  if (hit.found()) {
    putSurface(scene, hit, to, i);
    return;
  }

  // The ray missed: its row holds zeros, and kMiss in place of numbers.
  put(to.points, i, {});
  put(to.geometricNormals, i, {});
  put(to.shadingNormals, i, {});
  to.uvs[2 * i] = to.uvs[2 * i + 1] = 0;
  to.triangles[i] = to.objects[i] = to.materials[i] = to.instances[i] = kMiss;
  to.sides[i] = 0;
}

// Asks for each ray makeRay(i) whether it is blocked. `wanted` is the answer that counts as yes.
template <typename MakeRay>
RayAnswers blockedRays(const Queried& at, std::size_t count, bool wanted, const MakeRay& makeRay) {
  RayAnswers answers;
  answers.yes.resize(count);
  answers.certain.resize(count);
  inParts(at, count, [&](std::size_t first, std::size_t end) {
    std::vector<QueryRay> rays;
    for (std::size_t i = first; i < end; ++i) rays.push_back(makeRay(i));
    std::vector<Blocked> blocked(rays.size());
    at.queries.blocked(rays, blocked.data());
    for (std::size_t i = first; i < end; ++i) {
      answers.yes[i] = blocked[i - first].blocked == wanted ? 1 : 0;
      answers.certain[i] = blocked[i - first].certain ? 1 : 0;
    }
  });
  return answers;
}

// Returns a bound on the rounding of a point of some surface. The magnitude of the surface's
// corners is not known, but that of the scene is an upper bound.
double roundingOf(const Queried& at, const Vec3d& point) {
  const Vec3d reach = max(abs(Vec3d(at.scene.lower)), abs(Vec3d(at.scene.upper)));
  return kErrorOfMagnitude * magnitudeOf(max(reach, abs(point)), nullptr);
}

// Returns the point moved off the surface by that bound, to the side of `towards`, as rays of
// pictures start.
Vec3d offSurface(const Queried& at, const Vec3d& point, const Vec3d& normal, const Vec3d& towards) {
  const double offset = roundingOf(at, point);
  return point + normal * (dot(normal, towards) < 0 ? -offset : offset);
}

}  // namespace

RayHits closest(const Queried& at, const Rays& rays) {
  const std::size_t count = checkedCount(rays);
  RayHits hits = columnsFor(count);
  inParts(at, count, [&](std::size_t first, std::size_t end) {
    std::vector<QueryRay> part(end - first);
    std::vector<QueryHit> found(part.size());
    readRays(rays, at.scene.origin, first, part);
    at.queries.closest(part, found.data());
    for (std::size_t i = first; i < end; ++i) putHit(at.scene, found[i - first], hits, i);
  });
  return hits;
}

RayAnswers occluded(const Queried& at, const Rays& rays) {
  return blockedRays(at, checkedCount(rays), true, [&](std::size_t i) {
    QueryRay ray;
    readRays(rays, at.scene.origin, i, {&ray, 1});
    return ray;
  });
}

RayHits allHits(const Queried& at, const Rays& rays, std::size_t limit) {
  const std::size_t count = checkedCount(rays), parts = (count + kChunk - 1) / kChunk;
  std::vector<std::vector<QueryHit>> found(parts);
  std::vector<std::size_t> counts(count);
  inParts(at, count, [&](std::size_t first, std::size_t end) {
    std::vector<QueryRay> part(end - first);
    readRays(rays, at.scene.origin, first, part);
    at.queries.all(part, limit, found[first / kChunk], &counts[first]);
  });

  // The hits of all rays follow each other; offsets say where those of each ray begin.
  std::vector<std::uint64_t> offsets(count + 1);
  for (const auto i : indices(count)) offsets[i + 1] = offsets[i] + counts[i];
  RayHits hits = columnsFor(offsets.back());
  hits.offsets = std::move(offsets);

  inParts(at, count, [&](std::size_t first, std::size_t) {
    std::size_t next = hits.offsets[first];
    for (const QueryHit& hit : found[first / kChunk]) putHit(at.scene, hit, hits, next++);
  });
  return hits;
}

RayAnswers visible(const Queried& at, const Numbers& from, const Numbers& to,
                   const Numbers& fromNormals, const Numbers& toNormals) {
  const std::size_t count = countOf(from, "x, y, z of each point");
  expect(to.size() == from.size(), "as many points at one end as at the other");
  for (const Numbers* normals : {&fromNormals, &toNormals}) {
    expect(normals->size() == 0 || normals->size() == from.size(), "a normal for each point");
  }
  return blockedRays(at, count, false, [&](std::size_t i) {
    constexpr double kWithoutNormal = 4;
    QueryRay ray;
    Vec3d a = pointAt(from, i) - at.scene.origin, b = pointAt(to, i) - at.scene.origin;
    const Vec3d along = b - a;
    const auto passedOver = [&](const Vec3d& p) {
      return kWithoutNormal * roundingOf(at, p) / length(along);
    };

    // With a normal an end moves off its surface; without one the ray begins or ends short of it.
    ray.tFar = 1;
    if (fromNormals.size() == 0) {
      ray.tNear = passedOver(a);
    } else {
      a = offSurface(at, a, normalized(pointAt(fromNormals, i)), along);
    }
    if (toNormals.size() == 0) {
      ray.tFar -= passedOver(b);
    } else {
      b = offSurface(at, b, normalized(pointAt(toNormals, i)), -along);
    }

    ray.origin = a;
    ray.direction = b - a;
    return ray;
  });
}

std::vector<float> ambientOcclusion(const Queried& at, const Numbers& points,
                                    const Numbers& normals, double radius, int samples) {
  const std::size_t count = countOf(points, "x, y, z of each point");
  expect(normals.size() == points.size(), "a normal for each point");
  expect(radius > 0, "a radius above 0");
  expect(samples > 0, "samples above 0");

  std::vector<float> open(count);
  inParts(at, count, [&](std::size_t first, std::size_t end) {
    std::vector<QueryRay> rays(samples);
    std::vector<Blocked> blocked(rays.size());
    const LobeSampling sampling{static_cast<std::uint32_t>(samples)};

    for (std::size_t i = first; i < end; ++i) {
      const Vec3d point = pointAt(points, i) - at.scene.origin;
      const Vec3d normal = normalized(pointAt(normals, i));

      // The random numbers follow from the bits of the point, so that an answer depends on it
      // alone.
      std::uint32_t stream = 0;
      for (int k = 0; k < 3; ++k) {
        const auto bits = std::bit_cast<std::uint64_t>(point[k]);
        stream = mixed(stream ^ static_cast<std::uint32_t>(bits ^ bits >> 32));
      }

      for (std::uint32_t k = 0; k < sampling.count; ++k) {
        const Vec3d direction = cosineDirection(normal, lobePoint(stream, sampling, k));
        rays[k] = {offSurface(at, point, normal, normal), direction, 0, radius};
      }

      at.queries.blocked(rays, blocked.data());
      const auto free = std::ranges::count_if(blocked, [](const Blocked& b) { return !b.blocked; });
      open[i] = static_cast<float>(static_cast<double>(free) / samples);
    }
  });
  return open;
}

}  // namespace whit::api
