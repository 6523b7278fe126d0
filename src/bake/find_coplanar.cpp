// The search for coplanar triangles. It descends trees of bounding boxes, two nodes at a time, and
// compares triangles whose boxes meet.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "bake/facet.h"
#include "core/index.h"
#include "core/vec3.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// At most this many coincident instances of one object are searched for overlaps; more would make
// the search quadratic.
constexpr int kInstancesInOnePlace = 4;

// Limits of the work, in comparisons of two boxes. An ordinary mesh takes less than a hundred for
// each triangle. Many instances that overlap are given less: they seldom have coplanar faces.
constexpr std::int64_t kWork = std::int64_t{1} << 28, kWorkPerTriangle = 256;
constexpr std::int64_t kWorkOfInstances = std::int64_t{1} << 24;
constexpr std::size_t kManyGroups = 64;
constexpr std::int64_t kWorkOfNodes = 16;   // cost of splitting two nodes
constexpr std::int64_t kWorkOfFacets = 4;   // cost of comparing two facets
constexpr std::int64_t kWorkOfPair = 128;   // cost of a pair that is found, because it takes memory
constexpr std::int64_t kWorkOfTask = 1024;  // likewise

// Pairs of nodes with at most this many triangles become tasks for threads.
constexpr std::uint64_t kTaskTriangles = 8192;

using Orders = std::vector<std::uint64_t>;  // orderOf() of triangles
using Pairs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

void addBoth(const Pairs& pairs, Orders& orders) {
  if (pairs.empty()) return;
  for (const auto& [a, b] : pairs) orders.insert(orders.end(), {a, b});
  std::ranges::sort(orders);
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
}

// Boxes grow by this many errors. 1 would do but for the rounding of the box to float and for
// corners of two triangles that no edge separates, though they are farther apart.
constexpr double kGrowth = 2;

Box grown(const Vec3d& lower, const Vec3d& upper, double error) {
  return {Vec3f(lower - Vec3d(kGrowth * error)), Vec3f(upper + Vec3d(kGrowth * error))};
}

// How a triangle lies. `lean` bounds its share of the sine of the angle between two triangles that
// lie in one plane: the corners of one are no farther from the plane of the other than the sum of
// their errors, and the triangle is as wide as its least altitude, so that the sine is at most
// twice that sum over the altitude.
struct Slope {
  Vec3f normal;
  float lean = 1;
};

Slope slopeOf(const Facet& facet) {
  constexpr double kRounding = 1e-6;  // error of the normals and of their cross product in floats
  constexpr double kMargin = 1.001;
  return {Vec3f(facet.normal),
          static_cast<float>(kRounding + kMargin * 2 * facet.error / leastAltitude(facet))};
}

// False only if the triangles do not lie in one plane.
bool mayLieInOnePlane(const Slope& a, const Slope& b) {
  const Vec3f sine = cross(a.normal, b.normal);
  const float most = a.lean + b.lean;
  return !(dot(sine, sine) > most * most);
}

// A box, and the place of its item in a list of items.
struct BoxedItem {
  std::uint32_t place = 0;
  Box box;
};

// Twice the center of a box, and the number of the box. Sorting moves less than with boxes.
struct BoxCenter {
  Vec3f twice;
  std::uint32_t number = 0;
};

