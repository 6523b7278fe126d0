// The triangles of a scene's description where its instances place them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "bake/facet.h"
#include "scene/description.h"

namespace whit {

inline std::uint64_t placedTriangleCount(const SceneDescription& scene) {
  std::uint64_t count = 0;
  for (const Instance& instance : scene.instances) {
    for (const Mesh& mesh : scene.objects[instance.object].meshes) count += mesh.triangles.size();
  }
  return count;
}

// Returns none where a corner is missing or lies beyond the range that can be traced: nothing is
// validated yet.
inline std::optional<Corners> placed(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle,
                                     const Affine& toWorld) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle[i] >= mesh.positions.size()) return std::nullopt;
    corners[i] = toWorld.point(Vec3d(mesh.positions[triangle[i]]));
    if (!(maxComponent(abs(corners[i])) < double{kLargestCoordinate})) return std::nullopt;
    if (!isFinite(corners[i])) return std::nullopt;
  }
  return corners;
}

// Calls use(corners) for every triangle, or for about `most` of them, evenly spread.
template <typename Use>
void forEachPlacedTriangle(const SceneDescription& scene, std::uint64_t most, const Use& use) {
  const std::uint64_t stride = std::max<std::uint64_t>(1, placedTriangleCount(scene) / most);
  std::uint64_t number = 0;
  for (const Instance& instance : scene.instances) {
    for (const Mesh& mesh : scene.objects[instance.object].meshes) {
      for (const auto& triangle : mesh.triangles) {
        if (number++ % stride != 0) continue;
        const auto corners = placed(mesh, triangle, instance.toWorld);
        if (corners) use(*corners);
      }
    }
  }
}

}  // namespace whit
