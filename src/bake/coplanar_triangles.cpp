#include "bake/coplanar_triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "bake/facet.h"
#include "core/worker_pool.h"

namespace whit {

// About as many cells as there are partners, fewer where these are so large that together they
// would reach into several times as many: those that lie one on the other share one cell.
void CoplanarTriangles::fillCells(Owner& owner) {
  constexpr double kMostSide = 64;
  constexpr std::size_t kReach = 8;  // cells that a partner reaches into, in the mean
  const std::span<const CoveredPart> own = std::span(covered_).subspan(owner.first, owner.count);
  const auto reached = [&](std::size_t side) {
    std::size_t sum = 0;
    for (const CoveredPart& e : own) {
      sum += (cellOf(e.u1, side) - cellOf(e.u0, side) + 1) *
             (cellOf(e.v1, side) - cellOf(e.v0, side) + 1);
    }
    return sum;
  };
  owner.side = static_cast<std::size_t>(
      std::clamp(2 * std::sqrt(static_cast<double>(owner.count)), 4.0, kMostSide));
  while (owner.side > 1 && reached(owner.side) > kReach * owner.count) owner.side /= 2;
  owner.firstCell = cells_.size();
  const float size = 1 / static_cast<float>(owner.side);
  std::vector<std::vector<std::size_t>> lists(owner.side * owner.side);
  for (std::size_t i = owner.first; i < owner.first + owner.count; ++i) {
    const CoveredPart& part = covered_[i];
    for (std::size_t v = cellOf(part.v0, owner.side); v <= cellOf(part.v1, owner.side); ++v) {
      for (std::size_t u = cellOf(part.u0, owner.side); u <= cellOf(part.u1, owner.side); ++u) {
        if (part.meets(static_cast<float>(u) * size, static_cast<float>(v) * size, size)) {
          lists[v * owner.side + u].push_back(i);
        }
      }
    }
  }
  for (std::vector<std::size_t>& list : lists) {
    const bool overlapped = std::any_of(list.begin(), list.end(),
                                        [this](std::size_t i) { return covered_[i].overlaps; });
    if (!overlapped) list.clear();
    cells_.push_back({inCells_.size(), list.size()});
    inCells_.insert(inCells_.end(), list.begin(), list.end());
  }
}

CoplanarTriangles::CoplanarTriangles(const Scene& scene,
                                     std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs,
                                     int threads) {
  if (pairs.empty()) return;
  const std::size_t half = pairs.size();
  pairs.reserve(2 * half);
  for (std::size_t i = 0; i < half; ++i) pairs.emplace_back(pairs[i].second, pairs[i].first);
  const auto keyOf = [](const auto& pair) {
    const PlacedTriangleId id = placedTriangle(pair.first);
    return std::tuple(id.triangle, id.instance, pair.second);
  };
  std::sort(pairs.begin(), pairs.end(),
            [&](const auto& a, const auto& b) { return keyOf(a) < keyOf(b); });
  firstOwner_.resize(scene.triangles.size() + 1);
  partners_.reserve(pairs.size());
  for (const auto& [order, partner] : pairs) {
    const PlacedTriangleId id = placedTriangle(order);
    if (owners_.empty() || owners_.back().id != id) {
      owners_.push_back({id, 0, 0, partners_.size()});
      ++firstOwner_[id.triangle + 1];
    }
    ++owners_.back().count;
    partners_.push_back(placedTriangle(partner));
  }
  std::partial_sum(firstOwner_.begin(), firstOwner_.end(), firstOwner_.begin());
  ranks_.resize(partners_.size());
  covered_.resize(partners_.size());
  parallelFor(threads, owners_.size(), [&](std::size_t k, int) {
    const Owner& owner = owners_[k];
    const Facet own = facetOf(scene, owner.id);
    for (std::size_t i = owner.first; i < owner.first + owner.count; ++i) {
      covered_[i] = coveredPart(own, facetOf(scene, partners_[i]));
    }
  });
  for (Owner& owner : owners_) fillCells(owner);
}

void CoplanarTriangles::rankBy(const Scene& scene, const SceneOrder& order) {
  std::vector<std::pair<WrittenPlace, Owner*>> all;
  for (Owner& owner : owners_) all.emplace_back(order.placeOf(scene, owner.id), &owner);
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].second->rank = static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = 0; i < partners_.size(); ++i) ranks_[i] = rankOf(partners_[i]);
}

std::span<const PlacedTriangleId> CoplanarTriangles::partnersOf(PlacedTriangleId id) const {
  const Owner* owner = empty() ? nullptr : ownerOf(id);
  if (!owner) return {};
  return std::span(partners_).subspan(owner->first, owner->count);
}

std::uint64_t CoplanarTriangles::bytes() const {
  return firstOwner_.size() * sizeof(firstOwner_[0]) + owners_.size() * sizeof(Owner) +
         partners_.size() * (sizeof(PlacedTriangleId) + sizeof(ranks_[0]) + sizeof(CoveredPart)) +
         cells_.size() * sizeof(Cell) + inCells_.size() * sizeof(std::size_t);
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
