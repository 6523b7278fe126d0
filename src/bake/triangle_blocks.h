// Bounds of the triangles of a geometry, in blocks of eight that follow one another, in blocks of
// eight such blocks and so on. Triangles of a mesh that follow one another are mostly neighbors.
#pragma once

#include <memory>
#include <vector>

#include "bake/scene.h"
#include "core/box.h"

namespace whit {

class TriangleBlocks {
 public:
  static constexpr std::uint32_t kChildren = 8;

  TriangleBlocks(const Scene& scene, const Geometry& geometry, int threads);

  // Of the one block that holds all. Level 0 are the triangles themselves.
  std::uint32_t top() const { return static_cast<std::uint32_t>(levels_.size()); }
  std::uint32_t count(std::uint32_t level) const {
    return level == 0 ? triangles_ : static_cast<std::uint32_t>(levels_[level - 1].size());
  }
  // In the geometry's own space.
  const Box& box(std::uint32_t level, std::uint32_t block) const {
    return levels_[level - 1][block];
  }

 private:
  std::uint32_t triangles_;
  std::vector<std::vector<Box>> levels_;  // from level 1
};

using BlocksOfGeometries = std::vector<std::shared_ptr<const TriangleBlocks>>;

}  // namespace whit
