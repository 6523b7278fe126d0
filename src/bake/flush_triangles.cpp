#include "bake/flush_triangles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include "bake/facet.h"
#include "bake/facet_pairs.h"
#include "bake/facet_space.h"
#include "bake/scene_order.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// Of instances of one object in exactly one place so many take part.
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

class FlushFinder {
 public:
  enum class Among { all, still, moving };

  FlushFinder(const Scene& scene, BlocksOfGeometries known, int threads);

  const BlocksOfGeometries& blocks() const { return blocks_; }

  // Triangles that overlap others; of those that move the others may stand still.
  Orders overlapping(Among which) const;
  // With what touches the triangles that overlap others, itself among those.
  FlushTriangles find(Orders flush, Among touching) const;

 private:
  bool isAmong(Among which, std::uint32_t instance) const {
    if (which == Among::all) return true;
    return world_.moves(instance) == (which == Among::moving);
  }
  std::vector<BoxedBlock> everything(Among which) const;
  std::vector<BoxedBlock> boxesOf(const Orders& orders) const;
  std::vector<FacetPair> pairs(std::vector<BoxedBlock> of, PairsOf which, FacetTest test) const {
    return findPairs(world_, std::move(of), which, test, scene_.triangles.size(), threads_);
  }
  void addWithinInstances(std::uint32_t geometry, Among which, Orders& all) const;
  void findCovered(FlushTriangles& found) const;

  const Scene& scene_;
  int threads_;
  BlocksOfGeometries blocks_;  // one a geometry
  FacetSpace world_;
  std::vector<bool> leftOut_;  // one an instance
};

// Those that are known already stay.
BlocksOfGeometries blocksOf(const Scene& scene, BlocksOfGeometries blocks, int threads) {
  blocks.resize(scene.geometries.size());
  for (std::size_t g = 0; g < blocks.size(); ++g) {
    if (blocks[g]) continue;
    blocks[g] = std::make_shared<const TriangleBlocks>(scene, scene.geometries[g], threads);
  }
  return blocks;
}

// Those of one object that have as many before them in their place as take part.
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

FlushFinder::FlushFinder(const Scene& scene, BlocksOfGeometries known, int threads)
    : scene_(scene),
      threads_(threads),
      blocks_(blocksOf(scene, std::move(known), threads)),
      world_(scene, blocks_),
      leftOut_(instancesInHeaps(scene)) {}

std::vector<BoxedBlock> FlushFinder::everything(Among which) const {
  std::vector<BoxedBlock> all = world_.everything();
  std::erase_if(all, [&](const BoxedBlock& b) {
    if (which == Among::still && !isAmong(which, b.instance)) return true;
    return b.instance != kNoInstance && leftOut_[b.instance];
  });
  return all;
}

std::vector<BoxedBlock> FlushFinder::boxesOf(const Orders& orders) const {
  std::vector<BoxedBlock> boxes;
  boxes.reserve(orders.size());
  for (const std::uint64_t order : orders) boxes.push_back(world_.triangle(placedTriangle(order)));
  return boxes;
}

// Of triangles that one instance carries. What may overlap is looked for once for all instances.
void FlushFinder::addWithinInstances(std::uint32_t geometry, Among which, Orders& all) const {
  std::vector<std::uint32_t> instances;
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    const bool own = scene_.instances[i].geometry == geometry;
    if (own && !leftOut_[i] && isAmong(which, i)) instances.push_back(i);
  }
  if (blocks_[geometry]->top() == 0 || instances.empty()) return;
  const FacetSpace object = FacetSpace::ofObject(scene_, blocks_, geometry);
  Orders candidates;
  addBoth(findPairs(object, object.everything(), PairsOf::differentPlaces, facetsOverlap,
                    scene_.triangles.size(), threads_),
          candidates);
  if (candidates.empty()) return;
  sortUnique(candidates);
  std::vector<Orders> found(instances.size());
  parallelFor(threads_, instances.size(), [&](std::size_t i, int) {
    std::vector<BoxedBlock> boxes;
    for (const std::uint64_t order : candidates) {
      boxes.push_back(world_.triangle({placedTriangle(order).triangle, instances[i]}));
    }
    addBoth(findPairs(world_, std::move(boxes), PairsOf::all, facetsOverlap,
                      scene_.triangles.size(), 1),
            found[i]);
    sortUnique(found[i]);
  });
  for (const Orders& some : found) all.insert(all.end(), some.begin(), some.end());
}

Orders FlushFinder::overlapping(Among which) const {
  Orders found;
  const PairsOf places = which == Among::moving ? PairsOf::withMoving : PairsOf::differentPlaces;
  addBoth(pairs(everything(which), places, facetsOverlap), found);
  for (std::uint32_t g = 1; g < scene_.geometries.size(); ++g) {
    addWithinInstances(g, which, found);
  }
  sortUnique(found);
  return found;
}

