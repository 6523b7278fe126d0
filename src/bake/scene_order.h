// The order of a scene as its author wrote it. Its triangles are stored in another one: what is
// used once is baked into the world, what is used more often is kept by itself, and triangles of
// one class lie together. Of faces in one place the later in the scene is met.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "bake/coplanar_triangles.h"

namespace whit {

class Scene;

// The place of a triangle in the order in which the author wrote the scene; less is earlier.
struct WrittenPlace {
  std::uint64_t rank = 0;      // Instance::rank + Mesh::rank
  std::uint32_t instance = 0;  // in SceneDescription::instances
  std::uint32_t triangle = 0;  // in what the instance places

  bool operator<(const WrittenPlace& other) const {
    return std::tie(rank, instance, triangle) <
           std::tie(other.rank, other.instance, other.triangle);
  }
};

// Filled while the scene is baked.
struct SceneOrder {
  // The triangles of a geometry from this number on, up to those of the next mesh.
  struct PlacedMesh {
    std::uint32_t firstTriangle = 0;
    std::uint32_t instance = 0;  // of the world; others are placed by InstanceRecord::written
    std::uint64_t rank = 0;      // likewise
  };
  std::vector<std::vector<PlacedMesh>> meshes;  // one list a geometry, in the order of numbers
  std::vector<std::uint32_t> triangles;         // the number of each of Scene::triangles
  std::vector<std::uint64_t> instances;         // the rank of each of the description

  WrittenPlace placeOf(const Scene& scene, PlacedTriangleId id) const;
};

}  // namespace whit
