// A made-up sweep, and the rows of a sweep.csv, whose errors are compared with those of another
// one.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/report.h"
#include "core/text.h"

namespace whit::accuracy {

using CsvRow = std::map<std::string, std::string>;

// Splits one line, whose fields may be quoted, and moves `at` behind its end.
inline std::vector<std::string> readLine(const std::string& text, std::size_t& at) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quoted) {
      if (c != '"') {
        fields.back() += c;
      } else if (at + 1 < text.size() && text[at + 1] == '"') {
        fields.back() += '"';
        ++at;
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      fields.emplace_back();
    } else if (c == '\n') {
      ++at;
      break;
    } else if (c != '\r') {
      fields.back() += c;
    }
  }

  return fields;
}

// Two rows can be compared if their keys are equal: the same point, measured in the same way.
inline std::string keyOf(const CsvRow& row) {
  std::string key;
  for (const char* name : {"scene", "width", "height", "kind", "knob", "value", "truth",
                           "truth_samples", "reference_samples", "reference_cutoff"}) {
    const std::string& text = row.at(name);
    if (!text.empty()) key += std::string(key.empty() ? "" : ", ") + name + " " + text;
  }
  return key;
}

inline std::optional<double> numberIn(const CsvRow& row, const std::string& name) {
  const std::string& text = row.at(name);
  if (text.empty()) return {};
  return std::stod(text);
}

inline void compareRows(const CsvRow& before, const CsvRow& now, std::vector<std::string>& grown) {
  // An error has grown if it exceeds the earlier one by more than this share of it, and by more
  // than a slack for each kind of error.
  constexpr double kRelative = 0.1, kRmse = 1e-4, kFlip = 5e-4, kPixels = 2;
  const auto compare = [&](const std::string& name, double slack) {
    const std::optional<double> old = numberIn(before, name), fresh = numberIn(now, name);
    if (!old) return;

    const double limit = *old * (1 + kRelative) + slack;
    if (fresh && *fresh <= limit) return;  // false for NaN, which counts as grown
    const std::string found = fresh ? now.at(name) : "missing";
    grown.push_back(keyOf(now) + ": " + name + " was " + before.at(name) + ", is " + found +
                    formatted(" (limit %.4g)", limit));
  };

  // Shares are percentages of the pixels.
  const double share = 100 * kPixels / (*numberIn(now, "width") * *numberIn(now, "height"));
  for (const std::string group :
       {"total", "same_samples", "sampling", "algorithm", "arithmetic", "transport"}) {
    compare(group + "_rmse", kRmse);
    compare(group + "_flip", kFlip);
    compare(group + "_ge1_pct", share);
    compare(group + "_ge2_pct", share);
  }
  compare("path_flips", kPixels);
  compare("nonfinite", 0);
}

// Expects that each row has as many fields as the header.
inline std::vector<CsvRow> parseCsv(const std::string& text, const std::string& name) {
  std::size_t at = 0;
  const std::vector<std::string> header = readLine(text, at);

  std::vector<CsvRow> rows;
  for (int line = 2; at < text.size(); ++line) {
    const std::vector<std::string> fields = readLine(text, at);
    if (fields.size() == 1 && fields[0].empty()) continue;
    EXPECT_EQ(fields.size(), header.size()) << name << ":" << line;

    CsvRow& row = rows.emplace_back();
    for (const auto i : indices(header)) row[header[i]] = fields.at(i);
  }
  return rows;
}

// Returns a line for each error that has grown, and for each row of `before` that is missing from
// `now` or was measured with another size or reference. Times are not compared.
inline std::vector<std::string> grownErrors(const std::vector<CsvRow>& before,
                                            const std::vector<CsvRow>& now) {
  std::map<std::string, const CsvRow*> fresh;
  for (const CsvRow& row : now) fresh[keyOf(row)] = &row;

  std::vector<std::string> grown;
  for (const CsvRow& row : before) {
    const auto found = fresh.find(keyOf(row));
    if (found == fresh.end()) {
      grown.push_back(keyOf(row) + ": was not measured");
    } else {
      compareRows(row, *found->second, grown);
    }
  }
  return grown;
}

// A sweep of three points of 10x10 pixels whose times and errors are easy to recognize.
inline SceneSweep madeUpSweep() {
  SceneSweep sweep;
  sweep.scene = "a<b & \"c\" </script>";
  sweep.width = sweep.height = 10;
  sweep.referenceSamples = 64;
  sweep.truthPng = "png";
  sweep.idle = {{"fresnel", "nothing in the scene is transparent"}};

  struct Row {
    const char *knob, *value;
    double ms, rmse, flip;
  };
  for (const Row& row : {Row{"", "standard", 10, 0.25, 0.02}, Row{"depth", "2", 8, 0.5, 0.03},
                         Row{"depth", "16", 12, 0.375, 0.025}}) {
    Point& point = sweep.points.emplace_back();
    point.knob = row.knob;
    point.value = row.value;
    point.timing.steadyMs = row.ms;
    point.timing.frames = point.timing.rounds = 9;
    point.timing.ratio = point.timing.ratioLow = point.timing.ratioHigh = row.ms / 10;
    point.total.rmse = row.rmse;
    point.total.flipMean = row.flip;
    point.imagePng = point.totalMapPng = "png";
  }

  Point& base = sweep.points[0];
  base.kind = PointKind::baseline;
  base.onFront = true;
  base.total.psnrDb = kInfinity;
  base.sameSamples.emplace();
  base.sameSamplesMapPng = "png";

  Point& depth = sweep.points[1];
  depth.cause = Cause::algorithm;
  depth.onFront = true;
  depth.options.depth = 2;
  depth.total.pixelsGe1CodePct = 30;
  depth.arithmetic.emplace().divergences = 3;
  return sweep;
}

// The truth of a sweep against all transport.
inline const TransportFacts kTransport{8, 512, 0.002, 0.5, 0.0123, 4000};

}  // namespace whit::accuracy
