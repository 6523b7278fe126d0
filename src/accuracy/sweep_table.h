// A sweep as a table of text, for people at a terminal.
#pragma once

#include <string>

#include "accuracy/measurement.h"

namespace whit::accuracy {

// A line about the scene, the machine and the reference; a row a point; what the causes are for the
// baseline; what was left out, and why.
std::string sweepTable(const SceneSweep& sweep, std::uint32_t seed);

// One line about the reference that everything is measured against.
std::string referenceText(const SceneSweep& sweep);

}  // namespace whit::accuracy