// Halves the items across their longest extent, again and again, so that neighbors follow each
// other and all nodes but the last of a level are full. Threads share large halves.
void sortInSpace(std::span<BoxCenter> items, std::size_t children, int threads) {
  std::size_t full = 1;  // the items of the largest full node that is smaller than all
  while (full * children < items.size()) full *= children;
  if (full == 1) return;

  Box box;
  for (const BoxCenter& item : items) box.add(item.twice);
  const int axis = largestAxis(box.upper - box.lower);

  // The split lies between two full nodes, about in the middle.
  const std::size_t middle = ((items.size() + full - 1) / full + 1) / 2 * full;
  const auto along = std::array{&Vec3f::x, &Vec3f::y, &Vec3f::z}[axis];
  std::nth_element(
      items.begin(), items.begin() + middle, items.end(),
      [along](const BoxCenter& a, const BoxCenter& b) { return a.twice.*along < b.twice.*along; });

  const bool areShared = threads > 1 && std::min(middle, items.size() - middle) > kTaskTriangles;
  const auto sortHalf = [&](std::size_t half, int) {
    sortInSpace(half == 0 ? items.first(middle) : items.subspan(middle), children,
                areShared ? threads / 2 : threads);
  };
  if (areShared) {
    parallelFor(threads, 2, sortHalf);
  } else {
    sortHalf(0, 0);
    sortHalf(1, 0);
  }
}

// The boxes of eight neighbors, which are tested together; empty ones after the last.
class BoxBlock {
 public:
  static constexpr std::size_t kBoxes = 8;
  // A byte for each box, the first one the lowest: 1 or 0.
  using Bytes = std::uint64_t;

  BoxBlock() {
    for (const auto axis : indices(3)) {
      lower_[axis].fill(std::numeric_limits<float>::max());
      upper_[axis].fill(std::numeric_limits<float>::lowest());
    }
  }

  void set(std::size_t i, const Box& box) {
    for (const auto axis : indices(3)) {
      lower_[axis][i] = box.lower[static_cast<int>(axis)];
      upper_[axis][i] = box.upper[static_cast<int>(axis)];
    }
  }
  Box box(std::size_t i) const {
    return {{lower_[0][i], lower_[1][i], lower_[2][i]}, {upper_[0][i], upper_[1][i], upper_[2][i]}};
  }

  // Marks the boxes that have a point in common with `other`. The tests have no branches, because
  // processors could not predict them.
  Bytes meeting(const Box& other) const {
    std::array<std::uint8_t, kBoxes> marks;
    marks.fill(1);
    for (const auto axis : indices(3)) {
      const float lower = other.lower[static_cast<int>(axis)];
      const float upper = other.upper[static_cast<int>(axis)];
      for (const auto i : indices(kBoxes)) {
        const unsigned meets =
            unsigned{lower_[axis][i] <= upper} & unsigned{lower <= upper_[axis][i]};
        marks[i] = static_cast<std::uint8_t>(marks[i] & meets);
      }
    }
    return std::bit_cast<Bytes>(marks);
  }

  // Returns boxes that hold these ones after the map, grown by `error` and the error bound of their
  // corners.
  BoxBlock moved(const Affine& map, double error) const {
    const Affine size = abs(map);
    BoxBlock to;
    for (const auto i : indices(kBoxes)) {
      const Box own = box(i);
      if (own.empty()) continue;

      // The absolute values of the linear part carry the half sides of the box.
      const Vec3d lower(own.lower), upper(own.upper);
      const Vec3d center = map.point((lower + upper) * 0.5);
      const Vec3d half = size.vector((upper - lower) * 0.5);
      const double magnitude = magnitudeOf(max(abs(lower), abs(upper)), &map);
      to.set(i, grown(center - half, center + half, error + kErrorOfMagnitude * magnitude));
    }
    return to;
  }

 private:
  std::array<std::array<float, kBoxes>, 3> lower_, upper_;
};

// Calls visit(i) for each marked box.
template <typename Visitor>
void forEachMarked(BoxBlock::Bytes marks, Visitor&& visit) {
  for (; marks != 0; marks &= marks - 1) {
    visit(static_cast<std::size_t>(std::countr_zero(marks)) / 8);
  }
}

struct TreeItem {
  std::uint64_t item = 0;
  Slope slope;
};

// A tree over boxes: eight neighbors share a box of the next level, up to the one box that holds
// all. Level 0 are the items.
class BoxTree {
 public:
  static constexpr std::uint32_t kChildren = BoxBlock::kBoxes;

