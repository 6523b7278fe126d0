// Runs the catalogue of hard cases.
#pragma once

#include "cli/stress_report.h"
#include "core/progress.h"

namespace whit::cli {

// Every case of these names, or all for none, in each of the setups of this machine that it asks
// for. Changes the kernels' SIMD target.
std::vector<StressRow> runCatalogue(const std::vector<std::string>& only, Progress* progress);

}  // namespace whit::cli
