// The results of a sweep: text for a terminal, rows for CSV files, and an HTML page that draws
// itself from JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

using Json = nlohmann::ordered_json;

// A table with a row for each point, and the points that were left out. No line has more than
// kTableColumns letters.
inline constexpr std::size_t kTableColumns = 100;
std::string sweepTable(const SceneSweep& sweep, std::uint32_t seed);
// One line about the scalar reference, and one about the picture with all transport, which is empty
// if that picture is not the truth.
std::string referenceText(const SceneSweep& sweep);
std::string transportText(const SceneSweep& sweep);

// An array of one object for each point, all with the same keys. Errors come in groups: total_
// (against the truth), same_samples_, sampling_, algorithm_, arithmetic_ and transport_; null was
// not measured. Times are in milliseconds, shares in per cent. All rows end with `facts`, which say
// with which machine and settings the run was made.
Json sweepRows(const SceneSweep& sweep, const Json& facts);

// The rows as CSV, with the keys of the first as header. Null is an empty field, true is "yes", and
// a number has seven digits.
std::string csvOf(const Json& rows);
std::string sweepCsv(const std::vector<SceneSweep>& sweeps, const Json& facts);

// The data of the report: {"report": "accuracy", "scenes": [...]}. The points of a scene are its
// rows of sweep.csv, with the label and the pictures as PNG files in base64.
Json reportJson(const std::vector<SceneSweep>& sweeps, const Json& facts);

// The page report.html with `data` in it; "report" of the data is "accuracy", "effects" or
// "verify". The page loads nothing from elsewhere.
std::string reportPage(const Json& data);
std::string base64(std::string_view bytes);

}  // namespace whit::accuracy
