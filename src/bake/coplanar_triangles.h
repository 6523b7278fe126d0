// Coplanar triangles that overlap: boxes face in face, decals in a floor, instances in one place,
// glass that stands on a floor. A ray hits them at the same distance, and a rule decides which of
// them is nearer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace whit {

class Scene;

inline constexpr std::uint32_t kNoInstance = 0xffffffffu;

// A triangle where it stands: in the world (kNoInstance) or carried by an instance. Indices into
// Scene::triangles and Scene::instances.
struct PlacedTriangleId {
  std::uint32_t triangle = 0, instance = kNoInstance;
  bool operator==(const PlacedTriangleId&) const = default;
};

// Key that sorts the triangles of the world before those of the instances, one instance after the
// other.
inline std::uint64_t orderOf(PlacedTriangleId id) {
  return std::uint64_t{id.instance + 1} << 32 | id.triangle;
}
inline PlacedTriangleId placedTriangle(std::uint64_t order) {
  return {static_cast<std::uint32_t>(order), static_cast<std::uint32_t>(order >> 32) - 1};
}

// The finalizer of SplitMix64 (Steele, Lea, Flood 2014).
inline std::uint64_t mixed64(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// Maps the orderOf() of each sphere that is coincident with others to all spheres of that position,
// itself included, in the order of the scene.
using CoincidentSpheres =
    std::map<std::uint64_t, std::shared_ptr<const std::vector<PlacedTriangleId>>>;

// The order of a scene as its author wrote it. Triangles are stored in another one: objects that
// are used once belong to the world, other objects have geometries of their own, and the triangles
// of one class follow each other. Of coplanar faces the later one in the scene is hit.

// The place of a triangle in the order in which the author wrote the scene; less is earlier.
struct WrittenPlace {
  std::uint64_t rank = 0;      // Instance::rank + Mesh::rank
  std::uint32_t instance = 0;  // index in SceneDescription::instances
  std::uint32_t triangle = 0;  // number in what the instance places

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy takes the 0 of the language for a pointer.
  auto operator<=>(const WrittenPlace&) const = default;
};

// Filled while the scene is baked.
struct SceneOrder {
  // The triangles of a geometry from this number on, up to those of the next mesh.
  struct PlacedMesh {
    std::uint32_t firstTriangle = 0;
    std::uint32_t instance = 0;  // instance in the world; others have InstanceRecord::written
    std::uint64_t rank = 0;      // likewise
  };
  std::vector<std::vector<PlacedMesh>> meshes;  // a list for each geometry, in the order of numbers
  std::vector<std::uint32_t> triangles;         // the number of each of Scene::triangles
  std::vector<WrittenPlace> spheres;     // each sphere's place, as if its instance were the first
  std::vector<std::uint64_t> instances;  // the rank of each of the description

  WrittenPlace placeOf(const Scene& scene, PlacedTriangleId id) const;
};

// The part of a triangle that another one in its plane covers at the most, in the weights of
// corners 1 and 2.
struct CoveredPart {
  float u0 = 0, u1 = 0, v0 = 0, v1 = 0;  // a box around it
  // Along each of its edges: what lies outside of the edge has a * u + b * v + c < 0.
  struct Edge {
    float a = 0, b = 0, c = 0;
  };
  std::array<Edge, 3> edges;
  bool overlaps = false;  // more than touches

  bool holds(float u, float v) const {
    return u >= u0 && u <= u1 && v >= v0 && v <= v1 && meets(u, v, 0);
  }
  // Tests a square, given by its corner of the least weights. False only if the square holds no
  // point of the part.
  bool meets(float u, float v, float side) const {
    return std::ranges::all_of(edges, [&](const Edge& e) {
      // The corner of the square that lies farthest to the inner side of the edge decides.
      const float farU = e.a > 0 ? u + side : u;
      const float farV = e.b > 0 ? v + side : v;
      return e.a * farU + e.b * farV + e.c >= 0;
    });
  }
};

class CoplanarTriangles {
 public:
  CoplanarTriangles() = default;
  // Each pair of orderOf() is given once, in any order of its two.
  CoplanarTriangles(const Scene& scene, std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs,
                    int threads);

  bool empty() const { return partners_.empty(); }

  // True if the triangle is coplanar with another one in some placement of it. False for numbers
  // that no triangle has.
  bool any(std::uint32_t triangle) const {
    const std::size_t word = triangle / 64;
    return word < any_.size() && (any_[word] >> triangle % 64 & 1) != 0;
  }

  // The triangles that lie in the plane of this one and touch it, itself excluded, ascending by
  // orderOf(). Empty if there are none.
  std::span<const PlacedTriangleId> partnersOf(PlacedTriangleId id) const;

  // Numbers the coplanar triangles in the order of the scene file; all ranks are 0 before this.
  void rankBy(const Scene& scene, const SceneOrder& order);

  // The triangle must be coplanar with another one.
  std::uint32_t rankOf(PlacedTriangleId id) const { return slots_[slotOf(id)].rank; }

  // The ranks of the partners of all triangles, one after the other.
  std::span<const std::uint32_t> ranks() const { return ranks_; }

  // Calls visit(partner, rank) for partners that may lie at the point of this triangle that has the
  // weights u and v of corners 1 and 2. Visits none if no partner overlaps the triangle there.
  template <typename Visitor>
  void forEachPartnerAt(PlacedTriangleId id, double u, double v, Visitor&& visit) const {
    if (empty()) return;
    const Slot& slot = slots_[slotOf(id)];
    if (slot.count == 0) return;

    // The cell around the point lists all partners that can hold it.
    const Cell& cell = cells_[slot.firstCell + cellAt(u, v, slot.side)];
    const auto own = std::span(inCells_).subspan(cell.first, cell.count);

    const auto holds = [&](std::size_t i) {
      return covered_[i].holds(static_cast<float>(u), static_cast<float>(v));
    };
    const bool overlapped =
        std::ranges::any_of(own, [&](std::size_t i) { return covered_[i].overlaps && holds(i); });
    if (!overlapped) return;

    for (const std::size_t i : own) {
      if (holds(i)) visit(partners_[i], ranks_[i]);
    }
  }

  std::uint64_t bytes() const;

 private:
  struct Slot {
    PlacedTriangleId id;
    std::uint32_t count = 0;  // 0: the slot is free
    std::uint32_t rank = 0;
    std::uint64_t first = 0;    // index in partners_
    std::size_t firstCell = 0;  // index in cells_
    std::size_t side = 1;       // the number of cells along each side of a square
  };
  static std::size_t cellOf(double weight, std::size_t side) {
    const auto most = static_cast<double>(side);
    return static_cast<std::size_t>(std::clamp(weight * most, 0.0, most - 1));
  }
  static std::size_t cellAt(double u, double v, std::size_t side) {
    return cellOf(v, side) * side + cellOf(u, side);
  }
  void fillCells(Slot& slot);
  std::size_t slotOf(PlacedTriangleId id) const;

  std::vector<std::uint64_t> any_;  // a bit a triangle
  std::vector<Slot> slots_;         // a hash table with open addressing, at most half full
  std::vector<PlacedTriangleId> partners_;
  std::vector<std::uint32_t> ranks_;  // a rank for each of partners_
  std::vector<CoveredPart> covered_;  // the part that each of partners_ covers of its triangle
  // A cell that some partner overlaps lists all partners that reach into it.
  struct Cell {
    std::size_t first = 0, count = 0;  // range of inCells_
  };
  std::vector<Cell> cells_;
  std::vector<std::size_t> inCells_;  // places in partners_
};

// Two placed triangles lie in one plane if the corners of each are no farther from the plane of the
// other than the sum of their error bounds (see Facet). They overlap if no edge of either, by its
// normal in the plane, leaves them less than that sum in common, and touch if none separates them
// by more. The search finds the triangles that overlap another one in their plane, and the ones
// that touch one of these in its plane; both are partners of all of them that they touch in their
// plane. Triangles without area, or too narrow to overlap any other, are left out. The result is
// the same for any number of threads.
//
// The work is bounded, and `complete` says if everything was searched. If instances overlap so
// deeply that they exceed the bound, each is searched by itself; if the triangles of the world do,
// none is found among them. Of instances of one object in exactly one place only the first four
// take part. Scenes of more triangles than kMostSearched, each instanced object counted once, are
// not searched.
inline constexpr std::uint64_t kMostSearched = 4'000'000;
// Where things move, scenes of more triangles, those of instances counted each time, are searched
// at 0 s alone.
inline constexpr std::uint64_t kMostSearchedInMotion = 20'000;
CoplanarTriangles findCoplanarTriangles(const Scene& scene, int threads, bool& complete);

}  // namespace whit
