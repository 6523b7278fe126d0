// Sweeps told to people: as text for a terminal, and as an HTML page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "accuracy/csv.h"
#include "accuracy/measurement.h"

namespace whit::accuracy {

// A line about the scene, the machine and the reference; what the columns are; a row a point; what
// the causes are for the baseline; what was left out, and why. No line has more than kTableColumns
// letters.
inline constexpr std::size_t kTableColumns = 100;
std::string sweepTable(const SceneSweep& sweep, std::uint32_t seed);
// What was left out, by reason: "depth=8, bvh" because "...".
std::vector<IdleKnob> groupedByReason(const std::vector<IdleKnob>& idle);
// One line about the scalar reference; and one about the picture with all transport, with its
// standard error, empty where that is not the truth.
std::string referenceText(const SceneSweep& sweep);
std::string transportText(const SceneSweep& sweep);

// One self-contained HTML page: charts, pictures and tables of every scene, nothing loaded from
// anywhere. Light and dark as the reader has it; prints.
std::string reportHtml(const std::vector<SceneSweep>& sweeps, const RunFacts& facts);

// The parts of the page.
extern const char* const kReportStyle;   // the content of <style>
extern const char* const kReportScript;  // the content of <script>
// "0.97 to 1.03", times the baseline; "one frame" where nothing is known of it.
std::string spreadText(const Timing& timing);
// One line: its label, time and errors.
std::string numbersOf(const Point& point);
std::string sceneSection(const SceneSweep& sweep, std::size_t number);
std::string verdictList(const SceneSweep& sweep);
std::string pointTable(const SceneSweep& sweep);
std::string causeTable(const SceneSweep& sweep);
std::string stageTable(const SceneSweep& sweep);

// "data:image/png;base64,..."
std::string dataUri(const std::string& png);
// Text for XML content and attributes.
std::string escaped(std::string_view text);

}  // namespace whit::accuracy
