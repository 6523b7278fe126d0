#include "accuracy/report.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "accuracy/findings.h"

namespace whit::accuracy {

namespace {

// The build turns report.html into a string literal.
constexpr std::string_view kTemplate =
#include "report_html.inc"
    ;

Json pointsJson(const SceneSweep& sweep, const RunFacts& facts) {
  Json points = sweepRows(sweep, facts);
  const std::vector<const Point*> chosen = chosenPoints(sweep);
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Point& point = sweep.points[i];
    points[i]["label"] = point.label();
    points[i]["chosen"] = std::find(chosen.begin(), chosen.end(), &point) != chosen.end();
    const auto addPicture = [&](const char* name, const std::string& png) {
      if (!png.empty()) points[i][name] = base64(png);
    };
    addPicture("image_png", point.imagePng);
    addPicture("total_map_png", point.totalMapPng);
    addPicture("same_samples_map_png", point.sameSamplesMapPng);
  }
  return points;
}

Json sceneJson(const SceneSweep& sweep, const RunFacts& facts) {
  const Noise noise = noiseOf(sweep);
  Json scene{{"scene", sweep.scene},
             {"width", sweep.width},
             {"height", sweep.height},
             {"packet", sweep.machine.packet},
             {"reference", referenceText(sweep)},
             {"noise_time", noise.time},
             {"noise_flip", noise.flip},
             {"visible_flip", kVisibleFlip},
             {"noisy_pct", kNoisyPct},
             {"least_rounds", kLeastRounds},
             {"findings", Json::array()},
             {"points", pointsJson(sweep, facts)},
             {"truth_png", base64(sweep.truthPng)},
             {"stages", stagesJson(sweep.stages)},
             {"not_swept", Json::array()},
             {"order", sweep.order}};
  if (sweep.transport) {
    scene["transport"] = transportText(sweep);
    scene["choice"] = choiceText(sweep);
  }
  for (const Finding& finding : findingsOf(sweep)) {
    scene["findings"].push_back(
        {{"holds", finding.holds}, {"claim", finding.claim}, {"found", finding.found}});
  }
  for (const IdleKnob& group : groupedByReason(sweep.idle))
    scene["not_swept"].push_back({{"names", group.name}, {"because", group.because}});
  return scene;
}

}  // namespace

Json stagesJson(const std::vector<StageDifference>& stages) {
  Json json = Json::array();
  for (const StageDifference& row : stages) {
    json.push_back({{"stage", kStageNames[static_cast<std::size_t>(row.stage)]},
                    {"column", row.column},
                    {"slots", row.slots},
                    {"worst_ulp", row.worstUlp},
                    {"limit_ulp", row.limitUlp},
                    {"pixel", Json::array({row.pixelX, row.pixelY})},
                    {"depth", row.depth}});
  }
  return json;
}

Json reportJson(const std::vector<SceneSweep>& sweeps, const RunFacts& facts) {
  Json report{{"report", "accuracy"}, {"scenes", Json::array()}};
  for (const SceneSweep& sweep : sweeps) report["scenes"].push_back(sceneJson(sweep, facts));
  return report;
}

std::string reportPage(const Json& data) {
  constexpr std::string_view kPlace = "{{data}}";
  const std::size_t place = kTemplate.find(kPlace);
  std::string page(kTemplate.substr(0, place));
  // Only strings hold a '<' in JSON. Escaped, it cannot end the element <script>.
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace))
    c == '<' ? page += "\\u003c" : page += c;
  return page.append(kTemplate.substr(place + kPlace.size()));
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace whit::accuracy
