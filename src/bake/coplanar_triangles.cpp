#include "bake/coplanar_triangles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include "bake/coplanar_pairs.h"
#include "bake/facet.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// At most this many coincident instances of one object are searched for overlaps; more would make
// the search quadratic.
constexpr int kInstancesInOnePlace = 4;

using Orders = std::vector<std::uint64_t>;  // of placed triangles, ascending, each once

void sortUnique(Orders& orders) {
  std::sort(orders.begin(), orders.end());
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
}

void addBoth(const std::vector<FacetPair>& pairs, Orders& orders) {
  for (const auto& [a, b] : pairs) orders.insert(orders.end(), {a, b});
}

// The finalizer of SplitMix64 (Steele, Lea, Flood 2014).
std::size_t hashOf(PlacedTriangleId id) {
  std::uint64_t x = orderOf(id);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<std::size_t>(x ^ (x >> 31));
}

}  // namespace

class CoplanarFinder {
 public:
  CoplanarFinder(const Scene& scene, int threads);

  bool complete() const { return complete_; }

  // Triangles that overlap others in their plane.
  Orders overlapping();
  // The triangles that overlap others, and the ones that touch one of these.
  CoplanarTriangles find(const Orders& overlapping);

 private:
  std::vector<TriangleGroup> everything() const;
  std::vector<FacetPair> pairs(const PairSearch& search, int threads) {
    return findPairs(search, scene_.triangles.size(), threads, complete_);
  }
  std::vector<FacetPair> pairsOf(const Orders& list, int threads,
                                 bool (*test)(const Facet&, const Facet&), bool& complete) const;
  void addWithinInstances(std::uint32_t geometry, Orders& all);
  void findCovered(CoplanarTriangles& found) const;

  const Scene& scene_;
  int threads_;
  std::vector<BoxTree> trees_;  // one a geometry
  FacetSpace world_;
  std::vector<bool> leftOut_;  // one an instance
  bool complete_ = true;
};

std::vector<BoxTree> treesOf(const Scene& scene, int threads) {
  const std::size_t count = scene.geometries.size();
  std::vector<BoxTree> trees(count);
  parallelFor(count > 1 ? threads : 1, count,
              [&](std::size_t i, int) { trees[i] = treeOf(scene, i, count > 1 ? 1 : threads); });
  return trees;
}

BoxTree treeOf(const FacetSpace& space, const Orders& list) {
  std::vector<Box> boxes;
  boxes.reserve(list.size());
  for (const std::uint64_t order : list) boxes.push_back(space.boxOf(placedTriangle(order)));
  return BoxTree(boxes, 1);
}

// The instances that have kInstancesInOnePlace earlier instances of the same object in the same
// place.
std::vector<bool> instancesInHeaps(const Scene& scene) {
  const auto placeOf = [](const InstanceRecord& i) {
    const auto& [x, y, z, p] = i.toWorld;
    return std::array{static_cast<double>(i.geometry),
                      x.x,
                      x.y,
                      x.z,
                      y.x,
                      y.y,
                      y.z,
                      z.x,
                      z.y,
                      z.z,
                      p.x,
                      p.y,
                      p.z};
  };
  std::map<std::array<double, 13>, int> count;
  std::vector<bool> leftOut;
  for (const InstanceRecord& i : scene.instances) {
    leftOut.push_back(++count[placeOf(i)] > kInstancesInOnePlace);
  }
  return leftOut;
}

CoplanarFinder::CoplanarFinder(const Scene& scene, int threads)
    : scene_(scene),
      threads_(threads),
      trees_(treesOf(scene, threads)),
      world_(scene),
      leftOut_(instancesInHeaps(scene)) {}

std::vector<TriangleGroup> CoplanarFinder::everything() const {
  std::vector<TriangleGroup> all;
  if (!trees_[0].empty()) {
    all.push_back({&trees_[0], kNoInstance, scene_.geometries[0].firstTriangle, true});
  }
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    const std::uint32_t g = scene_.instances[i].geometry;
    if (trees_[g].empty() || leftOut_[i]) continue;
    all.push_back({&trees_[g], i, scene_.geometries[g].firstTriangle});
  }
  return all;
}

// Pairs of the triangles of a list.
std::vector<FacetPair> CoplanarFinder::pairsOf(const Orders& list, int threads,
                                               bool (*test)(const Facet&, const Facet&),
                                               bool& complete) const {
  const BoxTree tree = treeOf(world_, list);
  const auto all = [](const TriangleGroup&, const TriangleGroup&) { return true; };
  return findPairs({world_, {{&tree, kNoInstance, 0, true, &list}}, all, test},
                   scene_.triangles.size(), threads, complete);
}

