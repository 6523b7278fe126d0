#include "render/steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bake/facet.h"
#include "bake/sphere.h"

namespace whit {

namespace {

Box boundsWithin(const Scene& scene, const Geometry& geometry) {
  Box box;
  for (std::size_t i = 0; i < geometry.index.size(); ++i) {
    const TriangleRecord& triangle = scene.triangles[geometry.firstTriangle + i];
    if (scene.mediumOfMaterial[triangle.material] == 0) continue;
    for (int k = 0; k < 9; k += 3) {
      box.add({triangle.position[k], triangle.position[k + 1], triangle.position[k + 2]});
    }
  }
  for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
    const TriangleRecord& sphere = scene.triangles[geometry.firstSphere + i];
    if (scene.mediumOfMaterial[sphere.material] == 0) continue;
    const Box own = sphereBounds(sphereMap(sphere));
    box.add(own.lower);
    box.add(own.upper);
  }
  return box;
}

// In no plane, and through no edge, that a model is likely to have.
const Vec3f kUpwards(normalized(Vec3d{0.3217, 0.8431, 0.4309}));

struct HitSurface {
  Vec3d outside;  // its normal
  Vec3d reach;    // by axis, the largest distance from the line's start to a point of the shape
};

HitSurface surfaceOf(const Scene& scene, const Hit& hit, const Vec3d& start) {
  const bool instanced = hit.instance != kNoInstance;
  const Affine toWorld = instanced ? scene.instances[hit.instance].toWorld : Affine();
  if (scene.isSphere(hit.triangle)) {
    const Affine map = toWorld * sphereMap(scene.triangles[hit.triangle]);
    return {map.normal(spherePoint(double{hit.u}, double{hit.v})),
            abs(map.x) + abs(map.y) + abs(map.z) + abs(map.p - start)};
  }
  const auto [a, b, c] = worldCorners(scene, hit.triangle, hit.instance);
  const double sign = toWorld.determinant() < 0 ? -1 : 1;  // a mirroring map swaps the sides
  return {cross(b - a, c - a) * sign, max(abs(a - start), max(abs(b - start), abs(c - start)))};
}

// Follows a line upwards through all surfaces and notes the dielectrics whose faces it crosses:
// their media, and true where it enters one.
std::vector<std::pair<std::uint32_t, bool>> facesAbove(const TracedScene& traced,
                                                       const Vec3d& point) {
  const Scene& scene = traced.scene;
  const Vec3d up(kUpwards);
  std::vector<std::pair<std::uint32_t, bool>> crossed;
  // A line meets a triangle once and a sphere twice; rounding may make it more.
  std::uint64_t left = 2 * scene.instancedTriangles + 4 * scene.instancedSpheres + 16;
  for (double way = 0; left > 0; --left) {
    const Vec3d start = point + up * way;
    Hit hit = traced.accel.closest(Vec3f(start), kUpwards);
    if (!hit.found()) break;
    if (scene.isSphere(hit.triangle)) {
      const PlacedTriangleId found{hit.triangle, hit.instance};
      const SphereHit chosen = chosenSphere(traced, {found, double{hit.u}, double{hit.v}});
      hit.triangle = chosen.id.triangle;
      hit.instance = chosen.id.instance;
      hit.u = static_cast<float>(chosen.u);
      hit.v = static_cast<float>(chosen.v);
    }
    const HitSurface surface = surfaceOf(scene, hit, start);
    const Vec3d n = normalized(surface.outside);
    const double facing = dot(up, n);
    const std::vector<CoplanarFace> faces = coplanarFaces(
        traced, {start, up}, {hit.triangle, hit.instance}, double{hit.u}, double{hit.v});
    for (const CoplanarFace& face : faces) crossed.emplace_back(face.medium, face.entering);
    if (faces.empty()) {
      crossed.emplace_back(scene.mediumOfMaterial[scene.triangles[hit.triangle].material],
                           facing < 0);
    }
    // Continues where the rounding of this hit and of the next start cannot lead to it again.
    const Vec3d size = surface.reach + abs(start) / 4;
    const double error = dot(abs(n), size) + (size.x + size.y + size.z) / 1024;
    way += double{hit.t} + kErrorOfMagnitude * error / std::abs(facing);
  }
  return crossed;
}

// The media around a point: those whose surfaces a line from it leaves without having entered them,
// at most four (stages/columns.h). A ray that comes down the line from outside is in them when it
// reaches the point.
std::uint32_t mediaAround(const TracedScene& traced, const Vec3d& point) {
  if (!traced.effects.has(Effect::transmission)) return 0;
  std::vector<std::uint32_t> around;
  const auto faces = facesAbove(traced, point);
  for (auto face = faces.rbegin(); face != faces.rend(); ++face) {
    const auto [medium, leaves] = *face;
    if (medium == 0) continue;
    if (!leaves) {
      around.push_back(medium);
    } else if (const auto last = std::find(around.rbegin(), around.rend(), medium);
               last != around.rend()) {
      around.erase(std::next(last).base());
    }
  }
  std::uint32_t stack = 0;
  for (const std::uint32_t medium : around) stack = stack << 8 | medium;
  return stack;
}

// True if the eye lies in the surface of a dielectric, so that rays from it start on either side.
bool liesOnDielectric(const TracedScene& traced, const Vec3f& eye) {
  return std::ranges::any_of(std::array{kUpwards, -kUpwards}, [&](const Vec3f& direction) {
    const auto& [scene, accel, effects] = traced;
    const Hit hit = accel.closest(eye, direction);
    return hit.found() && scene.mediumOfMaterial[scene.triangles[hit.triangle].material] != 0 &&
           liesInSurface(scene, Vec3d(eye), hit.triangle, hit.instance);
  });
}

// True if rays that start at different points, all in the plane through the eye, may start in
// different media. The test is conservative because it compares boxes.
bool startsMeet(const CameraFrame& camera, const Box& dielectrics) {
  if (dielectrics.empty()) return false;
  const Vec3d lower = Vec3d(dielectrics.lower), upper = Vec3d(dielectrics.upper);
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (int i = 0; i < 8; ++i) {
    const double ahead = dot(Vec3d(dielectrics.corner(i)) - camera.eye, camera.forward);
    nearest = std::min(nearest, ahead);
    farthest = std::max(farthest, ahead);
  }
  if (nearest > 0 || farthest < 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (camera.eye[axis] + camera.reach[axis] < lower[axis]) return false;
    if (camera.eye[axis] - camera.reach[axis] > upper[axis]) return false;
  }
  return true;
}

}  // namespace

