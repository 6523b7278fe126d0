// Conclusions from the results of a sweep (Pareto fronts, the noise), and the results as text for a
// terminal, rows for CSV files, and data for the page of reports.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

// Returns the indices of the Pareto front, in order of cost: no other point has at most the same
// cost and at most the same error, and less of one of them. The first of several equal points
// represents them. Points that are not finite are never on the front.
std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points);

// Sets onFront and onFrontSameSamples. Points whose time has no spread are left out.
void markFronts(std::vector<Point>& points);

// Changes against the baseline that are smaller than this cannot be told from no change.
struct Noise {
  double time = 0;  // the median spread of the times, as a share of the baseline's time
  double flip = 0;  // the error that rounding leaves in the baseline
};
Noise noiseOf(const SceneSweep& sweep);

// Returns one entry for each reason, with the names of all that were left out for it: "depth=8,
// bvh".
std::vector<IdleKnob> groupedByReason(const std::vector<IdleKnob>& idle);

using Json = nlohmann::ordered_json;

// Returns a table with a row for each point, and the points that were left out. No line has more
// than kTableColumns letters.
inline constexpr std::size_t kTableColumns = 100;
std::string sweepTable(const SceneSweep& sweep, std::uint32_t seed);
// Returns one line about the picture with all transport; empty if that picture is not the truth.
std::string transportText(const SceneSweep& sweep);

// Returns a row for each point. Errors come in groups: total_ (against the truth), same_samples_,
// sampling_, algorithm_, arithmetic_ and transport_; null was not measured. Times are in
// milliseconds, shares in per cent. All rows end with `facts`, which say with which machine and
// settings the run was made.
std::string sweepCsv(const std::vector<SceneSweep>& sweeps, const Json& facts);

// Returns the data of the report: {"report": "accuracy", "scenes": [...]}. The points of a scene
// are its rows of sweep.csv, with the label and the pictures as PNG files in base64.
Json reportJson(const std::vector<SceneSweep>& sweeps, const Json& facts);

}  // namespace whit::accuracy
