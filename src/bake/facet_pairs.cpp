#include "bake/facet_pairs.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

#include "core/worker_pool.h"

namespace whit {

namespace {

// Fewer are compared with one another.
constexpr std::size_t kFewBlocks = 16;
// A cut pays if it leaves no more than this share of the pairs to compare.
constexpr double kPairsLeft = 0.75;
// Blocks are taken apart where they are longer than this share of their part of space.
constexpr float kLongBlock = 0.25f;

// In triangles; a part of space with fewer is not shared out among threads.
constexpr std::uint64_t kSmallPart = 4096;
constexpr std::uint64_t kPartsForThreads = 64;

// Bounds of the work, counted in comparisons of two boxes. An ordinary mesh takes less than a
// hundred for each triangle.
constexpr std::int64_t kWork = std::int64_t{1} << 31, kWorkPerTriangle = 256;
constexpr std::int64_t kWorkOfFacets = 4;  // of comparing planes
constexpr std::int64_t kWorkOfPair = 128;  // of finding one: bounds what they take in memory
// In a part that cannot be cut, of each triangle: with all others as long as they are no more than
// two thousand, in the end with so many.
constexpr std::size_t kComparisons = std::size_t{1} << 22, kLeastComparisons = 64;

constexpr std::array<std::size_t, 3> kAxes{0, 1, 2};

// A part of space: lower <= x < upper.
struct Part {
  std::array<float, 3> lower, upper;

  static Part everywhere() {
    Part all;
    all.lower.fill(-std::numeric_limits<float>::infinity());
    all.upper.fill(std::numeric_limits<float>::infinity());
    return all;
  }
  bool meets(const BoxedBlock& b) const {
    return std::all_of(kAxes.begin(), kAxes.end(), [&](std::size_t i) {
      return b.lower[i] < upper[i] && b.upper[i] >= lower[i];
    });
  }
  // Whether the lowest point that two boxes have in common is here: it is so in one part alone.
  bool hasLowestOf(const BoxedBlock& a, const BoxedBlock& b) const {
    unsigned inside = 1;
    for (const std::size_t i : kAxes) {
      const float lowest = std::max(a.lower[i], b.lower[i]);
      inside &= unsigned{lowest >= lower[i]} & unsigned{lowest < upper[i]};
    }
    return inside != 0;
  }
};

using Sizes = std::array<float, 3>;

struct Cut {
  std::size_t axis;
  float at;
};

struct Task {
  std::vector<BoxedBlock> blocks;
  Part part;
};

std::uint64_t trianglesOf(const BoxedBlock& block) { return std::uint64_t{1} << 3 * block.level; }

class PairFinder {
 public:
  PairFinder(const FacetSpace& space, PairsOf which, FacetTest test, std::int64_t work)
      : space_(space), which_(which), test_(test), work_(work) {}

  // Parts of so few triangles become tasks instead of being searched.
  void leaveTasks(std::uint64_t triangles, std::vector<Task>* tasks) {
    small_ = triangles;
    tasks_ = tasks;
  }

  void search(std::vector<BoxedBlock> blocks, const Part& part) {
    stack_ = std::move(blocks);
    search(0, part);
  }
  std::vector<FacetPair> takePairs() { return std::move(found_); }
  std::int64_t workLeft() const { return std::max<std::int64_t>(work_, 0); }

 private:
  void search(std::size_t begin, const Part& part);
  bool isWanted(const BoxedBlock& a, const BoxedBlock& b) const;
  bool hasOwnPairs(const BoxedBlock& block) const;
  bool hasPairs(std::size_t begin) const;
  bool isFewWithBlocks(std::size_t begin) const;
  void dropLonely(std::size_t begin);
  Sizes sizesOf(std::size_t begin, const Part& part) const;
  void takeApart(std::size_t i, const Part& part);
  bool takeApartLong(std::size_t begin, const Part& part, const Sizes& size);
  bool takeApartAll(std::size_t begin, const Part& part);
  std::optional<Cut> findCut(std::size_t begin, const Part& part, const Sizes& size) const;
  void compareAll(std::size_t begin, const Part& part, const Sizes& size);
  void compare(std::span<const BoxedBlock> own, std::size_t i, std::size_t k);

