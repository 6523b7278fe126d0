// The search for coplanar triangles. A tree of bounding boxes holds all placed triangles, and each
// eight neighbors in it are compared with the triangles whose boxes meet theirs.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <map>
#include <span>
#include <utility>

#include "bake/facet.h"
#include "core/box.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// At most this many coincident instances of one object are searched for overlaps; more would make
// the search quadratic.
constexpr int kInstancesInOnePlace = 4;

// Limits of the work, in comparisons of two boxes. An ordinary mesh takes less than a hundred for
// each triangle.
constexpr std::int64_t kWork = std::int64_t{1} << 28, kWorkPerTriangle = 256;
constexpr std::int64_t kWorkOfFacets = 4;  // of comparing two facets
constexpr std::int64_t kWorkOfPair = 128;  // of a pair that is found, because it takes memory

// Trees of more triangles are built by several threads.
constexpr std::size_t kSharedTriangles = 8192;

using Orders = std::vector<std::uint64_t>;  // orderOf() of triangles
using Pairs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

void addBoth(const Pairs& pairs, Orders& orders) {
  for (const auto& [a, b] : pairs) orders.insert(orders.end(), {a, b});
  std::sort(orders.begin(), orders.end());
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
}

// It has no branches, because processors could not predict them.
bool meet(const Box& a, const Box& b) {
  const unsigned x = unsigned{a.lower.x <= b.upper.x} & unsigned{b.lower.x <= a.upper.x};
  const unsigned y = unsigned{a.lower.y <= b.upper.y} & unsigned{b.lower.y <= a.upper.y};
  const unsigned z = unsigned{a.lower.z <= b.upper.z} & unsigned{b.lower.z <= a.upper.z};
  return (x & y & z) != 0;
}

// A box that holds everything that can touch the triangle.
Box boxOf(const Facet& facet) {
  // 1 would do but for the rounding of the box to float and for corners of two triangles that no
  // edge separates, though they are farther apart.
  constexpr double kGrowth = 2;
  const auto& [a, b, c] = facet.corners;
  const Vec3d growth(kGrowth * facet.error);
  return {Vec3f(min(min(a, b), c) - growth), Vec3f(max(max(a, b), c) + growth)};
}

struct BoxedTriangle {
  std::uint64_t order = 0;  // orderOf()
  Box box;
  Vec3f center() const { return box.lower * 0.5f + box.upper * 0.5f; }
};

constexpr std::size_t kChildren = 8;

// Halves the triangles across their longest extent, again and again, so that neighbors follow each
// other and all nodes but the last of a level are full.
void sortInSpace(std::span<BoxedTriangle> all, int threads) {
  std::size_t full = 1;  // the triangles of the largest full node that is smaller than all
  while (full * kChildren < all.size()) full *= kChildren;
  if (full == 1) return;
  Box box;
  for (const BoxedTriangle& triangle : all) box.add(triangle.center());
  const Vec3f size = box.upper - box.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = ((all.size() + full - 1) / full + 1) / 2 * full;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(middle), all.end(),
                   [axis](const BoxedTriangle& a, const BoxedTriangle& b) {
                     return a.box.lower[axis] + a.box.upper[axis] <
                            b.box.lower[axis] + b.box.upper[axis];
                   });
  const auto sortHalf = [&](std::size_t half, int) {
    sortInSpace(half == 0 ? all.first(middle) : all.subspan(middle), threads / 2);
  };
  if (threads > 1) return parallelFor(threads, 2, sortHalf);
  sortHalf(0, 0);
  sortHalf(1, 0);
}

// Eight neighbors share a box of the next level, up to at most eight boxes that hold all. Level 0
// are the triangles.
struct BoxTree {
  BoxTree(std::vector<BoxedTriangle> all, int threads) {
    sortInSpace(all, all.size() > kSharedTriangles ? threads : 1);
    orders.reserve(all.size());
    levels.emplace_back().reserve(all.size());
    for (const BoxedTriangle& triangle : all) {
      orders.push_back(triangle.order);
      levels[0].push_back(triangle.box);
    }
    while (levels.back().size() > kChildren) {
      const std::vector<Box>& below = levels.back();
      std::vector<Box> boxes((below.size() + kChildren - 1) / kChildren);
      for (std::size_t i = 0; i < below.size(); ++i) {
        boxes[i / kChildren].add(below[i].lower);
        boxes[i / kChildren].add(below[i].upper);
      }
      levels.push_back(std::move(boxes));
    }
  }
  std::size_t blocks() const { return (orders.size() + kChildren - 1) / kChildren; }

  Orders orders;
  std::vector<std::vector<Box>> levels;
};

// The triangles that can overlap others.
BoxTree treeOfPlaced(const Scene& scene, bool withInstances, int threads) {
  std::vector<BoxedTriangle> all;
  const auto add = [&](const Geometry& geometry, std::uint32_t instance) {
    for (std::uint32_t i = 0; i < geometry.index.size(); ++i) {
      all.push_back({orderOf({geometry.firstTriangle + i, instance}), {}});
    }
  };
  add(scene.geometries[0], kNoInstance);
  std::map<std::pair<std::uint32_t, std::array<double, 12>>, int> coincident;
  for (std::uint32_t i = 0; withInstances && i < scene.instances.size(); ++i) {
    const InstanceRecord& instance = scene.instances[i];
    const auto map = std::bit_cast<std::array<double, 12>>(instance.toWorld);
    if (++coincident[{instance.geometry, map}] > kInstancesInOnePlace) continue;
    add(scene.geometries[instance.geometry], i);
  }
  constexpr std::size_t kChunk = 4096;
  parallelFor(threads, (all.size() + kChunk - 1) / kChunk, [&](std::size_t chunk, int) {
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, all.size()); ++i) {
      const Facet facet = facetOf(scene, placedTriangle(all[i].order));
      if (!isTooNarrowToOverlap(facet)) all[i].box = boxOf(facet);
    }
  });
  std::erase_if(all, [](const BoxedTriangle& triangle) { return triangle.box.empty(); });
  return {std::move(all), threads};
}

