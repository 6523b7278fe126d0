// The triangles of a scene that is not baked yet, in their places. Exact spheres are looked at as
// facets.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bake/facet.h"
#include "core/affine.h"
#include "core/index.h"
#include "core/vec3.h"
#include "make/shape.h"
#include "scene/description.h"

namespace whit {

// If a model has more triangles, only a sample of them is looked at.
inline constexpr std::uint64_t kMostLookedAt = 4'000'000;
inline constexpr auto kEveryTriangle = std::numeric_limits<std::uint64_t>::max();

// The shadow that addGroundShadow() has added is no part of the model.
inline bool isGroundShadow(const SceneDescription& scene, const Mesh& mesh) {
  const std::uint32_t material = mesh.materials.empty() ? 0 : mesh.materials[0];
  return material < scene.materials.size() && scene.materials[material].name == kGroundShadowName;
}

inline Mesh facettedSphere(int segments) {
  Mesh mesh;
  mesh.spheres = {Affine()};
  procedural::tessellateSpheres(mesh, segments);
  return mesh;
}

// Returns the facets by which the spheres of the scene are looked at. They touch the unit sphere
// where it meets the axes. Those of a few spheres are within half a percent of it; many take less
// time.
inline const Mesh& facetsOfSpheres(const SceneDescription& scene) {
  constexpr std::size_t kFewSpheres = 1000;
  static const Mesh fine = facettedSphere(32), coarse = facettedSphere(8);

  std::size_t spheres = 0;
  for (const Instance& instance : scene.instances) {
    for (const Mesh& mesh : scene.objects[instance.object].meshes) spheres += mesh.spheres.size();
  }
  return spheres <= kFewSpheres ? fine : coarse;
}

inline std::uint64_t placedTriangleCount(const SceneDescription& scene) {
  const std::size_t facets = facetsOfSpheres(scene).triangles.size();
  std::uint64_t count = 0;
  for (const Instance& instance : scene.instances) {
    for (const Mesh& mesh : scene.objects[instance.object].meshes) {
      count += mesh.triangles.size() + mesh.spheres.size() * facets;
    }
  }
  return count;
}

// Returns the corners in the world. Nothing is validated yet, so the result is none if a corner is
// missing or lies beyond the range that can be traced.
inline std::optional<Corners> placed(const std::vector<Vec3f>& positions,
                                     const std::array<std::uint32_t, 3>& triangle,
                                     const Affine& toWorld) {
  Corners corners;
  for (const auto i : indices(3)) {
    if (triangle[i] >= positions.size()) return std::nullopt;
    corners[i] = toWorld.point(Vec3d(positions[triangle[i]]));
    if (!(maxComponent(abs(corners[i])) < double{kLargestCoordinate})) return std::nullopt;
    if (!isFinite(corners[i])) return std::nullopt;
  }
  return corners;
}

// Calls use(corners) for every triangle, or for about `most` of them, evenly spread. A scene that
// moves is posed at the time `seconds`, by default at the time of the scene.
template <typename Use>
void forEachPlacedTriangle(const SceneDescription& scene, std::uint64_t most, const Use& use,
                           std::optional<double> seconds = {}) {
  const std::uint64_t stride = std::max<std::uint64_t>(1, placedTriangleCount(scene) / most);
  const Mesh& facets = facetsOfSpheres(scene);
  const double time = seconds.value_or(scene.motion.seconds);
  const std::vector<Affine> poses = poseRig(scene.motion.rig, time);

  // One count runs over the triangles of all instances, and every stride-th of them is used.
  std::uint64_t number = 0;
  const auto useTriangles = [&](const Mesh& mesh, const std::vector<Vec3f>& positions,
                                const Affine& toWorld) {
    const bool mirrored = toWorld.determinant() < 0;

    const std::uint64_t first = (stride - number % stride) % stride;
    number += mesh.triangles.size();
    for (std::uint64_t i = first; i < mesh.triangles.size(); i += stride) {
      auto corners = placed(positions, mesh.triangles[i], toWorld);
      if (!corners) continue;

      // A transform that mirrors would turn fronts into backs.
      if (mirrored) std::swap((*corners)[1], (*corners)[2]);
      use(*corners);
    }
  };

  for (const Instance& instance : scene.instances) {
    const bool moves = instance.mover != kNoNode;
    const Affine toWorld = moves ? poses[instance.mover] * instance.toWorld : instance.toWorld;

    for (const Mesh& mesh : scene.objects[instance.object].meshes) {
      if (isGroundShadow(scene, mesh)) continue;

      // Morphed and skinned meshes take their shape at that time.
      std::vector<Vec3f> bent;
      if (const Deformation* deformation = mesh.deformation.get()) {
        bent = deformVertices(*deformation, poseAt(*deformation, time)).positions;
      }
      useTriangles(mesh, mesh.deformation ? bent : mesh.positions, toWorld);

      for (const Affine& sphere : mesh.spheres) {
        useTriangles(facets, facets.positions, toWorld * sphere);
      }
    }
  }
}

// Calls use(corner) for each corner of these triangles.
template <typename Use>
void forEachPlacedCorner(const SceneDescription& scene, std::uint64_t most, const Use& use,
                         std::optional<double> seconds = {}) {
  const auto useAll = [&](const Corners& t) { std::ranges::for_each(t, use); };
  forEachPlacedTriangle(scene, most, useAll, seconds);
}

}  // namespace whit
