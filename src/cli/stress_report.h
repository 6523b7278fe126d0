// The catalogue of hard cases as `whit stress` runs it and tells of it: for people, for machines,
// and as a page.
#pragma once

#include <string>
#include <vector>

#include "cli/json_report.h"
#include "core/image.h"
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

// Whether a row holds: "yes", "BROKEN", or "reported" where there is no bound. The last line is the
// summary: "205 cases in 3075 runs: 199 hold, 0 broken, 6 reported without a bound".
std::string stressTable(const std::vector<StressRow>& rows);
std::string stressSummary(const std::vector<StressRow>& rows);
// Every row of every setup. `bound` and `margin` (bound less worst) are null where a case is only
// reported.
Json stressJson(const Machine& machine, const std::vector<StressRow>& rows);
// A scene of scenes/hard as it is seen, in linear radiance.
struct StressPicture {
  std::string name;
  Image image;
};
// A <table> of the worst rows, to be embedded; and the same as a page of its own with summary and
// pictures.
std::string stressHtmlTable(const std::vector<StressRow>& rows);
std::string stressHtml(const Machine& machine, const std::vector<StressRow>& rows,
                       const std::vector<StressPicture>& pictures);

}  // namespace whit::cli
