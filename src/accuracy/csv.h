// A sweep as rows of text, and such rows compared with earlier ones.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

// What was used to measure, the same for all points.
struct RunFacts {
  std::string cpu, compiler, commit;
  int cores = 1;
  std::uint32_t seed = 1;
  bool full = false;
};

// One row a point. Errors come in groups: total_ (against the truth), same_samples_, sampling_,
// algorithm_, arithmetic_ and transport_; those that were not measured are empty. Times are in
// milliseconds, shares in per cent.
std::string sweepCsv(const std::vector<SceneSweep>& sweeps, const RunFacts& facts);

using CsvRow = std::map<std::string, std::string>;
// Throws Error(badScene) "name:line: ..." for a row that has not as many fields as the header.
std::vector<CsvRow> parseCsv(const std::string& text, const std::string& name);

// How much an error may be above the one it is compared with.
struct GrowthTolerance {
  double relative = 0.1;
  double rmse = 1e-4, flip = 5e-4;
  double pixels = 2;  // for shares of pixels, in pixels
};

// What has grown in `now` over `before` beyond the tolerance, a line each; rows of `before` that
// were measured otherwise (size, reference) or are missing from `now` count as such. Times are not
// compared. Rows of knobs other than `knobs` (none: all) are left out.
std::vector<std::string> grownErrors(const std::vector<CsvRow>& before,
                                     const std::vector<CsvRow>& now,
                                     const std::vector<std::string>& knobs,
                                     const GrowthTolerance& tolerance = {});

}  // namespace whit::accuracy
