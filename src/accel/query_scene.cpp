#include "accel/query_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "accel/query_batch.h"
#include "bake/sphere.h"
#include "core/error.h"
#include "core/index.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// Corners with a smaller sine than this are lengthened as if they had this sine.
constexpr double kSharpest = 0x1p-10;
// Upper bound on the enlargement of triangles in objects that are tiny beside the scene, so that
// floats can hold them.
constexpr double kMostEnlargement = 1e6;

// Numbers of Embree geometries.
constexpr unsigned kTriangles = 0, kSpheres = 1, kFirstInstance = 2;

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
  for (const auto i : indices(3)) {
    const Vec3d one = normalized(corners[(i + 1) % 3] - corners[i]);
    const Vec3d other = normalized(corners[(i + 2) % 3] - corners[i]);

    // Both edges move outwards by `by` if their corner moves along each of them by `by` over its
    // sine.
    result[i] = corners[i] - (one + other) * (by / std::max(length(cross(one, other)), kSharpest));
  }
  return result;
}

Box boxOf(const Scene& scene, const Geometry& geometry) {
  Box box;
  for (const Vec3f& p : geometry.position) box.add(p);
  for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
    const Box sphere = sphereBounds(sphereMap(scene.triangles[geometry.firstSphere + i]));
    box.add(sphere.lower);
    box.add(sphere.upper);
  }
  return box;
}

void boundBox(const RTCBoundsFunctionArguments* args) {
  const Box& box = static_cast<const QuerySpheres*>(args->geometryUserPtr)->boxes[args->primID];
  *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0,
                     box.upper.x, box.upper.y, box.upper.z, 0};
}

}  // namespace

PlacedTriangleId QueryScene::placed(const EmbreeContext* context, std::uint32_t number) {
  const unsigned instance = context->instID[0];
  const bool inWorld = instance == RTC_INVALID_GEOMETRY_ID;
  return {number, inWorld ? kNoInstance : instance - kFirstInstance};
}

QueryScene::QueryScene(const Scene& scene, int threads, Progress* progress)
    : scene_(scene), exact_(scene), device_(newDevice(threads)) {
  // Each geometry has a frame of its own, so that floats are as fine as its extent allows.
  for (const auto g : indices(scene.geometries)) {
    Box box{scene.lower, scene.upper};
    if (g != 0) box = boxOf(scene, scene.geometries[g]);
    frames_.push_back(frameAround(box));

    scenes_.emplace_back(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scenes_[g].get(), RTC_SCENE_FLAG_ROBUST);
  }

  // The world comes last, because its instances need the Embree scenes of the other geometries.
  const std::vector<double> by = enlargements();
  for (std::size_t g = scene.geometries.size(); g-- > 0;) {
    addTriangles(g, by[g], threads);
    addSpheres(g, by[g]);
    if (g == 0) {
      for (std::uint32_t i = 0; i < scene.instances.size(); ++i) addInstance(i);
    }
    commitScene(device_.get(), scenes_[g].get(), progress);
  }
}

// Returns by how much the triangles of each geometry are enlarged.
std::vector<double> QueryScene::enlargements() const {
  std::vector<double> result(scene_.geometries.size(), kAcrossError);

  // Embree transforms rays into an instance with the error that they have in the world, so the
  // triangles of small instances are enlarged more.
  for (const InstanceRecord& instance : scene_.instances) {
    const Affine& map = instance.toWorld;
    const double squares = dot(map.x, map.x) + dot(map.y, map.y) + dot(map.z, map.z);

    // This is a lower bound on the map's smallest singular value: determinant over the product of
    // the others, which is at most half the sum of their squares.
    const double least = 2 * std::abs(map.determinant()) / squares;
    double& own = result[instance.geometry];
    const double carried = 1 + frames_[0].scale / (frames_[instance.geometry].scale * least);
    own = std::min(std::max(own, kAcrossError * carried), kMostEnlargement);
  }

  return result;
}

