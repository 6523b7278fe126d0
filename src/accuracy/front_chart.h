// The chart of a scene's points, error over time, with its Pareto front.
#pragma once

#include <string>

#include "accuracy/chart_links.h"
#include "accuracy/measurement.h"

namespace whit::accuracy {

enum class Against { reference, sameSamples };

// As SVG: mean FLIP over milliseconds, both logarithmic: the front joined, the other points gray,
// those whose time has no spread as dashed rings, and above them how many these are. A point of the
// front whose time has a neighbor's within its spread is a ring, and the line between is dashed.
// What the truth differs from itself by, where it has noise, is a line across. Presets, the
// baseline and what is on the front have labels as far as there is place for them; every point
// tells its numbers as a tooltip and links to its picture. An error of 0 stands on a line of its
// own below the scale. Follows the reader's light or dark scheme. Stands alone as a file or within
// a page.
std::string frontSvg(const SceneSweep& sweep, Against against, const ChartLinks& links);

}  // namespace whit::accuracy
