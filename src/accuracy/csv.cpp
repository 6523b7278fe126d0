#include "accuracy/csv.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/formatted.h"
#include "core/option_table.h"

namespace whit::accuracy {

namespace {

// JSON has no number for what is not finite.
Json numberOf(double value) {
  return std::isfinite(value) ? Json(value) : Json(value > 0 ? "inf" : "nan");
}

template <typename Value>
Json orNull(bool known, const Value& value) {
  return known ? Json(value) : Json();
}

// Null: the difference was not measured.
void addDifference(Json& row, const std::string& group, const ImageDifference* d) {
  const auto add = [&](const char* name, double value) {
    row[group + name] = d ? numberOf(value) : Json();
  };
  const ImageDifference none, &e = d ? *d : none;
  add("_rmse", e.rmse);
  add("_relmse", e.relmse);
  add("_psnr_db", e.psnrDb);
  add("_flip", e.flipMean);
  add("_max_code", e.maxCode);
  add("_ge1_pct", e.pixelsGe1CodePct);
  add("_ge2_pct", e.pixelsGe2CodesPct);
  add("_energy", e.energyRatio);
}

void addTiming(Json& row, const Point& point) {
  const Timing& t = point.timing;
  row["frames"] = t.frames;
  row["median_ms"] = t.medianMs;
  row["least_ms"] = t.leastMs;
  row["rounds"] = t.rounds;
  row["x_baseline"] = numberOf(t.ratio);
  row["x_baseline_low"] = orNull(t.hasSpread(), t.ratioLow);
  row["x_baseline_high"] = orNull(t.hasSpread(), t.ratioHigh);
  row["noisy"] = t.noisy();
  row["settled_ms"] = numberOf(t.settledMs);
  for (std::size_t k = 0; k < kRayKindCount; ++k)
    row[std::string(kRayKinds[k].name) + "_rays"] = point.stats.meter.tally[k].rays;
}

void addErrors(Json& row, const Point& point) {
  addDifference(row, "total", &point.total);
  row["total_hdr_flip"] = numberOf(point.totalHdrFlip);
  addDifference(row, "same_samples", point.sameSamples ? &*point.sameSamples : nullptr);
  addDifference(row, "sampling", &point.sampling);
  addDifference(row, "algorithm", &point.algorithm);
  const ArithmeticError* const a = point.arithmetic ? &*point.arithmetic : nullptr;
  addDifference(row, "arithmetic", a ? &a->samePath : nullptr);
  addDifference(row, "transport", point.transport ? &*point.transport : nullptr);
  row["path_flips"] = a ? Json(a->divergences) : Json();
  row["path_flips_per_mpx"] = a ? numberOf(a->divergencesPerMpx) : Json();
  row["median_ulp"] = a ? numberOf(a->medianUlp) : Json();
  row["p999_ulp"] = a ? numberOf(a->ulp999) : Json();
  row["worst_ulp"] = a ? numberOf(a->worstUlp) : Json();
  row["nonfinite"] = point.total.nonFinite;
  row["front"] = point.onFront;
  row["covers_neighbor"] = point.coversNeighbor;
  row["front_same_samples"] = point.onFrontSameSamples;
}

void addRun(Json& row, const SceneSweep& sweep, const Point& point, const RunFacts& facts) {
  std::string options;
  for (const auto& [name, value] : pictureOptions(point.options)) {
    options += (options.empty() ? "" : " ") + name + "=" + value;
  }
  row["options"] = options;
  row["reference_samples"] = sweep.referenceSamples;
  row["reference_cutoff"] = static_cast<double>(sweep.referenceCutoff);
  row["reference_digest"] = sweep.referenceDigest;
  row["truth"] = kTruthNames[static_cast<std::size_t>(sweep.truth())];
  const bool known = sweep.transport.has_value();
  const TransportFacts t = sweep.transport.value_or(TransportFacts());
  row["truth_passes"] = orNull(known, t.passes);
  row["truth_samples"] = orNull(known, t.samples);
  row["truth_standard_error"] = orNull(known, t.standardError);
  row["truth_mean_radiance"] = orNull(known, t.meanRadiance);
  row["truth_noise_flip"] = orNull(known, t.noiseFlip);
  row["truth_digest"] = orNull(known, t.digest);
  row["sweep"] = facts.full ? "full" : "quick";
  row["seed"] = facts.seed;
  row["cpu"] = facts.cpu;
  row["cores"] = facts.cores;
  row["threads"] = sweep.machine.threads;
  row["simd"] = sweep.machine.simd;
  row["embree"] = sweep.machine.embree;
  row["compiler"] = facts.compiler;
  row["commit"] = facts.commit;
}

std::string fieldOf(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return formatted("%.7g", value.get<double>());
  if (!value.is_string()) return value.dump();
  const auto& text = value.get_ref<const std::string&>();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// Splits one line, whose fields may be quoted, and moves `at` behind its end.
std::vector<std::string> readLine(const std::string& text, std::size_t& at) {
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

std::string field(const CsvRow& row, const std::string& name) {
  const auto found = row.find(name);
  return found == row.end() ? std::string() : found->second;
}

// Two rows can be compared if their keys are equal: the same point, measured in the same way.
std::string keyOf(const CsvRow& row) {
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

std::optional<double> numberIn(const CsvRow& row, const std::string& name) {
  const std::string text = field(row, name);
  if (text.empty()) return {};
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0') throwBadScene(keyOf(row), name + ": expected a number, found '" + text + "'");
  return value;
}

void compareRows(const CsvRow& before, const CsvRow& now, const GrowthTolerance& tolerance,
                 std::vector<std::string>& grown) {
  const double pixels = numberIn(now, "width").value_or(1) * numberIn(now, "height").value_or(1);
  const double share = 100 * tolerance.pixels / pixels;
  const auto compare = [&](const std::string& name, double slack) {
    const std::optional<double> old = numberIn(before, name), fresh = numberIn(now, name);
    if (!old) return;
    const double limit = *old * (1 + tolerance.relative) + slack;
    if (fresh && *fresh <= limit) return;  // false for NaN, which counts as grown
    grown.push_back(keyOf(now) + ": " + name + " was " + field(before, name) + ", is " +
                    (fresh ? field(now, name) : "missing") + formatted(" (limit %.4g)", limit));
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

}  // namespace

Json sweepRows(const SceneSweep& sweep, const RunFacts& facts) {
  Json rows = Json::array();
  for (const Point& point : sweep.points) {
    Json row{{"scene", sweep.scene}, {"width", sweep.width}, {"height", sweep.height}};
    row["kind"] = kPointKindNames[static_cast<std::size_t>(point.kind)];
    row["knob"] = point.knob;
    row["value"] = point.value;
    row["cause"] = point.cause ? kCauseNames[static_cast<std::size_t>(*point.cause)] : "";
    addTiming(row, point);
    addErrors(row, point);
    addRun(row, sweep, point, facts);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string csvOf(const Json& rows) {
  std::string text;
  const auto addLine = [&](const Json& row, const auto& field) {
    std::string line;
    for (const auto& item : row.items()) line += "," + field(item);
    text += line.substr(std::min<std::size_t>(line.size(), 1)) + "\n";
  };
  if (rows.empty()) return text;
  addLine(rows.front(), [](const auto& item) { return item.key(); });
  for (const Json& row : rows) addLine(row, [](const auto& item) { return fieldOf(item.value()); });
  return text;
}

std::string sweepCsv(const std::vector<SceneSweep>& sweeps, const RunFacts& facts) {
  Json all = Json::array();
  for (const SceneSweep& sweep : sweeps) {
    for (Json& row : sweepRows(sweep, facts)) all.push_back(std::move(row));
  }
  return csvOf(all);
}

std::vector<CsvRow> parseCsv(const std::string& text, const std::string& name) {
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

std::vector<std::string> grownErrors(const std::vector<CsvRow>& before,
                                     const std::vector<CsvRow>& now,
                                     const std::vector<std::string>& knobs,
                                     const GrowthTolerance& tolerance) {
  std::map<std::string, const CsvRow*> fresh;
  std::vector<std::string> scenes;
  for (const CsvRow& row : now) {
    fresh[keyOf(row)] = &row;
    scenes.push_back(field(row, "scene"));
  }
  std::vector<std::string> grown;
  std::size_t compared = 0;
  for (const CsvRow& row : before) {
    if (std::find(scenes.begin(), scenes.end(), field(row, "scene")) == scenes.end()) continue;
    const bool knob = field(row, "kind") == "knob";
    const bool chosen = std::find(knobs.begin(), knobs.end(), field(row, "knob")) != knobs.end();
    if (knob && !knobs.empty() && !chosen) continue;
    const auto found = fresh.find(keyOf(row));
    if (found == fresh.end()) {
      grown.push_back(keyOf(row) + ": was not measured");
      continue;
    }
    ++compared;
    compareRows(row, *found->second, tolerance, grown);
  }
  if (compared == 0) grown.push_back("no row is about a point of this sweep: nothing to compare");
  return grown;
}

}  // namespace whit::accuracy
