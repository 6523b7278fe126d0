// Triangles that share their place with another one in its plane: flush boxes, decals in a floor,
// instances in one place, glass that stands on a floor. A ray meets them at the same distance, and
// which of them is nearer has to be settled by a rule.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bake/covered_part.h"

namespace whit {

class Scene;
class TriangleBlocks;
struct SceneOrder;

inline constexpr std::uint32_t kNoInstance = 0xffffffffu;

// A triangle where it stands: in the world (kNoInstance) or carried by an instance. Indices into
// Scene::triangles and Scene::instances.
struct PlacedTriangleId {
  std::uint32_t triangle = 0, instance = kNoInstance;
  bool operator==(const PlacedTriangleId&) const = default;
};

// Ascending in this are the world's triangles, then those of one instance after the other.
inline std::uint64_t orderOf(PlacedTriangleId id) {
  return std::uint64_t{id.instance + 1} << 32 | id.triangle;
}
inline PlacedTriangleId placedTriangle(std::uint64_t order) {
  return {static_cast<std::uint32_t>(order), static_cast<std::uint32_t>(order >> 32) - 1};
}

class FlushTriangles {
 public:
  FlushTriangles() = default;
  // From each pair once, by the orders of its triangles, whichever first.
  FlushTriangles(std::uint64_t triangles,
                 std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs);

  bool empty() const { return partners_.empty(); }

  // Whether the triangle is flush with another one in some placement of it. Numbers beyond the
  // scene's are not.
  bool any(std::uint32_t triangle) const {
    const std::size_t word = triangle / 64;
    return word < any_.size() && (any_[word] >> triangle % 64 & 1) != 0;
  }

  // The triangles that lie in the plane of this one and touch it, itself excluded, ascending by
  // orderOf(). Empty where it is not flush.
  std::span<const PlacedTriangleId> partnersOf(PlacedTriangleId id) const;

  // Of a scene that has some: false only where forEachPartnerAt() visits none.
  bool anyAt(PlacedTriangleId id, double u, double v) const {
    const Slot& slot = slots_[slotOf(id)];
    return slot.count != 0 && isContested(slot, u, v);
  }

  // Among each other, the first in the scene first; all 0 before this.
  void rankBy(const Scene& scene, const SceneOrder& order);

  // Of a triangle that is flush.
  std::uint32_t rankOf(PlacedTriangleId id) const { return slots_[slotOf(id)].rank; }

  // Of the partners of all, one after the other.
  std::span<const std::uint32_t> ranks() const { return ranks_; }

  // visit(partner, rank) for those that may lie at the point of this one that has the weights u and
  // v of corners 1 and 2. None where none overlaps it there.
  template <typename Visitor>
  void forEachPartnerAt(PlacedTriangleId id, double u, double v, Visitor&& visit) const {
    if (empty()) return;
    const Slot& slot = slots_[slotOf(id)];
    if (slot.count == 0 || !isContested(slot, u, v)) return;
    const Cell& cell = cells_[slot.firstCell + cellAt(u, v, slot.side)];
    const auto own = std::span(inCells_).subspan(cell.first, cell.count);
    const auto holds = [&](std::size_t i) {
      return covered_[i].holds(static_cast<float>(u), static_cast<float>(v));
    };
    const auto overlapping = own.first(cell.overlapping);
    if (std::none_of(overlapping.begin(), overlapping.end(), holds)) return;
    for (const std::size_t i : own) {
      if (holds(i)) visit(partners_[i], ranks_[i]);
    }
  }

  std::uint64_t bytes() const;

 private:
  friend class FlushFinder;

  struct Slot {
    PlacedTriangleId id;
    std::uint32_t count = 0;  // 0: the slot is free
    std::uint32_t rank = 0;
    std::uint64_t first = 0;    // in partners_
    std::size_t firstCell = 0;  // in cells_
    std::size_t side = 1;       // of a square of so many cells a side
    std::size_t firstWord = 0;  // in contested_
    std::size_t maskSide = 0;   // of a finer square
  };
  static std::size_t cellOf(double weight, std::size_t side) {
    const auto most = static_cast<double>(side);
    return static_cast<std::size_t>(std::clamp(weight * most, 0.0, most - 1));
  }
  static std::size_t cellAt(double u, double v, std::size_t side) {
    return cellOf(v, side) * side + cellOf(u, side);
  }
  bool isContested(const Slot& slot, double u, double v) const {
    const std::size_t cell = cellAt(u, v, slot.maskSide);
    return (contested_[slot.firstWord + cell / 64] >> cell % 64 & 1) != 0;
  }
  template <typename Visitor>
  static void forEachCellOf(const CoveredPart& part, std::size_t side, Visitor&& visit);
  void fillCells(Slot& slot, std::span<const std::uint8_t> overlaps);

  std::size_t slotOf(PlacedTriangleId id) const;

  std::vector<std::uint64_t> any_;  // a bit a triangle
  std::vector<Slot> slots_;         // a hash table with open addressing, at most half full
  std::vector<PlacedTriangleId> partners_;
  std::vector<std::uint32_t> ranks_;  // of partners_
  std::vector<CoveredPart> covered_;  // by each of them of the one whose partner it is
  // Partners by place: of each cell that some partner overlaps, all that reach into it, those that
  // overlap first.
  struct Cell {
    std::uint64_t first = 0;  // in inCells_
    std::uint32_t count = 0, overlapping = 0;
  };
  std::vector<Cell> cells_;
  std::vector<std::size_t> inCells_;  // places in partners_
  // A bit a cell of the finer squares, for those that some overlapping partner reaches into.
  std::vector<std::uint64_t> contested_;
};

// Two placed triangles lie in one plane if the corners of each are no farther from the plane of the
// other than the sum of their error bounds (see Facet). They overlap if no edge of either, by its
// normal in the plane, leaves them less than that sum in common, and touch if none separates them
// by more. What is found are the triangles that overlap another one in their plane, and those that
// touch one of these in its plane; both are partners of all of them that they touch in their plane.
// Triangles without area are left out.
//
// The work is bounded, and pairs beyond the bound are not found: where more than some thousands of
// triangles are in one place each is compared with a part of the others, and of instances that lie
// in heaps so deep that they have thousands of pairs for each triangle of the scene some heaps are
// not searched to their end. Of instances of one object in exactly one place, only the first four
// take part. Scenes of more triangles than kMostSearched, each instanced object counted once, are
// not searched: at a microsecond or two each that would take longer than all else at the start. The
// result is the same for any number of threads.
inline constexpr std::uint64_t kMostSearched = 4'000'000;
FlushTriangles findFlushTriangles(const Scene& scene, int threads);

// What is flush among all that stands still in a scene that moves, looked for once.
struct StillFlush {
  bool known = false;
  std::vector<std::uint32_t> instances;  // InstanceRecord::written of those that were there
  std::vector<std::uint64_t> triangles;  // that overlap others, by orderOf()
  bool all = false;                      // nothing else was flush when the scene was last searched
  std::vector<std::shared_ptr<const TriangleBlocks>> blocks;  // of geometries, as they were then
};

// Searches again where that may have changed: scene.flush comes out as findFlushTriangles() would
// find it, but that what moves and only touches what is flush is a partner of that no more unless
// something that moves overlaps another triangle in its plane.
void updateFlushTriangles(Scene& scene, StillFlush& still, const SceneOrder& order, int threads);

}  // namespace whit