Box dielectricBounds(const Scene& scene) {
  std::vector<Box> boxes;
  for (const Geometry& geometry : scene.geometries) boxes.push_back(boundsWithin(scene, geometry));
  Box all = boxes.empty() ? Box() : boxes[0];
  for (const InstanceRecord& instance : scene.instances) {
    const Box& own = boxes[instance.geometry];
    for (int i = 0; i < 8 && !own.empty(); ++i) {
      all.add(Vec3f(instance.toWorld.point(Vec3d(own.corner(i)))));
    }
  }
  return all;
}

CameraFrame frameWithMedia(const TracedScene& traced, Camera camera, const Image& image,
                           const Box& dielectrics) {
  if (!traced.effects.has(Effect::depthOfField)) camera.aperture = 0;
  CameraFrame frame = makeCameraFrame(camera, image.width, image.height);
  if (!traced.effects.has(Effect::transmission)) return frame;
  frame.media = mediaAround(traced, frame.eye);
  frame.mediaVary = frame.reach != Vec3d() ? startsMeet(frame, dielectrics)
                                           : liesOnDielectric(traced, Vec3f(frame.eye));
  return frame;
}

void findInitialMedia(Chunk& c) {
  if (!c.frame->camera.mediaVary) return;
  // Far enough for the rounding of the sum where a ray leaves at a hundredth of a right angle.
  constexpr int kAttempt = 6;
  const TracedScene traced{*c.frame->scene, *c.frame->accel, c.frame->effects};
  for (std::size_t i = 0; i < c.n; ++i) {
    const Vec3d origin{c.rays.orgX[i], c.rays.orgY[i], c.rays.orgZ[i]},
        direction{c.rays.dirX[i], c.rays.dirY[i], c.rays.dirZ[i]};
    c.rays.media[i] = mediaAround(traced, origin + direction * wayPastEye(origin, kAttempt));
  }
}

}  // namespace whit
