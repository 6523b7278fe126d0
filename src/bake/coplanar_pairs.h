// The search for pairs of coplanar triangles. It descends trees of bounding boxes, two nodes at a
// time, and compares triangles whose boxes meet.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "bake/coplanar_triangles.h"
#include "bake/facet.h"
#include "core/box.h"

namespace whit {

// A tree over boxes. Boxes that lie together are sorted to follow one another; eight of them share
// a box of the next level, up to the one box that holds all. Level 0 are the items.
class BoxTree {
 public:
  static constexpr std::uint32_t kChildren = 8;

  BoxTree() = default;
  BoxTree(const std::vector<Box>& items, int threads);

  bool empty() const { return items_.empty(); }
  std::uint32_t top() const { return static_cast<std::uint32_t>(levels_.size() - 1); }
  std::uint32_t count(std::uint32_t level) const {
    return static_cast<std::uint32_t>(levels_[level].size());
  }
  const Box& box(std::uint32_t level, std::uint32_t number) const { return levels_[level][number]; }
  // The index of a box of level 0 among those that the tree was made of.
  std::uint32_t item(std::uint32_t number) const { return items_[number]; }

 private:
  std::vector<std::uint32_t> items_;
  std::vector<std::vector<Box>> levels_;
};

// The tree of a geometry's triangles: of their own boxes in the geometry's space, or, for the
// world, of FacetSpace::boxOf().
BoxTree treeOf(const Scene& scene, std::size_t geometry, int threads);

// The space that is searched: the world, or the space of one instanced geometry for all of its
// instances at once.
class FacetSpace {
 public:
  explicit FacetSpace(const Scene& scene) : scene_(scene) {}
  // Triangles count as ones of the world there. Two of them that overlap in one plane in some
  // instance do so in this space as well.
  FacetSpace(const Scene& scene, const BoxTree& tree, std::uint32_t geometry);

  Facet facet(PlacedTriangleId id) const;
  // A box that holds everything that can touch the triangle.
  Box boxOf(PlacedTriangleId id) const;
  // A box that holds everything that can touch what lies in `box`, which the instance carries.
  Box boxOf(const Box& box, std::uint32_t instance) const;

 private:
  const Affine* toWorld(std::uint32_t instance) const {
    return instance == kNoInstance ? nullptr : &scene_.instances[instance].toWorld;
  }

  const Scene& scene_;
  double error_ = 0;       // of all facets, if it is not 0
  double leastShare_ = 1;  // of a facet's own error in Facet::least
};

// Triangles that are searched: a geometry where it stands, or a list of placed triangles.
struct TriangleGroup {
  const BoxTree* tree = nullptr;
  std::uint32_t instance = kNoInstance;
  std::uint32_t firstTriangle = 0;
  bool isPlaced = false;  // the tree's boxes are FacetSpace::boxOf() already
  const std::vector<std::uint64_t>* list = nullptr;  // of orderOf()
};

// Two orderOf() of triangles.
using FacetPair = std::pair<std::uint64_t, std::uint64_t>;

struct PairSearch {
  const FacetSpace& space;
  std::vector<TriangleGroup> groups;  // without empty ones
  // True if a triangle of `a` may make a pair with one of `b`, which may be the same group.
  bool (*wanted)(const TriangleGroup& a, const TriangleGroup& b);
  bool (*test)(const Facet& a, const Facet& b);  // of facets that lie in one plane
  // Not 0 for triangles without an instance that are left out, by their numbers in the scene;
  // empty: none.
  std::vector<std::uint8_t> leftOut = {};
};

// The triangles of a geometry that can overlap no other one in the space. In a mesh that is tiny
// for its distance from the origin these are nearly all, and they would make most of the work.
std::vector<std::uint8_t> tooNarrowToOverlap(const Scene& scene, const FacetSpace& space,
                                             std::uint32_t geometry, int threads);

// The pairs that pass the test, each once, in an order that does not depend on the number of
// threads. Clears `complete` if the work got out of hand, for a scene of so many triangles, and
// part of it was left out.
std::vector<FacetPair> findPairs(const PairSearch& search, std::uint64_t triangles, int threads,
                                 bool& complete);

}  // namespace whit