FlushTriangles FlushFinder::find(Orders flush, Among touching) const {
  if (flush.empty()) return {};
  std::vector<BoxedBlock> blocks = boxesOf(flush);
  for (BoxedBlock& b : blocks) b.asked = true;
  const std::vector<BoxedBlock> all = everything(touching);
  blocks.insert(blocks.end(), all.begin(), all.end());
  addBoth(pairs(std::move(blocks), PairsOf::asked, facetsTouch), flush);
  sortUnique(flush);
  FlushTriangles found(scene_.triangles.size(), pairs(boxesOf(flush), PairsOf::all, facetsTouch));
  findCovered(found);
  return found;
}

void FlushFinder::findCovered(FlushTriangles& found) const {
  found.covered_.resize(found.partners_.size());
  std::vector<std::uint8_t> overlaps(found.partners_.size());
  parallelFor(threads_, found.slots_.size(), [&](std::size_t k, int) {
    FlushTriangles::Slot& slot = found.slots_[k];
    if (slot.count == 0) return;
    const Facet own = world_.facet(slot.id);
    for (std::size_t i = slot.first; i < slot.first + slot.count; ++i) {
      const Facet partner = world_.facet(found.partners_[i]);
      found.covered_[i] = coveredPart(own, partner);
      overlaps[i] = facetsOverlap(own, partner) ? 1 : 0;
    }
  });
  for (FlushTriangles::Slot& slot : found.slots_) {
    if (slot.count > 0) found.fillCells(slot, overlaps);
  }
}

// visit(cell) for those of side * side cells that the part may reach into.
template <typename Visitor>
void FlushTriangles::forEachCellOf(const CoveredPart& part, std::size_t side, Visitor&& visit) {
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
void FlushTriangles::fillCells(Slot& slot, std::span<const std::uint8_t> overlaps) {
  constexpr double kMostSide = 64;
  constexpr std::size_t kReach = 8;           // cells that a partner reaches into, in the mean
  constexpr std::uint32_t kFewPartners = 32;  // a fine mask is not worth its start
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
  slot.maskSide = slot.count < kFewPartners ? 16 : 64;
  slot.firstWord = contested_.size();
  contested_.resize(slot.firstWord + slot.maskSide * slot.maskSide / 64);
  std::vector<std::vector<std::size_t>> overlapping(slot.side * slot.side), touching = overlapping;
  for (std::size_t i = slot.first; i < slot.first + slot.count; ++i) {
    auto& lists = overlaps[i] != 0 ? overlapping : touching;
    forEachCellOf(covered_[i], slot.side, [&](std::size_t cell) { lists[cell].push_back(i); });
    if (overlaps[i] == 0) continue;
    forEachCellOf(covered_[i], slot.maskSide, [&](std::size_t cell) {
      contested_[slot.firstWord + cell / 64] |= std::uint64_t{1} << cell % 64;
    });
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

FlushTriangles::FlushTriangles(std::uint64_t triangles,
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

void FlushTriangles::rankBy(const Scene& scene, const SceneOrder& order) {
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

// That of the triangle, or the free one where it would be.
std::size_t FlushTriangles::slotOf(PlacedTriangleId id) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hashOf(id) & mask;
  while (slots_[i].count != 0 && slots_[i].id != id) i = (i + 1) & mask;
  return i;
}

std::span<const PlacedTriangleId> FlushTriangles::partnersOf(PlacedTriangleId id) const {
  if (empty()) return {};
  const Slot& slot = slots_[slotOf(id)];
  return std::span(partners_).subspan(slot.first, slot.count);
}

std::uint64_t FlushTriangles::bytes() const {
  if (empty()) return 0;
  return any_.size() * sizeof(any_[0]) + slots_.size() * sizeof(Slot) +
         partners_.size() * (sizeof(PlacedTriangleId) + sizeof(ranks_[0]) + sizeof(CoveredPart)) +
         cells_.size() * sizeof(Cell) + inCells_.size() * sizeof(std::size_t) +
         contested_.size() * sizeof(contested_[0]);
}

FlushTriangles findFlushTriangles(const Scene& scene, int threads) {
  if (scene.firstSphere > kMostSearched) return {};
  const FlushFinder finder(scene, {}, threads);
  return finder.find(finder.overlapping(FlushFinder::Among::all), FlushFinder::Among::all);
}

void updateFlushTriangles(Scene& scene, StillFlush& still, const SceneOrder& order, int threads) {
  using Among = FlushFinder::Among;
  if (scene.firstSphere > kMostSearched) return;
  BlocksOfGeometries rigid = still.blocks;
  for (const BentVertices& bent : scene.motion.bent) {
    if (bent.geometry < rigid.size()) rigid[bent.geometry].reset();
  }
  const FlushFinder finder(scene, std::move(rigid), threads);
  std::vector<std::uint32_t> instances;
  for (const InstanceRecord& i : scene.instances) instances.push_back(i.written);
  if (!still.known || still.instances != instances) {
    still = {true, std::move(instances), finder.overlapping(Among::still), false, finder.blocks()};
  }
  Orders moving = finder.overlapping(Among::moving);
  if (moving.empty() && still.all) return;
  still.all = moving.empty();
  moving.insert(moving.end(), still.triangles.begin(), still.triangles.end());
  sortUnique(moving);
  scene.flush = finder.find(std::move(moving), still.all ? Among::still : Among::all);
  scene.flush.rankBy(scene, order);
}

}  // namespace whit
