#include "bake/coplanar_pairs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "core/worker_pool.h"

namespace whit {

namespace {

// Boxes are grown by this multiple of a facet's error. 1 would do but for the rounding of the box
// to float and for corners of two triangles that no edge separates, though they are farther apart.
constexpr double kGrowth = 2;

// Upper bound on the error of a facet; all coordinates are smaller, and floats reach much farther.
constexpr double kLargestError = 8.0 * kLargestCoordinate;

// Pairs of nodes with fewer triangles than this become tasks for threads.
constexpr std::uint64_t kTaskTriangles = 8192;

// Limits of the work, in comparisons of two boxes. An ordinary mesh takes less than a hundred for
// each triangle. Many instances that overlap are given less: they seldom have coplanar faces.
constexpr std::int64_t kWork = std::int64_t{1} << 28, kWorkPerTriangle = 256;
constexpr std::int64_t kWorkOfInstances = std::int64_t{1} << 24;
constexpr std::size_t kManyGroups = 64;
constexpr std::size_t kWorkOfNodes = 16;    // of taking two nodes apart
constexpr std::int64_t kWorkOfFacets = 4;   // of comparing two facets
constexpr std::int64_t kWorkOfPair = 128;   // of a pair that is found; it takes memory
constexpr std::int64_t kWorkOfTask = 1024;  // likewise

constexpr std::size_t kKnownFacets = 512;
constexpr std::uint32_t kNoTriangle = 0xffffffffu;

Box grown(const Vec3d& lower, const Vec3d& upper, double error) {
  const double way = kGrowth * error;
  Box box;
  box.lower = Vec3f(lower - Vec3d(way));
  box.upper = Vec3f(upper + Vec3d(way));
  return box;
}

// It has no branches, which processors could not foresee.
bool meet(const Box& a, const Box& b) {
  const unsigned x = unsigned{a.lower.x <= b.upper.x} & unsigned{b.lower.x <= a.upper.x};
  const unsigned y = unsigned{a.lower.y <= b.upper.y} & unsigned{b.lower.y <= a.upper.y};
  const unsigned z = unsigned{a.lower.z <= b.upper.z} & unsigned{b.lower.z <= a.upper.z};
  return (x & y & z) != 0;
}

// A node of a group's tree or, without a group, of the tree over all groups.
struct Node {
  Box box;
  const TriangleGroup* group = nullptr;
  std::uint32_t level = 0, number = 0;

  bool isTriangle() const { return group && level == 0; }
  // The node of greater height is split first.
  std::uint32_t height() const { return group ? level : level + 64; }
  bool operator==(const Node& other) const {
    return group == other.group && level == other.level && number == other.number;
  }
  std::uint64_t mostTriangles() const { return std::uint64_t{1} << 3 * level; }
};

// visit(i) for every i below `count`, by several threads if there are many.
template <typename Visitor>
void forEachInChunks(std::size_t count, int threads, Visitor&& visit) {
  constexpr std::size_t kChunk = 4096;
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  parallelFor(chunks > 1 ? threads : 1, chunks, [&](std::size_t chunk, int) {
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, count); ++i) visit(i);
  });
}

struct Center {
  Vec3f at;
  std::uint32_t item;
};

// Halves the centers across their longest extent, again and again, so that what goes to one node of
// a tree lies together. All nodes but the last of a level are full.
void sortInSpace(std::span<Center> centers, int threads) {
  std::size_t full = 1;  // the items of the largest full node that is smaller than all
  while (full * BoxTree::kChildren < centers.size()) full *= BoxTree::kChildren;
  if (full == 1) return;
  Box box;
  for (const Center& center : centers) box.add(center.at);
  const Vec3f size = box.upper - box.lower;
  float Vec3f::*const axis = size.x >= size.y && size.x >= size.z ? &Vec3f::x
                             : size.y >= size.z                   ? &Vec3f::y
                                                                  : &Vec3f::z;
  const std::size_t nodes = (centers.size() + full - 1) / full;
  const std::size_t middle = (nodes + 1) / 2 * full;
  std::nth_element(centers.begin(), centers.begin() + static_cast<std::ptrdiff_t>(middle),
                   centers.end(),
                   [axis](const Center& a, const Center& b) { return a.at.*axis < b.at.*axis; });
  const auto sortHalf = [&](std::size_t half, int) {
    sortInSpace(half == 0 ? centers.first(middle) : centers.subspan(middle), threads / 2);
  };
  if (threads > 1) return parallelFor(threads, 2, sortHalf);
  sortHalf(0, 0);
  sortHalf(1, 0);
}

