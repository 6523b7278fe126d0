// Sweeps as an HTML page.
#pragma once

#include <string>
#include <vector>

#include "accuracy/csv.h"
#include "accuracy/measurement.h"

namespace whit::accuracy {

// One self-contained HTML page: charts, pictures and tables of every scene, nothing loaded from
// anywhere. Light and dark as the reader has it; prints.
std::string reportHtml(const std::vector<SceneSweep>& sweeps, const RunFacts& facts);

}  // namespace whit::accuracy
