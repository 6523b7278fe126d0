#include "accuracy/report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

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

}  // namespace whit::accuracy
