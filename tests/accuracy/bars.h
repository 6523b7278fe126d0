// The bars of a knob chart, measured and held against the rows of its sweep.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "accuracy/csv.h"

namespace whit::accuracy {

// Signed lengths in units of the scale: -1 to 1, beyond for bars that are cut.
struct Bars {
  double time = 0, error = 0;
  bool outline = false;
};

// By the label of their row.
inline std::map<std::string, Bars> barsIn(const std::string& svg) {
  constexpr double kZero = 240, kUnit = 200;
  std::map<std::string, Bars> all;
  const std::regex row("<g data-point=\"([^\"]*)\">([^]*?)</g>");
  const std::regex rect(
      "<rect class=\"(t|t one|e)\" x=\"([^\"]*)\" y=\"[^\"]*\" width=\"([^\"]*)\"");
  const std::regex cut("<path class=\"(t|t one|e)\" d=\"M240 [^H]*H[^L]*L([^ ]*) ");
  for (std::sregex_iterator it(svg.begin(), svg.end(), row), end; it != end; ++it) {
    Bars& bars = all[(*it)[1]];
    const std::string content = (*it)[2];
    const auto put = [&](const std::string& kind, double units) {
      (kind == "e" ? bars.error : bars.time) = units;
      bars.outline |= kind == "t one";
    };
    for (std::sregex_iterator b(content.begin(), content.end(), rect); b != end; ++b) {
      const double left = std::stod((*b)[2]), width = std::stod((*b)[3]);
      EXPECT_TRUE(std::abs(left - kZero) < 0.01 || std::abs(left + width - kZero) < 0.02)
          << (*it)[1];
      put((*b)[1], (left < kZero - 0.005 ? -width : width) / kUnit);
    }
    for (std::sregex_iterator b(content.begin(), content.end(), cut); b != end; ++b)
      put((*b)[1], (std::stod((*b)[2]) - kZero) / kUnit);
  }
  return all;
}

// Each bar is as long as its row says, on its side: left of zero for less time and less error. Rows
// are of one scene, the baseline first; every bar has one. Returns the number of bars.
inline std::size_t expectBarsFollow(const std::string& svg, const std::vector<CsvRow>& rows) {
  constexpr double kPrinted = 1e-4;  // to a hundredth of 200; rows have seven digits
  const auto number = [](const CsvRow& row, const char* name) { return std::stod(row.at(name)); };
  const double baseFlip = number(rows.front(), "total_flip");
  std::map<std::string, const CsvRow*> byLabel;
  for (const CsvRow& row : rows) {
    const bool knob = row.at("kind") == "knob";
    byLabel[knob ? row.at("knob") + "=" + row.at("value") : row.at("value")] = &row;
  }
  const std::map<std::string, Bars> all = barsIn(svg);
  for (const auto& drawnBars : all) {  // no structured binding: Clang 14 lets no lambda capture one
    const std::string& label = drawnBars.first;
    const Bars& bars = drawnBars.second;
    const auto row = byLabel.find(label);
    if (row == byLabel.end()) {
      ADD_FAILURE() << label << " is in no row";
      continue;
    }
    const auto expectBar = [&](double drawn, double units, const char* what) {
      if (std::abs(units) > 1) {
        EXPECT_GT(drawn * units, 0) << label << ", " << what << ": the sign";
        EXPECT_GT(std::abs(drawn), 1) << label << ", " << what << ": cut";
      } else {
        EXPECT_NEAR(drawn, units, kPrinted) << label << ", " << what;
      }
    };
    expectBar(bars.time, number(*row->second, "x_baseline") - 1, "time");
    expectBar(bars.error, (number(*row->second, "total_flip") - baseFlip) / 0.05, "error");
    EXPECT_EQ(bars.outline, row->second->at("x_baseline_low").empty()) << label;
  }
  return all.size();
}

}  // namespace whit::accuracy