  BoxTree() = default;
  BoxTree(const std::vector<TreeItem>& items, const std::vector<BoxedItem>& boxes, int threads) {
    if (boxes.empty()) return;
    std::vector<BoxCenter> order;
    order.reserve(boxes.size());
    for (const auto& [place, box] : boxes) {
      order.push_back({box.lower + box.upper, static_cast<std::uint32_t>(order.size())});
    }
    sortInSpace(order, kChildren, threads);

    items_.reserve(boxes.size());
    levels_.emplace_back((boxes.size() + kChildren - 1) / kChildren);
    for (const auto i : indices(order)) {
      const auto& [place, box] = boxes[order[i].number];
      items_.push_back(items[place]);
      levels_[0][i / kChildren].set(i % kChildren, box);
    }
    counts_.push_back(static_cast<std::uint32_t>(boxes.size()));

    // Each further level has one box for eight neighbors of the level below.
    while (counts_.back() > 1) {
      const std::vector<BoxBlock>& below = levels_.back();
      std::vector<BoxBlock> level((below.size() + kChildren - 1) / kChildren);
      for (const auto i : indices(below)) {
        Box all;
        for (const auto k :
             indices(std::min<std::size_t>(kChildren, counts_.back() - i * kChildren))) {
          all.add(below[i].box(k).lower);
          all.add(below[i].box(k).upper);
        }
        level[i / kChildren].set(i % kChildren, all);
      }
      counts_.push_back(static_cast<std::uint32_t>(below.size()));
      levels_.push_back(std::move(level));
    }
  }

  bool empty() const { return items_.empty(); }
  std::uint32_t top() const { return static_cast<std::uint32_t>(levels_.size() - 1); }
  std::uint32_t count(std::uint32_t level) const { return counts_[level]; }
  // The boxes of a level from number 8 * `block` on.
  const BoxBlock& block(std::uint32_t level, std::uint32_t block) const {
    return levels_[level][block];
  }
  std::uint64_t item(std::uint32_t number) const { return items_[number].item; }
  const Slope& slope(std::uint32_t number) const { return items_[number].slope; }

 private:
  std::vector<TreeItem> items_;  // in the order of the boxes of level 0
  std::vector<std::vector<BoxBlock>> levels_;
  std::vector<std::uint32_t> counts_;  // boxes of each level
};

// The space that is searched: the world, or that of one instanced geometry for all of its instances
// at once.
class Space {
 public:
  explicit Space(const Scene& scene) : scene_(scene) {}

  // Two triangles of the geometry that overlap in one plane in some instance do so in this space.
  Space(const Scene& scene, std::uint32_t geometry) : scene_(scene) {
    // Coordinates are smaller than this, and floats reach much farther.
    constexpr double kLargestError = 8.0 * kLargestCoordinate;
    const Geometry& g = scene.geometries[geometry];

    Vec3d far;
    for (std::uint32_t i = 0; i < g.index.size(); ++i) {
      for (const Vec3d& corner : worldCorners(scene, g.firstTriangle + i, kNoInstance)) {
        far = max(far, abs(corner));
      }
    }

    for (const InstanceRecord& instance : scene.instances) {
      if (instance.geometry != geometry) continue;
      // Bounds of the lengths to which the map takes unit vectors: of the three singular values,
      // the product of two is at most half the sum of all squares.
      const Affine& map = instance.toWorld;
      const double squares = dot(map.x, map.x) + dot(map.y, map.y) + dot(map.z, map.z);
      const double least = 2 * std::abs(map.determinant()) / squares, most = std::sqrt(squares);

      // An error in the world is largest in this space where the map shrinks most.
      const double error = kErrorOfMagnitude * magnitudeOf(far, &map);
      error_ = std::min(std::max(error_, error / least), kLargestError);
      // A corner's magnitude in the world is at least the length of its image by the map's linear
      // part; its magnitude here is at most sqrt(3) times its length. Widths grow by `most` at
      // most.
      leastShare_ = std::min(leastShare_, least / most / std::sqrt(3.0));
    }
  }

