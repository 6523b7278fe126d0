// A sweep as rows of named values, for CSV files and reports.
#pragma once

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

}  // namespace whit::accuracy