struct Task {
  Node a, b;
};

struct KnownFacet {
  PlacedTriangleId id{kNoTriangle, kNoInstance};
  Facet facet;
};

class PairFinder {
 public:
  PairFinder(const PairSearch& search, const BoxTree& groups, std::int64_t work)
      : search_(search), groups_(groups), work_(work) {}

  void searchAll(std::vector<Task>& tasks) {
    tasks_ = &tasks;
    const Node root = nodeOf(nullptr, groups_.top(), 0);
    search(root, root);
  }
  void search(Node a, Node b);
  std::vector<FacetPair> takePairs() { return std::move(found_); }
  std::int64_t workLeft() const { return std::max<std::int64_t>(work_, 0); }

 private:
  Node nodeOf(const TriangleGroup* group, std::uint32_t level, std::uint32_t number) const;
  void takeApart(const Node& node, const Node& other);
  bool isLeftOut(const Node& node, std::uint32_t number) const {
    return !search_.leftOut.empty() && node.group && node.group->instance == kNoInstance &&
           search_.leftOut[node.group->firstTriangle + node.group->tree->item(number)] != 0;
  }
  PlacedTriangleId idOf(const Node& node) const;
  const Facet& facetOf(const Node& node, PlacedTriangleId id);
  void compare(const Node& a, const Node& b);

  const PairSearch& search_;
  const BoxTree& groups_;
  std::int64_t work_;  // that may still be done
  std::vector<Task>* tasks_ = nullptr;
  std::vector<Node> stack_;        // children of the nodes that are taken apart
  std::vector<KnownFacet> known_;  // a cache, because neighbors are compared again and again
  KnownFacet current_;             // the first one of the pair that was compared last
  std::vector<FacetPair> found_;
};

Node PairFinder::nodeOf(const TriangleGroup* group, std::uint32_t level,
                        std::uint32_t number) const {
  if (!group && level == 0) {
    group = &search_.groups[groups_.item(number)];
    level = group->tree->top();
    number = 0;
  }
  const Box& box = (group ? *group->tree : groups_).box(level, number);
  const bool isPlaced = !group || group->isPlaced;
  return {isPlaced ? box : search_.space.boxOf(box, group->instance), group, level, number};
}

// Takes the node apart unless the other one is higher, and keeps what meets the other one.
void PairFinder::takeApart(const Node& node, const Node& other) {
  if (node.height() < other.height()) {
    stack_.push_back(node);
    return;
  }
  const BoxTree& tree = node.group ? *node.group->tree : groups_;
  const std::uint32_t first = node.number * BoxTree::kChildren,
                      end = std::min(first + BoxTree::kChildren, tree.count(node.level - 1));
  const bool isPlaced = !node.group || node.group->isPlaced;
  for (std::uint32_t number = first; number < end; ++number) {
    if (isPlaced && !meet(tree.box(node.level - 1, number), other.box)) continue;
    if (node.level == 1 && isLeftOut(node, number)) continue;
    const Node child = nodeOf(node.group, node.level - 1, number);
    if (isPlaced || meet(child.box, other.box)) stack_.push_back(child);
  }
}

PlacedTriangleId PairFinder::idOf(const Node& node) const {
  const std::uint32_t item = node.group->tree->item(node.number);
  if (node.group->list) return placedTriangle((*node.group->list)[item]);
  return {node.group->firstTriangle + item, node.group->instance};
}

const Facet& PairFinder::facetOf(const Node& node, PlacedTriangleId id) {
  if (known_.empty()) known_.resize(kKnownFacets);
  KnownFacet& known = known_[node.number % kKnownFacets];
  if (known.id != id) known = {id, search_.space.facet(id)};
  return known.facet;
}

void PairFinder::compare(const Node& nodeA, const Node& nodeB) {
  const PlacedTriangleId idA = idOf(nodeA), idB = idOf(nodeB);
  if (idA == idB || work_ <= 0) return;
  work_ -= kWorkOfFacets;
  // The second may take the first one's place in the cache.
  if (current_.id != idA) current_ = {idA, facetOf(nodeA, idA)};
  const Facet &a = current_.facet, &b = facetOf(nodeB, idB);
  if (a.normal == Vec3d{} || b.normal == Vec3d{}) return;
  if (!lieInOnePlane(a, b) || !search_.test(a, b)) return;
  work_ -= kWorkOfPair;
  found_.emplace_back(orderOf(idA), orderOf(idB));
}