using FacetTest = bool (*)(const Facet& a, const Facet& b);

// Finds the pairs of a triangle of one tree and another one of a second tree that pass the test. If
// both are the same tree, each pair is found once.
class PairFinder {
 public:
  PairFinder(const Scene& scene, const BoxTree& first, const BoxTree& second, FacetTest test)
      : scene_(scene), first_(first), second_(second), test_(test) {}

  // Searches with eight triangles of the first tree. Takes its share of the work from `work` and
  // stops when nothing is left.
  void search(std::size_t block, std::atomic<std::int64_t>& work) {
    const std::int64_t before = left_ = work;
    begin_ = block * kChildren;
    end_ = std::min(begin_ + kChildren, first_.orders.size());
    box_ = Box();
    for (std::size_t i = begin_; i < end_; ++i) {
      facets_[i - begin_] = facetOf(scene_, placedTriangle(first_.orders[i]));
      box_.add(first_.levels[0][i].lower);
      box_.add(first_.levels[0][i].upper);
    }
    descend(second_.levels.size() - 1, 0);
    work -= before - left_;
  }
  const Pairs& found() const { return found_; }

 private:
  void descend(std::size_t level, std::size_t number) {
    const std::vector<Box>& boxes = second_.levels[level];
    const std::size_t end = std::min(number + kChildren, boxes.size());
    left_ -= static_cast<std::int64_t>(kChildren);
    for (; number < end && left_ > 0; ++number) {
      if (!meet(boxes[number], box_)) continue;
      if (level == 0) {
        compare(number);
      } else {
        descend(level - 1, number * kChildren);
      }
    }
  }

  void compare(std::size_t number) {
    const std::uint64_t other = second_.orders[number];
    const Facet facet = facetOf(scene_, placedTriangle(other));
    left_ -= static_cast<std::int64_t>(kChildren);
    for (std::size_t i = begin_; i < end_; ++i) {
      const std::uint64_t own = first_.orders[i];
      if (own == other || (own > other && &first_ == &second_)) continue;
      if (!meet(first_.levels[0][i], second_.levels[0][number])) continue;
      left_ -= kWorkOfFacets;
      if (!test_(facets_[i - begin_], facet)) continue;
      left_ -= kWorkOfPair;
      found_.emplace_back(own, other);
    }
  }

  const Scene& scene_;
  const BoxTree &first_, &second_;
  FacetTest test_;
  std::int64_t left_ = 0;  // work
  std::size_t begin_ = 0, end_ = 0;
  std::array<Facet, kChildren> facets_;
  Box box_;
  Pairs found_;
};

// Sets `complete` to false and returns nothing if the search takes too much work.
Pairs findPairs(const Scene& scene, const BoxTree& first, const BoxTree& second, FacetTest test,
                int threads, bool& complete) {
  std::atomic<std::int64_t> work =
      kWork + kWorkPerTriangle * static_cast<std::int64_t>(scene.instancedTriangles);
  std::vector<PairFinder> finders(static_cast<std::size_t>(threads),
                                  PairFinder(scene, first, second, test));
  parallelFor(threads, first.blocks(), [&](std::size_t block, int worker) {
    finders[static_cast<std::size_t>(worker)].search(block, work);
  });
  if (work <= 0) {
    complete = false;
    return {};
  }
  Pairs pairs;
  for (const PairFinder& finder : finders) {
    pairs.insert(pairs.end(), finder.found().begin(), finder.found().end());
  }
  return pairs;
}

}  // namespace

CoplanarTriangles findCoplanarTriangles(const Scene& scene, int threads, bool& complete) {
  complete = scene.firstSphere <= kMostSearched;
  if (!complete) return {};
  const bool withInstances = scene.instancedTriangles <= kMostSearched;
  complete = withInstances;
  BoxTree placed = treeOfPlaced(scene, withInstances, threads);
  Pairs pairs = findPairs(scene, placed, placed, facetsOverlap, threads, complete);
  if (withInstances && !complete && !scene.instances.empty()) {
    placed = treeOfPlaced(scene, false, threads);
    pairs = findPairs(scene, placed, placed, facetsOverlap, threads, complete);
  }
  Orders all;
  addBoth(pairs, all);
  if (all.empty()) return {};
  const auto treeOfAll = [&] {
    std::vector<BoxedTriangle> boxed;
    for (const std::uint64_t order : all) {
      boxed.push_back({order, boxOf(facetOf(scene, placedTriangle(order)))});
    }
    return BoxTree(std::move(boxed), 1);
  };
  // Triangles that touch one that overlaps another are added to those that overlap.
  addBoth(findPairs(scene, treeOfAll(), placed, facetsTouch, threads, complete), all);
  const BoxTree tree = treeOfAll();
  return {scene, findPairs(scene, tree, tree, facetsTouch, threads, complete), threads};
}

}  // namespace whit