void QueryScene::addTriangles(std::size_t index, double enlargement, int threads) {
  const Geometry& source = scene_.geometries[index];
  const std::size_t count = source.index.size();
  if (count == 0) return;

  const GeometryHandle held(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* const vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      held.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 3 * count));
  auto* const indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      held.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
  if (!vertices || !indices) throwLimit("rays: Embree is out of memory");

  // Enlarging moves the corners apart that triangles share, so each triangle has three vertices.
  std::iota(indices, indices + 3 * count, 0u);
  EnlargedTriangles& own = triangles_.emplace_back();
  own.first = source.firstTriangle;
  own.margins.resize(count);

  constexpr std::size_t kChunk = 4096;
  parallelFor(threads, (count + kChunk - 1) / kChunk, [&](std::size_t chunk, int) {
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, count); ++i) {
      const auto number = own.first + static_cast<std::uint32_t>(i);
      Corners corners = worldCorners(scene_, number, kNoInstance);
      for (Vec3d& corner : corners) corner = frames_[index].of(corner);
      own.margins[i] = marginOf(number, corners, enlargement);
      corners = enlarged(corners, enlargement);
      std::ranges::transform(corners, vertices + 3 * i, [](const Vec3d& p) { return Vec3f(p); });
    }
  });

  rtcSetGeometryUserData(held.get(), &own);
  rtcSetGeometryIntersectFilterFunction(held.get(), filterCandidates);
  rtcSetGeometryOccludedFilterFunction(held.get(), filterCandidates);
  rtcCommitGeometry(held.get());
  rtcAttachGeometryByID(scenes_[index].get(), held.get(), kTriangles);
}

void QueryScene::addSpheres(std::size_t index, double enlargement) {
  const Geometry& source = scene_.geometries[index];
  if (source.spheres == 0) return;

  // Boxes are enlarged as triangles are, and by the rounding of their corners.
  QuerySpheres& own = spheres_.emplace_back();
  own.first = source.firstSphere;
  for (std::uint32_t i = 0; i < source.spheres; ++i) {
    const Box box = sphereBounds(sphereMap(scene_.triangles[own.first + i]));
    const Vec3d room(2 * enlargement + kAcrossError);
    Box& to = own.boxes.emplace_back();
    to.lower = Vec3f(frames_[index].of(Vec3d(box.lower)) - room);
    to.upper = Vec3f(frames_[index].of(Vec3d(box.upper)) + room);
  }

  const GeometryHandle held(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(held.get(), source.spheres);
  rtcSetGeometryUserData(held.get(), &own);
  rtcSetGeometryBoundsFunction(held.get(), boundBox, nullptr);
  rtcSetGeometryIntersectFunction(held.get(), intersectSpheres);
  rtcSetGeometryOccludedFunction(held.get(), occludeSpheres);
  rtcCommitGeometry(held.get());
  rtcAttachGeometryByID(scenes_[index].get(), held.get(), kSpheres);
}

// Returns twice the enlargement in units of a weight, which grows from 0 to 1 along the least
// height.
float QueryScene::marginOf(std::uint32_t number, const Corners& corners, double enlargement) const {
  const Mask& mask = exact_.maskOf(number);
  if (mask.map || !mask.doubleSided) return kInfinity;

  const Vec3d ab = corners[1] - corners[0];
  const Vec3d bc = corners[2] - corners[1];
  const Vec3d ca = corners[0] - corners[2];
  const double longest = std::max({length(ab), length(bc), length(ca)});
  const double height = length(cross(ab, ca)) / longest;
  return static_cast<float>(std::min(2 * enlargement / height, 1.0));
}

void QueryScene::addInstance(std::uint32_t number) {
  const InstanceRecord& instance = scene_.instances[number];
  const QueryFrame& own = frames_[instance.geometry];
  const Affine& map = instance.toWorld;

  // The transform leads from the frame of the geometry to the frame of the world.
  const double factor = own.scale / frames_[0].scale;
  const Vec3f columns[4] = {Vec3f(map.x * factor), Vec3f(map.y * factor), Vec3f(map.z * factor),
                            Vec3f(frames_[0].of(map.point(own.center)))};

  const GeometryHandle held(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(held.get(), scenes_[instance.geometry].get());
  rtcSetGeometryTransform(held.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcCommitGeometry(held.get());
  rtcAttachGeometryByID(scenes_[0].get(), held.get(), kFirstInstance + number);
}

}  // namespace whit
