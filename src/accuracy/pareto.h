// The Pareto fronts of a sweep: the points that no other beats in both time and error.
#pragma once

#include <cstddef>
#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

struct CostAndError {
  double cost = 0, error = 0;
};

// Indices of the points that no other point beats: none is at most as dear and at most as wrong,
// and better in one of the two. In order of cost; of equal points the first. Points that are not
// finite are never on the front.
std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points);

// Sets onFront, coversNeighbor and onFrontSameSamples. A point whose time has no spread is on no
// front, and beats none.
void markFronts(std::vector<Point>& points);

}  // namespace whit::accuracy