// Adds triangles that overlap others of the same instance. One search in the space of the geometry
// finds the candidates for all of its instances.
void CoplanarFinder::addWithinInstances(std::uint32_t geometry, Orders& all) {
  std::vector<std::uint32_t> instances;
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    const bool own = scene_.instances[i].geometry == geometry;
    if (own && !leftOut_[i]) instances.push_back(i);
  }
  if (trees_[geometry].empty() || instances.empty()) return;
  const FacetSpace object(scene_, trees_[geometry], geometry);
  const TriangleGroup group{&trees_[geometry], kNoInstance,
                            scene_.geometries[geometry].firstTriangle};
  const auto any = [](const TriangleGroup&, const TriangleGroup&) { return true; };
  Orders candidates;
  addBoth(pairs({object,
                 {group},
                 any,
                 facetsOverlap,
                 tooNarrowToOverlap(scene_, object, geometry, threads_)},
                threads_),
          candidates);
  if (candidates.empty()) return;
  sortUnique(candidates);
  std::vector<Orders> found(instances.size());
  std::vector<std::uint8_t> complete(instances.size());
  parallelFor(threads_, instances.size(), [&](std::size_t i, int) {
    Orders placed;
    for (const std::uint64_t order : candidates) {
      placed.push_back(orderOf({placedTriangle(order).triangle, instances[i]}));
    }
    bool whole = true;
    addBoth(pairsOf(placed, 1, facetsOverlap, whole), found[i]);
    sortUnique(found[i]);
    complete[i] = whole ? 1 : 0;
  });
  for (const Orders& some : found) all.insert(all.end(), some.begin(), some.end());
  if (std::find(complete.begin(), complete.end(), 0) != complete.end()) complete_ = false;
}

Orders CoplanarFinder::overlapping() {
  const auto anyPlaces = [](const TriangleGroup& a, const TriangleGroup& b) {
    return a.instance != b.instance || a.instance == kNoInstance;
  };
  Orders found;
  PairSearch search{world_, everything(), anyPlaces, facetsOverlap};
  search.leftOut = tooNarrowToOverlap(scene_, world_, 0, threads_);
  addBoth(pairs(search, threads_), found);
  for (std::uint32_t g = 1; g < scene_.geometries.size(); ++g) {
    addWithinInstances(g, found);
  }
  sortUnique(found);
  return found;
}

CoplanarTriangles CoplanarFinder::find(const Orders& overlapping) {
  if (overlapping.empty()) return {};
  const auto ofList = [](const TriangleGroup& a, const TriangleGroup& b) {
    return (a.list == nullptr) != (b.list == nullptr);
  };
  Orders all = overlapping;
  const BoxTree tree = treeOf(world_, overlapping);
  PairSearch search{world_, everything(), ofList, facetsTouch};
  search.groups.push_back({&tree, kNoInstance, 0, true, &overlapping});
  addBoth(pairs(search, threads_), all);
  sortUnique(all);
  CoplanarTriangles found(scene_.triangles.size(), pairsOf(all, threads_, facetsTouch, complete_));
  findCovered(found);
  return found;
}

void CoplanarFinder::findCovered(CoplanarTriangles& found) const {
  found.covered_.resize(found.partners_.size());
  std::vector<std::uint8_t> overlaps(found.partners_.size());
  parallelFor(threads_, found.slots_.size(), [&](std::size_t k, int) {
    CoplanarTriangles::Slot& slot = found.slots_[k];
    if (slot.count == 0) return;
    const Facet own = world_.facet(slot.id);
    for (std::size_t i = slot.first; i < slot.first + slot.count; ++i) {
      const Facet partner = world_.facet(found.partners_[i]);
      found.covered_[i] = coveredPart(own, partner);
      overlaps[i] = facetsOverlap(own, partner) ? 1 : 0;
    }
  });
  for (CoplanarTriangles::Slot& slot : found.slots_) {
    if (slot.count > 0) found.fillCells(slot, overlaps);
  }
}

// visit(cell) for those of side * side cells that the part may reach into.
template <typename Visitor>
void CoplanarTriangles::forEachCellOf(const CoveredPart& part, std::size_t side, Visitor&& visit) {
  const float size = 1 / static_cast<float>(side);
  for (std::size_t v = cellOf(part.v0, side); v <= cellOf(part.v1, side); ++v) {
    for (std::size_t u = cellOf(part.u0, side); u <= cellOf(part.u1, side); ++u) {
      if (part.meets(static_cast<float>(u) * size, static_cast<float>(v) * size, size)) {
        visit(v * side + u);
      }
    }
  }
}

