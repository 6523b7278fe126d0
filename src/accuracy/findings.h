// Conclusions from the results of a sweep: Pareto fronts, the point to choose, the noise.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

struct CostAndError {
  double cost = 0, error = 0;
};

// Indices of the Pareto front, in order of cost: no other point has at most the same cost and at
// most the same error, and less of one of them. The first of several equal points represents them.
// Points that are not finite are never on the front.
std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points);

// Sets onFront and onFrontSameSamples. Points whose time has no spread are left out.
void markFronts(std::vector<Point>& points);

// Frame times that the report gives a choice for: a game, a preview, a still, a long wait.
inline constexpr std::array kChoiceMs{16.0, 100.0, 1000.0, 10000.0};

// The point with the least error against the truth whose time, including its spread, is within
// `ms`; the fastest of equal errors; null if there is none.
const Point* bestWithin(const SceneSweep& sweep, double ms);

// One sentence: "whitted at 256x256 pixels: in 16 ms choose draft (FLIP 0.0812), in 100 ms ...".
std::string choiceText(const SceneSweep& sweep);

// Smaller changes against the baseline cannot be told from none.
struct Noise {
  double time = 0;  // the median spread of the times, as a share of the baseline's time
  double flip = 0;  // the error that rounding leaves in the baseline
};
Noise noiseOf(const SceneSweep& sweep);

// A larger increase of FLIP is called visible.
inline constexpr double kVisibleFlip = 0.01;

// One entry for each reason, with the names of all that were left out for it: "depth=8, bvh".
std::vector<IdleKnob> groupedByReason(const std::vector<IdleKnob>& idle);

}  // namespace whit::accuracy
