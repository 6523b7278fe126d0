#include "bake/coplanar_triangles.h"

#include <bit>
#include <cmath>

#include "bake/facet.h"
#include "core/index.h"
#include "core/worker_pool.h"

namespace whit {

// Divides the square of weights into about four cells for each partner. There are fewer cells where
// partners are so large that together they would reach into many times as many; coincident partners
// share one cell.
void CoplanarTriangles::fillCells(Slot& slot) {
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
  // The grid is coarsened until a partner reaches into few cells on average.
  while (slot.side > 1 && reached(slot.side) > kReach * slot.count) slot.side /= 2;

  slot.firstCell = cells_.size();
  const float size = 1 / static_cast<float>(slot.side);

  // Each cell lists the partners that may cover a point of it.
  std::vector<std::vector<std::size_t>> lists(slot.side * slot.side);
  for (std::size_t i = slot.first; i < slot.first + slot.count; ++i) {
    const CoveredPart& part = covered_[i];
    for (std::size_t v = cellOf(part.v0, slot.side); v <= cellOf(part.v1, slot.side); ++v) {
      for (std::size_t u = cellOf(part.u0, slot.side); u <= cellOf(part.u1, slot.side); ++u) {
        if (part.meets(static_cast<float>(u) * size, static_cast<float>(v) * size, size)) {
          lists[v * slot.side + u].push_back(i);
        }
      }
    }
  }

  // Partners that merely touch matter only where another one overlaps, so other cells stay empty.
  for (std::vector<std::size_t>& list : lists) {
    const bool overlapped =
        std::ranges::any_of(list, [this](std::size_t i) { return covered_[i].overlaps; });
    if (!overlapped) list.clear();
    cells_.push_back({inCells_.size(), list.size()});
    inCells_.insert(inCells_.end(), list.begin(), list.end());
  }
}

CoplanarTriangles::CoplanarTriangles(const Scene& scene,
                                     std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs,
                                     int threads) {
  if (pairs.empty()) return;

  // Pairs are stored in both directions, so that sorting groups the partners of each triangle.
  const std::size_t half = pairs.size();
  pairs.reserve(2 * half);
  for (const auto i : indices(half)) pairs.emplace_back(pairs[i].second, pairs[i].first);
  std::ranges::sort(pairs);

  std::size_t owners = 0;
  for (const auto i : indices(pairs)) {
    owners += i == 0 || pairs[i].first != pairs[i - 1].first;
  }

  // The hash table is at most half full, which keeps its probe sequences short.
  any_.resize(scene.triangles.size() / 64 + 1);
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

  // The covered parts are independent of each other, because every slot has its own range of them.
  ranks_.resize(partners_.size());
  covered_.resize(partners_.size());
  parallelFor(threads, slots_.size(), [&](std::size_t k, int) {
    const Slot& slot = slots_[k];
    if (slot.count == 0) return;

    const Facet own = facetOf(scene, slot.id);
    for (std::size_t i = slot.first; i < slot.first + slot.count; ++i) {
      covered_[i] = coveredPart(own, facetOf(scene, partners_[i]));
    }
  });

  for (Slot& slot : slots_) {
    if (slot.count > 0) fillCells(slot);
  }
}

void CoplanarTriangles::rankBy(const Scene& scene, const SceneOrder& order) {
  std::vector<std::pair<WrittenPlace, std::size_t>> all;  // pairs of a place and a slot
  for (const auto k : indices(slots_)) {
    if (slots_[k].count > 0) all.emplace_back(order.placeOf(scene, slots_[k].id), k);
  }
  std::ranges::sort(all);
  for (const auto i : indices(all)) {
    slots_[all[i].second].rank = static_cast<std::uint32_t>(i);
  }
  for (const auto i : indices(partners_)) ranks_[i] = rankOf(partners_[i]);
}

// The slot of the triangle, or the free slot where it would be stored.
std::size_t CoplanarTriangles::slotOf(PlacedTriangleId id) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = mixed64(orderOf(id)) & mask;
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

WrittenPlace SceneOrder::placeOf(const Scene& scene, PlacedTriangleId id) const {
  if (scene.isSphere(id.triangle)) {
    WrittenPlace place = spheres[id.triangle - scene.firstSphere];
    if (id.instance == kNoInstance) return place;

    // A place is stored without the instance, so that all instances can share it.
    place.instance = scene.instances[id.instance].written;
    place.rank += instances[place.instance];
    return place;
  }

  const std::uint32_t number = triangles[id.triangle];
  // The mesh of a triangle is the last one whose first triangle has no greater number.
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
