// The bound on the rays of a sample (--max-rays).
//
// The impulses of a sample form a tree, which may double with every bounce. A sample whose tree
// would have more impulses than the option says is given up, and traced again as a narrower tree.
// Each of its rays has a width: the product of the numbers of rays that were followed from the
// surfaces before it. Where the rays of a surface would become wider than `widestTree`, one of them
// is followed, drawn with a probability in proportion to the largest channel of its weight, and its
// weight is divided by that probability, so that the mean stays (splitting and Russian roulette:
// Arvo and Kirk 1990, "Particle transport and image synthesis").
//
// The sum of 1 / width over the rays of one depth is at most 1 (Kraft's inequality). So there are
// at most `widestTree` rays at each depth, and in all no more than the option says. Whether a tree
// is too large, and what a narrower one is like, depends on the sample alone and not on the order
// in which its rays are traced.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sampling/random_streams.h"

namespace whit {

constexpr std::uint64_t widestTree(int maxRays, int depth) {
  return static_cast<std::uint64_t>(std::max(1, maxRays / std::max(1, depth)));
}

// Returns a number in [0, 1) that chooses among the rays of the surface that `path` has led to.
inline constexpr std::uint32_t kChoiceSalt = 0x2545f491u;
constexpr double choiceDraw(std::uint32_t path) {
  return static_cast<double>(mixed(path ^ kChoiceSalt)) * 0x1p-32;
}

}  // namespace whit
