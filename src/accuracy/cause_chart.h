// The chart of what the errors of a scene's points consist of.
#pragma once

#include <string>
#include <vector>

#include "accuracy/chart_links.h"
#include "accuracy/measurement.h"

namespace whit::accuracy {

// The baseline, the presets and what is on the front of error over time, fastest first.
std::vector<const Point*> pointsByCause(const SceneSweep& sweep);

// As SVG, a row a point: a bar a cause, each in its color, of mean FLIP on a common scale from
// zero; none for a cause that was not measured. They do not add up to the whole error, which is a
// line across the row. A row links to its point's picture.
std::string causeSvg(const SceneSweep& sweep, const ChartLinks& links);

}  // namespace whit::accuracy
