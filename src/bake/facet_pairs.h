// Pairs of triangles that are near each other, found by cutting space where boxes lie side by side,
// again and again, until few of them are left in a part.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "bake/facet_space.h"

namespace whit {

enum class PairsOf {
  differentPlaces,  // all but those of triangles that one instance carries
  withMoving,       // those of them of which one moves
  asked,            // those of one that is asked for and one that is not
  all,
};

// By orderOf() of its triangles.
using FacetPair = std::pair<std::uint64_t, std::uint64_t>;

using FacetTest = bool (*)(const Facet& a, const Facet& b);

// Pairs of triangles of `blocks` that lie in one plane and pass the test, each once, in an order
// that does not depend on the number of threads. Ends early in parts of space where the work, for a
// scene of so many triangles, gets out of hand.
std::vector<FacetPair> findPairs(const FacetSpace& space, std::vector<BoxedBlock> blocks,
                                 PairsOf which, FacetTest test, std::uint64_t triangles,
                                 int threads);

}  // namespace whit