  std::span<BoxedBlock> blocks(std::size_t begin) { return std::span(stack_).subspan(begin); }
  std::span<const BoxedBlock> blocks(std::size_t begin) const {
    return std::span(stack_).subspan(begin);
  }

  const FacetSpace& space_;
  PairsOf which_;
  FacetTest test_;
  std::int64_t work_;  // that may still be done
  std::uint64_t small_ = 0;
  std::vector<Task>* tasks_ = nullptr;
  // Of the part in hand at the end, of those that it was cut from below.
  std::vector<BoxedBlock> stack_;
  std::vector<Facet> facets_;      // of the part that is being compared
  std::vector<std::size_t> near_;  // whose boxes meet that of the one in hand
  std::vector<FacetPair> found_;
};

bool PairFinder::isWanted(const BoxedBlock& a, const BoxedBlock& b) const {
  if (which_ == PairsOf::asked) return a.asked != b.asked;
  if (which_ == PairsOf::all) return true;
  if (which_ == PairsOf::withMoving) {
    return a.instance != b.instance && (space_.moves(a.instance) || space_.moves(b.instance));
  }
  return a.instance != b.instance || a.instance == kNoInstance;
}

// Whether two triangles of the block may be a pair that is wanted.
bool PairFinder::hasOwnPairs(const BoxedBlock& block) const {
  return which_ == PairsOf::differentPlaces && block.level > 0 && block.instance == kNoInstance;
}

// Whether there may be a pair that is wanted.
bool PairFinder::hasPairs(std::size_t begin) const {
  const std::span<const BoxedBlock> own = blocks(begin);
  if (own.empty()) return false;
  if (own.size() == 1) return hasOwnPairs(own[0]);
  return std::any_of(own.begin(), own.end(),
                     [&](const BoxedBlock& b) { return &b != &own[0] && isWanted(own[0], b); });
}

bool PairFinder::isFewWithBlocks(std::size_t begin) const {
  const std::span<const BoxedBlock> own = blocks(begin);
  return own.size() <= kFewBlocks &&
         std::any_of(own.begin(), own.end(), [](const BoxedBlock& b) { return b.level > 0; });
}

// Of few blocks those go that meet none with which they could be a pair.
void PairFinder::dropLonely(std::size_t begin) {
  const std::span<BoxedBlock> own = blocks(begin);
  work_ -= static_cast<std::int64_t>(own.size() * own.size());
  std::size_t kept = 0;
  std::array<bool, kFewBlocks> lonely{};
  for (std::size_t i = 0; i < own.size(); ++i) {
    lonely[i] =
        !hasOwnPairs(own[i]) && std::none_of(own.begin(), own.end(), [&](const BoxedBlock& b) {
          return &b != &own[i] && isWanted(own[i], b) && own[i].meets(b);
        });
  }
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!lonely[i]) own[kept++] = own[i];
  }
  stack_.resize(begin + kept);
}

// Of what lies in the part.
Sizes PairFinder::sizesOf(std::size_t begin, const Part& part) const {
  Sizes lower = part.upper, upper = part.lower, size{};
  for (const BoxedBlock& b : blocks(begin)) {
    for (const std::size_t i : kAxes) {
      lower[i] = std::min(lower[i], std::max(b.lower[i], part.lower[i]));
      upper[i] = std::max(upper[i], std::min(b.upper[i], part.upper[i]));
    }
  }
  for (const std::size_t i : kAxes) size[i] = upper[i] - lower[i];
  return size;
}

// The last block takes the place of block i.
void PairFinder::takeApart(std::size_t i, const Part& part) {
  const BoxedBlock whole = stack_[i];
  stack_[i] = stack_.back();
  stack_.pop_back();
  const std::uint32_t end = space_.endOfParts(whole);
  work_ -= TriangleBlocks::kChildren;
  for (std::uint32_t number = space_.firstPart(whole); number < end; ++number) {
    const BoxedBlock child = space_.part(whole, number);
    if (part.meets(child)) stack_.push_back(child);
  }
}

