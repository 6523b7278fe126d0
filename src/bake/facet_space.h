// Where triangles are searched for neighbors: the world, or the space of one object for all of its
// instances at once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/facet.h"
#include "bake/flush_triangles.h"
#include "bake/triangle_blocks.h"

namespace whit {

// A triangle or, above level 0, a block of triangles of a geometry, by a box in which everything
// lies that can touch it.
struct BoxedBlock {
  std::array<float, 3> lower, upper;
  std::uint32_t instance = kNoInstance;
  std::uint32_t number = 0;  // of the triangle in Scene::triangles, of the block in its level
  std::uint32_t level = 0;
  bool asked = false;  // one of those whose neighbors are searched for, see PairsOf

  PlacedTriangleId id() const { return {number, instance}; }
  // Without branches, which processors could not foresee.
  bool meets(const BoxedBlock& other) const {
    unsigned both = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      both &= unsigned{lower[i] <= other.upper[i]} & unsigned{other.lower[i] <= upper[i]};
    }
    return both != 0;
  }
};

class FacetSpace {
 public:
  // The world, where everything is in its place.
  FacetSpace(const Scene& scene, const BlocksOfGeometries& blocks)
      : scene_(scene), blocks_(blocks) {}

  // The space of a geometry's triangles, which count as ones of the world. Two of them that
  // overlap in one plane in some instance do so here.
  static FacetSpace ofObject(const Scene& scene, const BlocksOfGeometries& blocks,
                             std::uint32_t geometry);

  // Whether an instance is carried by something that moves, or bends.
  bool moves(std::uint32_t instance) const {
    return instance != kNoInstance && scene_.instances[instance].moves;
  }

  Facet facet(PlacedTriangleId id) const;
  BoxedBlock triangle(PlacedTriangleId id) const;

  // All of the space, in few blocks.
  std::vector<BoxedBlock> everything() const;
  // What a block consists of, one level below.
  std::uint32_t firstPart(const BoxedBlock& block) const;
  std::uint32_t endOfParts(const BoxedBlock& block) const;
  BoxedBlock part(const BoxedBlock& block, std::uint32_t number) const;

 private:
  const Affine* toWorld(std::uint32_t instance) const {
    return instance == kNoInstance ? nullptr : &scene_.instances[instance].toWorld;
  }
  std::uint32_t geometryOf(std::uint32_t instance) const {
    return instance == kNoInstance ? geometry_ : scene_.instances[instance].geometry;
  }
  BoxedBlock block(std::uint32_t level, std::uint32_t number, std::uint32_t instance) const;

  const Scene& scene_;
  const BlocksOfGeometries& blocks_;  // one a geometry
  std::uint32_t geometry_ = 0;        // whose triangles are not carried by an instance
  double error_ = 0;                  // of every facet, where it is not its own
  double leastShare_ = 1;             // of a facet's own error in Facet::least
};

}  // namespace whit
