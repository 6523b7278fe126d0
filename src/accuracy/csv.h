// A sweep as rows of named values, for CSV files and reports, and the comparison with the rows of
// an earlier sweep.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

using Json = nlohmann::ordered_json;

// An array of one object for each point, all with the same keys. Errors come in groups: total_
// (against the truth), same_samples_, sampling_, algorithm_, arithmetic_ and transport_; null was
// not measured. Times are in milliseconds, shares in per cent.
Json sweepRows(const SceneSweep& sweep, const RunFacts& facts);

// The rows as CSV, with the keys of the first as header. Null is an empty field, true is "yes", and
// a number has seven digits.
std::string csvOf(const Json& rows);
std::string sweepCsv(const std::vector<SceneSweep>& sweeps, const RunFacts& facts);

using CsvRow = std::map<std::string, std::string>;
// Throws Error(badScene) "name:line: ..." for a row with another number of fields than the header.
std::vector<CsvRow> parseCsv(const std::string& text, const std::string& name);

// An error has grown if it exceeds the earlier one by more than this.
struct GrowthTolerance {
  double relative = 0.1;
  double rmse = 1e-4, flip = 5e-4;
  double pixels = 2;  // for shares of pixels, in pixels
};

// A line for each error that has grown, and for each row of `before` that is missing from `now` or
// was measured with another size or reference. Times are not compared. If `knobs` names any knobs,
// the rows of all others are left out.
std::vector<std::string> grownErrors(const std::vector<CsvRow>& before,
                                     const std::vector<CsvRow>& now,
                                     const std::vector<std::string>& knobs,
                                     const GrowthTolerance& tolerance = {});

}  // namespace whit::accuracy
