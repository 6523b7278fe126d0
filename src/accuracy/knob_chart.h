// The chart that a scene's report begins with: what each knob saves in time, and what it breaks.
#pragma once

#include <string>
#include <vector>

#include "accuracy/chart_links.h"
#include "accuracy/measurement.h"

namespace whit::accuracy {

// What a point changes against the baseline: negative is better.
struct Trade {
  double time = 0;   // share of the baseline's time: -0.3 is 30 % less
  double error = 0;  // mean FLIP against the reference
};
Trade tradeOf(const Point& point, const Point& baseline);

// What is too small to tell from no change at all: of times, half of the points are known no
// better; of errors, what rounding leaves in the baseline itself.
Trade noiseOf(const SceneSweep& sweep);

// More FLIP than that is called a visible change.
inline constexpr double kVisibleFlip = 0.01;

// The presets, then a point a knob, those that save most first: of its values the one that saves
// most without a visible change for the worse; where none saves time, the cheapest of those with
// the least error.
std::vector<const Point*> chosenPoints(const SceneSweep& sweep);
// Presets and all values of all knobs, in the sweep's order.
std::vector<const Point*> namedPoints(const SceneSweep& sweep);

// As SVG, a row a point: a bar of time and one of error from a common zero, better to the left and
// worse to the right, the noise in gray behind both, the time's interval as a line. Bars are cut at
// twice the time and at kFullFlip. A time without a spread is an outline. A row links to its
// point's picture.
inline constexpr double kFullFlip = 0.05;
std::string knobSvg(const SceneSweep& sweep, const std::vector<const Point*>& rows,
                    const ChartLinks& links);

}  // namespace whit::accuracy
