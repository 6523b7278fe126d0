// The Pareto front of a sweep, the points that no other beats in both time and error, and its
// chart.
#pragma once

#include <cstddef>
#include <string>
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

enum class Against { reference, sameSamples };

// As SVG: mean FLIP over milliseconds, both logarithmic: the front joined, the other points gray,
// each with its label and, as a tooltip, its numbers. An error of 0 stands on a line of its own
// below the scale. Follows the reader's light or dark scheme. Stands alone as a file or within a
// page.
std::string paretoSvg(const SceneSweep& sweep, Against against);

}  // namespace whit::accuracy
