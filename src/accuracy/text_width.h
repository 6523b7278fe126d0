// How wide a line of a chart's text is. Which font a reader has is not known when a chart is
// written: charts ask for the system's own.
#pragma once

#include <string_view>

namespace whit::accuracy {

enum class Weight { regular, bold };

// In the unit of `fontSize`, of UTF-8: as wide as in DejaVu Sans, the widest of the fonts that
// systems come with as their own.
double widthOf(std::string_view text, double fontSize, Weight weight);

}  // namespace whit::accuracy