  Facet facet(PlacedTriangleId id) const {
    Facet facet = facetOf(scene_, id);
    facet.least *= leastShare_;
    if (error_ > 0) facet.error = error_;
    return facet;
  }
  // Returns a box that contains everything that can touch the triangle.
  Box boxOf(const Facet& facet) const {
    const auto& [a, b, c] = facet.corners;
    return grown(min(min(a, b), c), max(max(a, b), c), facet.error);
  }

  // Returns the boxes in the world of boxes of a tree: the world's own tree has grown boxes
  // already, an instance's has not.
  BoxBlock boxesOf(const BoxBlock& boxes, std::uint32_t instance) const {
    if (instance != kNoInstance) return boxes.moved(scene_.instances[instance].toWorld, 0);
    return error_ > 0 ? boxes.moved(Affine(), error_) : boxes;
  }

 private:
  const Scene& scene_;
  double error_ = 0;       // error of all facets, if it is not 0
  double leastShare_ = 1;  // least share of a facet's own error in Facet::least
};

// Triangles that are searched: the items of the tree are their orderOf(), or, in an instance, their
// numbers.
struct Group {
  const BoxTree* tree = nullptr;
  std::uint32_t instance = kNoInstance;
};

// A node of a group's tree or, without a group, of the tree over all groups.
struct Node {
  Box box;
  const Group* group = nullptr;
  std::uint32_t level = 0, number = 0;

  bool isTriangle() const { return group && level == 0; }
  // The node of greater height is split first.
  std::uint32_t height() const { return group ? level : level + 64; }
  bool operator==(const Node& other) const {
    return group == other.group && level == other.level && number == other.number;
  }
  std::uint64_t mostTriangles() const { return std::uint64_t{1} << 3 * level; }
};

using FacetTest = bool (*)(const Facet& a, const Facet& b);
using Task = std::pair<Node, Node>;

// Finds the pairs of triangles below two nodes that pass the test. Pairs of nodes that are small
// enough become tasks instead, if there is a list for them.
class PairFinder {
 public:
  PairFinder(const Space& space, const std::vector<Group>& groups, const BoxTree& groupTree,
             FacetTest test)
      : space_(space), groups_(groups), groupTree_(groupTree), test_(test) {}

  Node rootOf(const Group* group) const {
    const BoxTree& tree = group ? *group->tree : groupTree_;
    const BoxBlock& top = tree.block(tree.top(), 0);
    const BoxBlock boxes = group ? space_.boxesOf(top, group->instance) : top;
    return nodeOf(boxes.box(0), group, tree.top(), 0);
  }
  // Searches below two nodes. The comparisons are subtracted from `work`, and the search stops when
  // nothing is left of it.
  void search(const Node& a, const Node& b, std::atomic<std::int64_t>& work,
              std::vector<Task>* tasks = nullptr) {
    const std::int64_t before = work;
    left_ = before;
    tasks_ = tasks;
    search(a, b);
    work -= before - left_;
  }
  const Pairs& found() const { return found_; }

 private:
  Node nodeOf(const Box& box, const Group* group, std::uint32_t level, std::uint32_t number) const {
    // A leaf of the tree over the groups is the root of a group's own tree.
    if (!group && level == 0) {
      group = &groups_[groupTree_.item(number)];
      level = group->tree->top();
      number = 0;
    }
    return {box, group, level, number};
  }

  // The children of a node, or the node itself if the other one of its pair is higher.
  struct Children {
    const Group* group = nullptr;
    std::uint32_t level = 0, first = 0;
    BoxBlock boxes;

