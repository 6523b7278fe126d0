// Reads the rows of a sweep.csv, and compares the errors of two sweeps.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "core/error.h"
#include "core/text.h"

namespace whit::accuracy {

using CsvRow = std::map<std::string, std::string>;

// An error has grown if it exceeds the earlier one by more than this.
struct GrowthTolerance {
  double relative = 0.1;
  double rmse = 1e-4, flip = 5e-4;
  double pixels = 2;  // how many pixels shares of pixels may grow by
};

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

inline std::string field(const CsvRow& row, const std::string& name) {
  const auto found = row.find(name);
  return found == row.end() ? std::string() : found->second;
}

// Two rows can be compared if their keys are equal: the same point, measured in the same way.
inline std::string keyOf(const CsvRow& row) {
  std::string key;
  for (const char* name : {"scene", "width", "height", "kind", "knob", "value"}) {
    key += field(row, name) + (std::string(name) == "width" ? "x" : " ");
  }
  if (field(row, "truth") == kTruthNames[1]) {
    key += "(all transport, " + field(row, "truth_samples") + " samples) ";
  }
  return key + "(reference of " + field(row, "reference_samples") + " samples, cutoff " +
         field(row, "reference_cutoff") + ")";
}

inline std::optional<double> numberIn(const CsvRow& row, const std::string& name) {
  const std::string text = field(row, name);
  if (text.empty()) return {};
  return std::stod(text);
}

inline void compareRows(const CsvRow& before, const CsvRow& now, const GrowthTolerance& tolerance,
                        std::vector<std::string>& grown) {
  const double pixels = numberIn(now, "width").value_or(1) * numberIn(now, "height").value_or(1);
  // Shares are percentages of the pixels.
  const double share = 100 * tolerance.pixels / pixels;

  const auto compare = [&](const std::string& name, double slack) {
    const std::optional<double> old = numberIn(before, name), fresh = numberIn(now, name);
    if (!old) return;

    const double limit = *old * (1 + tolerance.relative) + slack;
    if (fresh && *fresh <= limit) return;  // false for NaN, which counts as grown
    const std::string found = fresh ? field(now, name) : "missing";
    grown.push_back(keyOf(now) + ": " + name + " was " + field(before, name) + ", is " + found +
                    formatted(" (limit %.4g)", limit));
  };

  for (const char* group :
       {"total", "same_samples", "sampling", "algorithm", "arithmetic", "transport"}) {
    const std::string prefix = group;
    compare(prefix + "_rmse", tolerance.rmse);
    compare(prefix + "_flip", tolerance.flip);
    compare(prefix + "_ge1_pct", share);
    compare(prefix + "_ge2_pct", share);
  }
  compare("path_flips", tolerance.pixels);
  compare("nonfinite", 0);
}

// Throws Error(badScene) "name:line: ..." for a row with another number of fields than the header.
inline std::vector<CsvRow> parseCsv(const std::string& text, const std::string& name) {
  std::size_t at = 0;
  const std::vector<std::string> header = readLine(text, at);

  std::vector<CsvRow> rows;
  for (int line = 2; at < text.size(); ++line) {
    const std::vector<std::string> fields = readLine(text, at);
    if (fields.size() == 1 && fields[0].empty()) continue;
    if (fields.size() != header.size()) {
      throwBadScene(name + ":" + std::to_string(line), "expected " + std::to_string(header.size()) +
                                                           " fields as in the header, found " +
                                                           std::to_string(fields.size()));
    }

    CsvRow row;
    for (std::size_t i = 0; i < fields.size(); ++i) row[header[i]] = fields[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

// Returns a line for each error that has grown, and for each row of `before` that is missing from
// `now` or was measured with another size or reference. Times are not compared.
inline std::vector<std::string> grownErrors(const std::vector<CsvRow>& before,
                                            const std::vector<CsvRow>& now,
                                            const GrowthTolerance& tolerance = {}) {
  std::map<std::string, const CsvRow*> fresh;
  for (const CsvRow& row : now) fresh[keyOf(row)] = &row;

  std::vector<std::string> grown;
  for (const CsvRow& row : before) {
    const auto found = fresh.find(keyOf(row));
    if (found == fresh.end()) {
      grown.push_back(keyOf(row) + ": was not measured");
    } else {
      compareRows(row, *found->second, tolerance, grown);
    }
  }
  return grown;
}

}  // namespace whit::accuracy