// Whether there were any.
bool PairFinder::takeApartLong(std::size_t begin, const Part& part, const Sizes& size) {
  bool any = false;
  const float most = kLongBlock * std::max({size[0], size[1], size[2]});
  for (std::size_t i = begin; i < stack_.size() && work_ > 0;) {
    const BoxedBlock& b = stack_[i];
    const bool isLong =
        b.level > 0 && std::any_of(kAxes.begin(), kAxes.end(), [&](std::size_t k) {
          return std::min(b.upper[k], part.upper[k]) - std::max(b.lower[k], part.lower[k]) > most;
        });
    if (isLong) {
      takeApart(i, part);
      any = true;
    } else {
      ++i;
    }
  }
  return any;
}

// By one level. Whether there was anything to take apart.
bool PairFinder::takeApartAll(std::size_t begin, const Part& part) {
  bool any = false;
  for (std::size_t i = stack_.size(); i-- > begin;) {
    if (stack_[i].level == 0) continue;
    takeApart(i, part);
    any = true;
  }
  return any;
}

// At the mean of the centers, across the longest axis for which it pays.
std::optional<Cut> PairFinder::findCut(std::size_t begin, const Part& part,
                                       const Sizes& size) const {
  const std::span<const BoxedBlock> own = blocks(begin);
  if (own.size() <= kFewBlocks) return std::nullopt;
  std::array<std::size_t, 3> axes = kAxes;
  std::stable_sort(axes.begin(), axes.end(),
                   [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
  const auto count = static_cast<double>(own.size());
  for (const std::size_t axis : axes) {
    double sum = 0;
    for (const BoxedBlock& b : own) {
      sum += double{std::max(b.lower[axis], part.lower[axis])} +
             double{std::min(b.upper[axis], part.upper[axis])};
    }
    const auto at = static_cast<float>(0.5 * sum / count);
    std::size_t below = 0, above = 0;
    for (const BoxedBlock& b : own) {
      below += b.lower[axis] < at;
      above += b.upper[axis] >= at;
    }
    const auto left = static_cast<double>(below * below + above * above);
    if (left <= kPairsLeft * count * count) return Cut{axis, at};
  }
  return std::nullopt;
}

void PairFinder::search(std::size_t begin, const Part& part) {
  std::optional<Cut> cut;
  Sizes size;
  do {
    if (isFewWithBlocks(begin)) dropLonely(begin);
    if (work_ <= 0 || !hasPairs(begin)) return;
    size = sizesOf(begin, part);
    if (takeApartLong(begin, part, size)) size = sizesOf(begin, part);
    cut = findCut(begin, part, size);
  } while (!cut && takeApartAll(begin, part));
  std::uint64_t triangles = 0;
  for (const BoxedBlock& b : blocks(begin)) triangles += trianglesOf(b);
  if (tasks_ && triangles <= small_) {
    const std::span<const BoxedBlock> own = blocks(begin);
    tasks_->push_back({{own.begin(), own.end()}, part});
    return;
  }
  if (!cut) return compareAll(begin, part, size);
  const std::size_t end = stack_.size();
  work_ -= static_cast<std::int64_t>(end - begin);
  Part lower = part, upper = part;
  lower.upper[cut->axis] = upper.lower[cut->axis] = cut->at;
  for (const Part& half : {lower, upper}) {
    for (std::size_t i = begin; i < end; ++i) {
      const BoxedBlock b = stack_[i];
      const bool isThere =
          b.lower[cut->axis] < half.upper[cut->axis] && b.upper[cut->axis] >= half.lower[cut->axis];
      if (isThere) stack_.push_back(b);
    }
    search(end, half);
    stack_.resize(end);
  }
}

void PairFinder::compare(std::span<const BoxedBlock> own, std::size_t i, std::size_t k) {
  if (!isWanted(own[i], own[k]) || own[i].id() == own[k].id()) return;
  const Facet &a = facets_[i], &b = facets_[k];
  work_ -= kWorkOfFacets;
  if (a.normal == Vec3d{} || b.normal == Vec3d{} || !lieInOnePlane(a, b) || !test_(a, b)) return;
  work_ -= kWorkOfPair;
  found_.emplace_back(orderOf(own[i].id()), orderOf(own[k].id()));
}

void PairFinder::compareAll(std::size_t begin, const Part& part, const Sizes& size) {
  if (stack_.size() - begin < 2) return;
  const std::size_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0
                           : size[1] >= size[2]                     ? 1
                                                                    : 2;
  const std::span<BoxedBlock> own = blocks(begin);
  std::sort(own.begin(), own.end(), [&](const BoxedBlock& a, const BoxedBlock& b) {
    return a.lower[axis] != b.lower[axis] ? a.lower[axis] < b.lower[axis]
                                          : orderOf(a.id()) < orderOf(b.id());
  });
  facets_.clear();
  for (const BoxedBlock& b : own) facets_.push_back(space_.facet(b.id()));
  const std::size_t most = std::max(kComparisons / own.size(), kLeastComparisons);
  near_.resize(own.size());
  for (std::size_t i = 0; i < own.size() && work_ > 0; ++i) {
    const BoxedBlock& a = own[i];
    const std::size_t end = std::min(own.size(), i + 1 + most);
    std::size_t count = 0, k = i + 1;
    for (; k < end && own[k].lower[axis] <= a.upper[axis]; ++k) {
      near_[count] = k;
      count += unsigned{a.meets(own[k])} & unsigned{part.hasLowestOf(a, own[k])};
    }
    work_ -= static_cast<std::int64_t>(k - i);
    for (std::size_t n = 0; n < count; ++n) compare(own, i, near_[n]);
  }
}

// Does the tasks, each with an equal share of the work; those that it did not suffice for again,
// with what others have left over.
class TaskRunner {
 public:
  TaskRunner(std::vector<Task> tasks, std::int64_t work)
      : tasks_(std::move(tasks)), pairs_(tasks_.size()), left_(tasks_.size()), work_(work) {}

  template <typename Run>
  std::vector<FacetPair> run(const Run& task, int threads) {
    std::vector<std::size_t> open(tasks_.size());
    std::iota(open.begin(), open.end(), std::size_t{0});
    std::int64_t before = 0;
    while (!open.empty()) {
      const std::int64_t share = work_ / static_cast<std::int64_t>(open.size());
      if (share <= 0 || share < 2 * before) break;
      parallelFor(threads, open.size(), [&](std::size_t k, int) {
        const std::size_t i = open[k];
        std::tie(pairs_[i], left_[i]) = task(tasks_[i], share);
      });
      for (const std::size_t i : open) work_ -= share - left_[i];
      std::erase_if(open, [&](std::size_t i) { return left_[i] > 0; });
      before = share;
    }
    return joined();
  }

 private:
  std::vector<FacetPair> joined() {
    std::vector<FacetPair> all;
    for (std::vector<FacetPair>& some : pairs_) {
      all.insert(all.end(), some.begin(), some.end());
      some = {};
    }
    return all;
  }

  std::vector<Task> tasks_;
  std::vector<std::vector<FacetPair>> pairs_;  // that each task has found
  std::vector<std::int64_t> left_;             // of its work; 0 if it was not enough
  std::int64_t work_;
};

}  // namespace

std::vector<FacetPair> findPairs(const FacetSpace& space, std::vector<BoxedBlock> blocks,
                                 PairsOf which, FacetTest test, std::uint64_t triangles,
                                 int threads) {
  std::uint64_t total = 0;
  for (const BoxedBlock& b : blocks) total += trianglesOf(b);
  const std::int64_t work = kWork + kWorkPerTriangle * static_cast<std::int64_t>(triangles);
  std::vector<Task> tasks;
  PairFinder sharer(space, which, test, work);
  sharer.leaveTasks(std::max(kSmallPart, total / kPartsForThreads), &tasks);
  sharer.search(std::move(blocks), Part::everywhere());
  std::vector<FacetPair> pairs = sharer.takePairs();
  TaskRunner runner(std::move(tasks), work);
  const std::vector<FacetPair> more = runner.run(
      [&](const Task& task, std::int64_t share) {
        PairFinder finder(space, which, test, share);
        finder.search(task.blocks, task.part);
        return std::pair(finder.takePairs(), finder.workLeft());
      },
      threads);
  pairs.insert(pairs.end(), more.begin(), more.end());
  return pairs;
}

}  // namespace whit