    // An instance turns the slopes of its triangles.
    bool knowsSlopes() const { return group && level == 0 && group->instance == kNoInstance; }
  };
  Children childrenOf(const Node& node, const Node& other) const {
    Children children{node.group, node.level, node.number, {}};
    if (node.height() < other.height()) {
      children.boxes.set(0, node.box);
      return children;
    }

    const BoxTree& tree = node.group ? *node.group->tree : groupTree_;
    --children.level;
    children.first *= BoxTree::kChildren;
    const BoxBlock& own = tree.block(children.level, node.number);
    children.boxes = node.group ? space_.boxesOf(own, node.group->instance) : own;
    return children;
  }

  void search(const Node& a, const Node& b) {
    const bool isSame = a == b;
    if (left_ <= 0 || (isSame && a.isTriangle())) return;

    if (a.group && b.group) {
      // Triangles of one instance are compared in the space of their geometry.
      if (a.group->instance != kNoInstance && a.group->instance == b.group->instance) return;
      if (a.isTriangle() && b.isTriangle()) {
        compare(a, b);
        return;
      }

      // Small pairs are left to the threads.
      if (tasks_ && a.mostTriangles() + b.mostTriangles() <= kTaskTriangles) {
        left_ -= kWorkOfTask;
        tasks_->emplace_back(a, b);
        return;
      }
    }

    const Children ofA = childrenOf(a, b), ofB = isSame ? ofA : childrenOf(b, a);
    const BoxBlock::Bytes markedA = ofA.boxes.meeting(b.box);
    const BoxBlock::Bytes markedB = isSame ? markedA : ofB.boxes.meeting(a.box);
    left_ -= kWorkOfNodes + std::int64_t{std::popcount(markedA)} * std::popcount(markedB);

    const bool knowSlopes = ofA.knowsSlopes() && ofB.knowsSlopes();

    forEachMarked(markedA, [&](std::size_t i) {
      const Box box = ofA.boxes.box(i);
      BoxBlock::Bytes overlapping = ofB.boxes.meeting(box) & markedB;
      if (isSame) overlapping &= ~BoxBlock::Bytes{0} << 8 * i;  // each pair once
      if (overlapping == 0) return;

      const std::uint32_t numberA = ofA.first + static_cast<std::uint32_t>(i);
      const Node first = nodeOf(box, ofA.group, ofA.level, numberA);
      forEachMarked(overlapping, [&](std::size_t k) {
        const std::uint32_t numberB = ofB.first + static_cast<std::uint32_t>(k);

        // Most pairs of triangles end here.
        if (knowSlopes &&
            !mayLieInOnePlane(ofA.group->tree->slope(numberA), ofB.group->tree->slope(numberB))) {
          left_ -= kWorkOfFacets;
          return;
        }
        search(first, nodeOf(ofB.boxes.box(k), ofB.group, ofB.level, numberB));
      });
    });
  }

  void compare(const Node& nodeA, const Node& nodeB) {
    const auto idOf = [](const Node& node) {
      PlacedTriangleId id = placedTriangle(node.group->tree->item(node.number));
      if (node.group->instance != kNoInstance) id.instance = node.group->instance;
      return id;
    };

    const PlacedTriangleId a = idOf(nodeA), b = idOf(nodeB);
    if (a == b) return;
    left_ -= kWorkOfFacets;

    const Facet facet = facetOf(nodeA, a);  // the second may take its place in the cache
    if (!test_(facet, facetOf(nodeB, b))) return;

    left_ -= kWorkOfPair;
    found_.emplace_back(orderOf(a), orderOf(b));
  }

  const Facet& facetOf(const Node& node, PlacedTriangleId id) {
    auto& [known, facet] = known_[node.number % known_.size()];
    // The cache starts with facets without normals for the first triangle.
    if (known != id || facet.normal == Vec3d{}) facet = space_.facet(known = id);
    return facet;
  }

