// The catalogue of hard cases as `whit stress` runs it and tells of it: for people, for machines,
// and as a page.
#pragma once

#include <string>
#include <vector>

#include "cli/json_report.h"
#include "core/progress.h"
#include "stress/case.h"

namespace whit::cli {

struct StressRow {
  std::string_view family;
  const stress::Case* hardCase = nullptr;
  stress::Setup setup;
  stress::Finding finding;
};

// Every case of these names, or all for none, in each of the setups of this machine that it asks
// for. Changes the kernels' SIMD target.
std::vector<StressRow> runCatalogue(const std::vector<std::string>& only, Progress* progress);

// Of each case the row of the setup that came closest to its bound, in order.
std::vector<StressRow> worstRows(const std::vector<StressRow>& rows);

std::string stressTable(const std::vector<StressRow>& rows);
// Every row of every setup. `bound` and `margin` (bound less worst) are null where a case is only
// reported.
Json stressJson(const Machine& machine, const std::vector<StressRow>& rows);
// A <table> of the worst rows, to be embedded; and the same as a page of its own.
std::string stressHtmlTable(const std::vector<StressRow>& rows);
std::string stressHtml(const Machine& machine, const std::vector<StressRow>& rows);

}  // namespace whit::cli
