// The chart of a sweep, error over time, as SVG.
#pragma once

#include <string>

#include "accuracy/measurement.h"

namespace whit::accuracy {

enum class Against { reference, sameSamples };

// Mean FLIP over milliseconds, both logarithmic: the front joined, the other points gray, each with
// its label and, as a tooltip, its numbers. An error of 0 stands on a line of its own below the
// scale. Follows the reader's light or dark scheme. Stands alone as a file or within a page.
std::string paretoSvg(const SceneSweep& sweep, Against against);

// Text for XML content and attributes.
std::string escaped(const std::string& text);

}  // namespace whit::accuracy