  const Space& space_;
  const std::vector<Group>& groups_;
  const BoxTree& groupTree_;
  FacetTest test_;
  std::int64_t left_ = 0;  // work
  std::vector<Task>* tasks_ = nullptr;
  // A cache, because neighbors are compared again and again.
  std::array<std::pair<PlacedTriangleId, Facet>, 512> known_{};
  Pairs found_;
};

class CoplanarFinder {
 public:
  CoplanarFinder(const Scene& scene, int threads)
      : scene_(scene), threads_(threads), world_(scene), trees_(scene.geometries.size()) {
    // Threads share the geometries, or the one tree if there is no other geometry.
    const bool several = trees_.size() > 1;
    const int outer = several ? threads : 1;
    const int inner = several ? 1 : threads;
    parallelFor(outer, trees_.size(), [&](std::size_t i, int) {
      trees_[i] = treeOf(static_cast<std::uint32_t>(i), inner);
    });

    // Instances are coincident if they have the same geometry and the same map.
    std::map<std::pair<std::uint32_t, std::array<double, 12>>, int> count;
    for (const InstanceRecord& i : scene.instances) {
      const auto map = std::bit_cast<std::array<double, 12>>(i.toWorld);
      leftOut_.push_back(++count[{i.geometry, map}] > kInstancesInOnePlace);
    }
  }

  CoplanarTriangles find() {
    // The world is one group, and every instance is another.
    std::vector<Group> everything;
    if (!trees_[0].empty()) everything.push_back({&trees_[0]});
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
      const BoxTree& tree = trees_[scene_.instances[i].geometry];
      if (!tree.empty() && !leftOut_[i]) everything.push_back({&tree, i});
    }

    Orders all;
    // The first search is for overlaps between groups and within the world.
    Pairs pairs = findPairs(world_, everything, nullptr, facetsOverlap);
    if (!complete_ && everything.size() > 1) {  // The instances overlap too much.
      everything.resize(trees_[0].empty() ? 0 : 1);
      pairs = findPairs(world_, everything, nullptr, facetsOverlap);
    }

    addBoth(pairs, all);
    for (std::uint32_t g = 1; g < trees_.size(); ++g) addWithinInstances(g, all);

    const auto treeOfAll = [&] {
      std::vector<TreeItem> items;
      std::vector<BoxedItem> boxes;
      for (const std::uint64_t order : all) {
        const Facet facet = world_.facet(placedTriangle(order));
        boxes.push_back({static_cast<std::uint32_t>(items.size()), world_.boxOf(facet)});
        items.push_back({order, slopeOf(facet)});
      }
      return BoxTree(items, boxes, 1);
    };
    if (all.empty()) return {};

    // Triangles that merely touch an overlapping one in its plane take part too.
    const BoxTree overlapping = treeOfAll();
    const Group others{&overlapping};
    addBoth(findPairs(world_, everything, &others, facetsTouch), all);