void PairFinder::search(Node a, Node b) {
  const bool isSame = a == b;
  if (work_ <= 0 || (isSame && a.isTriangle())) return;
  if (a.group && b.group) {
    if (!search_.wanted(*a.group, *b.group)) return;
    if (a.isTriangle() && b.isTriangle()) return compare(a, b);
    if (tasks_ && a.mostTriangles() + b.mostTriangles() <= kTaskTriangles) {
      work_ -= kWorkOfTask;
      tasks_->push_back({a, b});
      return;
    }
  }
  const bool isWanted = a.group && b.group;  // and so are the triangles of both
  const std::size_t beginA = stack_.size();
  takeApart(a, b);
  const std::size_t endA = stack_.size(), beginB = isSame ? beginA : endA;
  if (!isSame) takeApart(b, a);
  const std::size_t endB = stack_.size();
  work_ -= static_cast<std::int64_t>(kWorkOfNodes + (endA - beginA) * (endB - beginB));
  for (std::size_t i = beginA; i < endA; ++i) {
    for (std::size_t k = isSame ? i : beginB; k < endB; ++k) {
      if (!meet(stack_[i].box, stack_[k].box)) continue;
      if (stack_[i].isTriangle() && stack_[k].isTriangle() && isWanted) {
        compare(stack_[i], stack_[k]);
      } else {
        search(stack_[i], stack_[k]);
      }
    }
  }
  stack_.erase(stack_.begin() + static_cast<std::ptrdiff_t>(beginA), stack_.end());
}