// About as many cells as there are partners, fewer where these are so large that together they
// would reach into several times as many: those that lie one on the other share one cell.
void CoplanarTriangles::fillCells(Slot& slot, std::span<const std::uint8_t> overlaps) {
  constexpr double kMostSide = 64;
  constexpr std::size_t kReach = 8;  // cells that a partner reaches into, in the mean
  const std::span<const CoveredPart> own = std::span(covered_).subspan(slot.first, slot.count);
  const auto reached = [&](std::size_t side) {
    std::size_t sum = 0;
    for (const CoveredPart& e : own) {
      sum += (cellOf(e.u1, side) - cellOf(e.u0, side) + 1) *
             (cellOf(e.v1, side) - cellOf(e.v0, side) + 1);
    }
    return sum;
  };
  slot.side = static_cast<std::size_t>(
      std::clamp(2 * std::sqrt(static_cast<double>(slot.count)), 4.0, kMostSide));
  while (slot.side > 1 && reached(slot.side) > kReach * slot.count) slot.side /= 2;
  slot.firstCell = cells_.size();
  std::vector<std::vector<std::size_t>> overlapping(slot.side * slot.side), touching = overlapping;
  for (std::size_t i = slot.first; i < slot.first + slot.count; ++i) {
    auto& lists = overlaps[i] != 0 ? overlapping : touching;
    forEachCellOf(covered_[i], slot.side, [&](std::size_t cell) { lists[cell].push_back(i); });
  }
  for (std::size_t k = 0; k < overlapping.size(); ++k) {
    Cell cell{inCells_.size()};
    if (!overlapping[k].empty()) {
      inCells_.insert(inCells_.end(), overlapping[k].begin(), overlapping[k].end());
      inCells_.insert(inCells_.end(), touching[k].begin(), touching[k].end());
      cell.overlapping = static_cast<std::uint32_t>(overlapping[k].size());
      cell.count = static_cast<std::uint32_t>(inCells_.size() - cell.first);
    }
    cells_.push_back(cell);
  }
}

CoplanarTriangles::CoplanarTriangles(std::uint64_t triangles,
                                     std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs) {
  if (pairs.empty()) return;
  const std::size_t half = pairs.size();
  pairs.reserve(2 * half);
  for (std::size_t i = 0; i < half; ++i) pairs.emplace_back(pairs[i].second, pairs[i].first);
  std::sort(pairs.begin(), pairs.end());
  std::size_t owners = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    owners += i == 0 || pairs[i].first != pairs[i - 1].first;
  }
  any_.resize(triangles / 64 + 1);
  slots_.resize(std::bit_ceil(2 * owners));
  partners_.reserve(pairs.size());
  for (const auto& [order, partner] : pairs) {
    const PlacedTriangleId id = placedTriangle(order);
    any_[id.triangle / 64] |= std::uint64_t{1} << id.triangle % 64;
    Slot& slot = slots_[slotOf(id)];
    if (slot.count == 0) slot = {id, 0, 0, partners_.size()};
    ++slot.count;
    partners_.push_back(placedTriangle(partner));
  }
  ranks_.resize(partners_.size());
}

void CoplanarTriangles::rankBy(const Scene& scene, const SceneOrder& order) {
  std::vector<std::pair<WrittenPlace, std::size_t>> all;  // of slots
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    if (slots_[k].count > 0) all.emplace_back(order.placeOf(scene, slots_[k].id), k);
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    slots_[all[i].second].rank = static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = 0; i < partners_.size(); ++i) ranks_[i] = rankOf(partners_[i]);
}

// The slot of the triangle, or the free slot where it would be stored.
std::size_t CoplanarTriangles::slotOf(PlacedTriangleId id) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hashOf(id) & mask;
  while (slots_[i].count != 0 && slots_[i].id != id) i = (i + 1) & mask;
  return i;
}

std::span<const PlacedTriangleId> CoplanarTriangles::partnersOf(PlacedTriangleId id) const {
  if (empty()) return {};
  const Slot& slot = slots_[slotOf(id)];
  return std::span(partners_).subspan(slot.first, slot.count);
}

std::uint64_t CoplanarTriangles::bytes() const {
  if (empty()) return 0;
  return any_.size() * sizeof(any_[0]) + slots_.size() * sizeof(Slot) +
         partners_.size() * (sizeof(PlacedTriangleId) + sizeof(ranks_[0]) + sizeof(CoveredPart)) +
         cells_.size() * sizeof(Cell) + inCells_.size() * sizeof(std::size_t);
}

CoplanarTriangles findCoplanarTriangles(const Scene& scene, int threads, bool& complete) {
  complete = scene.firstSphere <= kMostSearched;
  if (!complete) return {};
  CoplanarFinder finder(scene, threads);
  CoplanarTriangles found = finder.find(finder.overlapping());
  complete = finder.complete();
  return found;
}

WrittenPlace SceneOrder::placeOf(const Scene& scene, PlacedTriangleId id) const {
  if (scene.isSphere(id.triangle)) {
    WrittenPlace place = spheres[id.triangle - scene.firstSphere];
    if (id.instance == kNoInstance) return place;
    place.instance = scene.instances[id.instance].written;
    place.rank += instances[place.instance];
    return place;
  }
  const std::uint32_t number = triangles[id.triangle];
  const auto meshOf = [&](std::uint32_t geometry) {
    const std::vector<PlacedMesh>& all = meshes[geometry];
    const auto startsBehind = [](std::uint32_t n, const PlacedMesh& m) {
      return n < m.firstTriangle;
    };
    return *(std::upper_bound(all.begin(), all.end(), number, startsBehind) - 1);
  };
  if (id.instance == kNoInstance) {
    const PlacedMesh mesh = meshOf(0);
    return {mesh.rank, mesh.instance, number};
  }
  const InstanceRecord& instance = scene.instances[id.instance];
  return {instances[instance.written] + meshOf(instance.geometry).rank, instance.written, number};
}

}  // namespace whit