    // Partners are all pairs of these triangles that touch.
    const BoxTree tree = treeOfAll();
    return {scene_, findPairs(world_, {{&tree}}, nullptr, facetsTouch), threads_};
  }

  bool complete() const { return complete_; }

 private:
  // The triangles of a geometry that can overlap others.
  BoxTree treeOf(std::uint32_t geometry, int threads) const {
    const Geometry& g = scene_.geometries[geometry];
    const Space space = geometry == 0 ? world_ : Space(scene_, geometry);
    std::vector<TreeItem> items(g.index.size());
    std::vector<BoxedItem> boxes(items.size());

    constexpr std::size_t kChunk = 4096;
    const std::size_t chunks = (items.size() + kChunk - 1) / kChunk;
    parallelFor(threads, chunks, [&](std::size_t chunk, int) {
      for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, items.size()); ++i) {
        const PlacedTriangleId id{g.firstTriangle + static_cast<std::uint32_t>(i), kNoInstance};
        const Facet facet = space.facet(id);
        if (isTooNarrowToOverlap(facet)) continue;
        items[i] = {orderOf(id), slopeOf(facet)};
        boxes[i].place = static_cast<std::uint32_t>(i);

        // Boxes of instanced geometries grow later, by the error bound of each instance.
        for (const Vec3d& corner : facet.corners) boxes[i].box.add(Vec3f(corner));
        if (geometry == 0) boxes[i].box = space.boxOf(facet);
      }
    });

    // Triangles that were skipped have empty boxes.
    std::erase_if(boxes, [](const BoxedItem& item) { return item.box.empty(); });
    return {items, boxes, threads};
  }

  // The pairs of the groups, or of the groups with the others.
  Pairs findPairs(const Space& space, const std::vector<Group>& groups, const Group* others,
                  FacetTest test) {
    if (groups.empty()) return {};

    std::vector<TreeItem> items;
    std::vector<BoxedItem> boxes;
    for (const Group& group : groups) {
      const BoxBlock& top = group.tree->block(group.tree->top(), 0);
      const Box box = space.boxesOf(top, group.instance).box(0);
      boxes.push_back({static_cast<std::uint32_t>(items.size()), box});
      items.push_back({items.size(), {}});
    }
    const BoxTree groupTree(items, boxes, 1);

    std::atomic<std::int64_t> work =
        (groups.size() < kManyGroups ? kWork : kWorkOfInstances) +
        kWorkPerTriangle * static_cast<std::int64_t>(scene_.triangles.size());

    std::vector<PairFinder> finders;
    finders.reserve(threads_);
    for (int i = 0; i < threads_; ++i) finders.emplace_back(space, groups, groupTree, test);

    // One search from the root collects tasks, which the threads then work off.
    const Node root = finders[0].rootOf(nullptr);
    std::vector<Task> tasks;
    finders[0].search(root, others ? finders[0].rootOf(others) : root, work, &tasks);

    parallelFor(threads_, tasks.size(), [&](std::size_t i, int worker) {
      finders[worker].search(tasks[i].first, tasks[i].second, work);
    });

    // Which pairs an aborted search has found depends on the threads, so they are discarded.
    if (work <= 0) {
      complete_ = false;
      return {};
    }

    Pairs pairs;
    for (const PairFinder& finder : finders) {
      pairs.insert(pairs.end(), finder.found().begin(), finder.found().end());
    }
    return pairs;
  }

  // Adds triangles that overlap others of the same instance. One search in the space of the
  // geometry finds the candidates for all of its instances.
  void addWithinInstances(std::uint32_t geometry, Orders& all) {
    if (trees_[geometry].empty()) return;

    const Pairs candidates =
        findPairs(Space(scene_, geometry), {{&trees_[geometry]}}, nullptr, facetsOverlap);
    if (candidates.size() * scene_.instances.size() > std::uint64_t{kWorkOfInstances}) {
      complete_ = false;
      return;
    }

    Pairs found;
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
      if (scene_.instances[i].geometry != geometry || leftOut_[i]) continue;

      // The search used bounds for all instances; each instance is tested with its own.
      for (const auto& [first, second] : candidates) {
        const PlacedTriangleId a{placedTriangle(first).triangle, i},
            b{placedTriangle(second).triangle, i};
        if (facetsOverlap(world_.facet(a), world_.facet(b))) {
          found.emplace_back(orderOf(a), orderOf(b));
        }
      }
    }
    addBoth(found, all);
  }

  const Scene& scene_;
  int threads_;
  Space world_;
  std::vector<BoxTree> trees_;  // a tree for each geometry
  std::vector<bool> leftOut_;   // true for each instance that is left out
  bool complete_ = true;
};

}  // namespace

CoplanarTriangles findCoplanarTriangles(const Scene& scene, int threads, bool& complete) {
  complete = scene.firstSphere <= kMostSearched;
  if (!complete) return {};

  CoplanarFinder finder(scene, threads);
  CoplanarTriangles found = finder.find();
  complete = finder.complete();
  return found;
}

}  // namespace whit