// Does the tasks, each with an equal share of the work. Tasks that it did not suffice for are done
// again with what others have left over.
std::vector<FacetPair> doTasks(const PairSearch& search, const BoxTree& groups,
                               const std::vector<Task>& tasks, std::int64_t work, int threads,
                               bool& complete) {
  std::vector<std::vector<FacetPair>> pairs(tasks.size());
  std::vector<std::int64_t> left(tasks.size());
  std::vector<std::size_t> open(tasks.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  std::int64_t before = 0;
  while (!open.empty()) {
    const std::int64_t share = work / static_cast<std::int64_t>(open.size());
    if (share <= 0 || share < 2 * before) break;
    const auto run = [&](std::size_t k, int) {
      const std::size_t i = open[k];
      PairFinder finder(search, groups, share);
      finder.search(tasks[i].a, tasks[i].b);
      pairs[i] = finder.takePairs();
      left[i] = finder.workLeft();
    };
    parallelFor(open.size() > 1 ? threads : 1, open.size(), run);
    for (const std::size_t i : open) work -= share - left[i];
    std::erase_if(open, [&](std::size_t i) { return left[i] > 0; });
    before = share;
  }
  if (!open.empty()) complete = false;
  std::vector<FacetPair> all;
  for (std::vector<FacetPair>& some : pairs) {
    all.insert(all.end(), some.begin(), some.end());
    some = {};
  }
  return all;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& items, int threads) {
  if (items.empty()) return;
  std::vector<Center> centers(items.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    centers[i] = {items[i].lower * 0.5f + items[i].upper * 0.5f, i};
  }
  sortInSpace(centers, centers.size() > kTaskTriangles ? threads : 1);
  items_.reserve(items.size());
  levels_.emplace_back().reserve(items.size());
  for (const Center& center : centers) {
    items_.push_back(center.item);
    levels_[0].push_back(items[center.item]);
  }
  while (levels_.back().size() > 1) {
    const std::vector<Box>& below = levels_.back();
    std::vector<Box> boxes((below.size() + kChildren - 1) / kChildren);
    for (std::size_t i = 0; i < below.size(); ++i) {
      boxes[i / kChildren].add(below[i].lower);
      boxes[i / kChildren].add(below[i].upper);
    }
    levels_.push_back(std::move(boxes));
  }
}

BoxTree treeOf(const Scene& scene, std::size_t number, int threads) {
  const Geometry& geometry = scene.geometries[number];
  const FacetSpace world(scene);
  std::vector<Box> boxes(geometry.classBegin.back());
  forEachInChunks(boxes.size(), threads, [&](std::size_t i) {
    const float* const p = scene.triangles[geometry.firstTriangle + i].position;
    for (int k = 0; k < 9; k += 3) boxes[i].add({p[k], p[k + 1], p[k + 2]});
    if (number == 0) boxes[i] = world.boxOf(boxes[i], kNoInstance);
  });
  return BoxTree(boxes, threads);
}

FacetSpace::FacetSpace(const Scene& scene, const BoxTree& tree, std::uint32_t geometry)
    : scene_(scene) {
  const Box& all = tree.box(tree.top(), 0);
  const Vec3d far = max(abs(Vec3d(all.lower)), abs(Vec3d(all.upper)));
  for (const InstanceRecord& instance : scene.instances) {
    if (instance.geometry != geometry) continue;
    // Bounds of the lengths to which the map takes unit vectors. Of the three singular values the
    // product of two is at most half the sum of all squares.
    const Affine& map = instance.toWorld;
    const double squares = dot(map.x, map.x) + dot(map.y, map.y) + dot(map.z, map.z);
    const double least = 2 * std::abs(map.determinant()) / squares, most = std::sqrt(squares);
    const double error = kErrorOfMagnitude * magnitudeOf(far, &map);
    error_ = std::min(std::max(error_, error / least), kLargestError);
    // A corner's magnitude in the world is no less than the length of what its map's linear part
    // makes of it; its magnitude here is at most sqrt(3) times its length. Widths grow by `most`
    // at most.
    leastShare_ = std::min(leastShare_, least / most / std::sqrt(3.0));
  }
}

Facet FacetSpace::facet(PlacedTriangleId id) const {
  Facet facet;
  setCorners(scene_.triangles[id.triangle], toWorld(id.instance), facet);
  facet.least *= leastShare_;
  if (error_ > 0) facet.error = error_;
  return facet;
}

Box FacetSpace::boxOf(PlacedTriangleId id) const {
  const Facet own = facet(id);
  const auto& [a, b, c] = own.corners;
  return grown(min(min(a, b), c), max(max(a, b), c), own.error);
}

Box FacetSpace::boxOf(const Box& box, std::uint32_t instance) const {
  const Affine* const map = toWorld(instance);
  Vec3d lower(box.lower), upper(box.upper);
  const double error =
      error_ > 0 ? error_ : kErrorOfMagnitude * magnitudeOf(max(abs(lower), abs(upper)), map);
  if (map) {
    const Vec3d center = map->point((lower + upper) * 0.5), half = (upper - lower) * 0.5;
    const Vec3d reach = abs(map->x) * half.x + abs(map->y) * half.y + abs(map->z) * half.z;
    lower = center - reach;
    upper = center + reach;
  }
  return grown(lower, upper, error);
}

std::vector<std::uint8_t> tooNarrowToOverlap(const Scene& scene, const FacetSpace& space,
                                             std::uint32_t geometry, int threads) {
  std::vector<std::uint8_t> narrow(scene.triangles.size());
  const Geometry& g = scene.geometries[geometry];
  forEachInChunks(g.classBegin.back(), threads, [&](std::size_t i) {
    const std::uint32_t triangle = g.firstTriangle + static_cast<std::uint32_t>(i);
    narrow[triangle] = isTooNarrowToOverlap(space.facet({triangle, kNoInstance})) ? 1 : 0;
  });
  return narrow;
}

std::vector<FacetPair> findPairs(const PairSearch& search, std::uint64_t triangles, int threads,
                                 bool& complete) {
  if (search.groups.empty()) return {};
  std::vector<Box> boxes;
  for (const TriangleGroup& group : search.groups) {
    const Box& all = group.tree->box(group.tree->top(), 0);
    boxes.push_back(group.isPlaced ? all : search.space.boxOf(all, group.instance));
  }
  const BoxTree groups(boxes, 1);
  const std::int64_t work = (search.groups.size() < kManyGroups ? kWork : kWorkOfInstances) +
                            kWorkPerTriangle * static_cast<std::int64_t>(triangles);
  std::vector<Task> tasks;
  PairFinder sharer(search, groups, work);
  sharer.searchAll(tasks);
  if (sharer.workLeft() == 0) complete = false;
  std::vector<FacetPair> pairs = sharer.takePairs();
  const std::vector<FacetPair> more = doTasks(search, groups, tasks, work, threads, complete);
  pairs.insert(pairs.end(), more.begin(), more.end());
  return pairs;
}

}  // namespace whit
