// What the charts of a sweep share: how they begin, and links to the pictures of points.
#pragma once

#include <string>

#include "accuracy/measurement.h"

namespace whit::accuracy {

// Charts are laid out for the width of a telephone; wider screens scale them up.
inline constexpr double kChartWidth = 480;

// An SVG image of that width up to its background, to be closed by "</svg>". `kind`: the class that
// the rules of `style` name; `title` is text.
std::string beginChart(const char* kind, double height, const char* style,
                       const std::string& title);

struct ChartLinks {
  std::size_t scene = 0;  // its number in the report
  std::string page;       // the report's file, seen from the chart; empty: the chart is within it
};

// The id of the point's picture, "s0-p3".
std::string pictureId(std::size_t scene, const SceneSweep& sweep, const Point& point);
// Whose picture shows the point: its own, the baseline's where that is the same; null where it was
// not kept.
const Point* pictureOf(const SceneSweep& sweep, const Point& point);

// "<a href="...">content</a>"; the content alone where there is no picture.
std::string linkToPicture(const ChartLinks& links, const SceneSweep& sweep, const Point& point,
                          const std::string& content);

}  // namespace whit::accuracy
