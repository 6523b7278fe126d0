#include "accuracy/csv.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/error.h"
#include "core/formatted.h"
#include "core/option_table.h"

namespace whit::accuracy {

namespace {

// Rows of fields that all name their column; the header follows from the first row.
class CsvWriter {
 public:
  void text(const std::string& name, const std::string& value) {
    if (first_) header_ += (header_.empty() ? "" : ",") + name;
    if (!row_.empty() || begun_) row_ += ',';
    begun_ = true;
    row_ += quoted(value);
  }
  void number(const std::string& name, double value) {
    text(name, std::isfinite(value) ? formatted("%.7g", value) : value > 0 ? "inf" : "nan");
  }
  void end() {
    rows_ += row_ + "\n";
    row_.clear();
    first_ = begun_ = false;
  }
  std::string all() const { return header_ + "\n" + rows_; }

 private:
  static std::string quoted(const std::string& value) {
    if (value.find_first_of(",\"\n") == std::string::npos) return value;
    std::string text = "\"";
    for (const char c : value) text += c == '"' ? std::string("\"\"") : std::string(1, c);
    return text + "\"";
  }

  std::string header_, rows_, row_;
  bool first_ = true, begun_ = false;
};

void writeDifference(CsvWriter& csv, const std::string& group, const ImageDifference* d) {
  const auto put = [&](const char* name, double value) {
    if (d) {
      csv.number(group + name, value);
    } else {
      csv.text(group + name, "");
    }
  };
  const ImageDifference none, &e = d ? *d : none;
  put("_rmse", e.rmse);
  put("_relmse", e.relmse);
  put("_psnr_db", e.psnrDb);
  put("_flip", e.flipMean);
  put("_max_code", e.maxCode);
  put("_ge1_pct", e.pixelsGe1CodePct);
  put("_ge2_pct", e.pixelsGe2CodesPct);
  put("_energy", e.energyRatio);
}

void writeTiming(CsvWriter& csv, const Point& point) {
  const Timing& t = point.timing;
  csv.number("frames", t.frames);
  csv.number("median_ms", t.medianMs);
  csv.number("least_ms", t.leastMs);
  csv.number("rounds", t.rounds);
  csv.number("x_baseline", t.ratio);
  const auto bound = [&](const char* name, double value) {
    csv.text(name, t.hasSpread() ? formatted("%.7g", value) : "");
  };
  bound("x_baseline_low", t.ratioLow);
  bound("x_baseline_high", t.ratioHigh);
  csv.text("noisy", t.noisy() ? "yes" : "no");
  csv.number("settled_ms", t.settledMs);
  for (std::size_t k = 0; k < kRayKindCount; ++k) {
    csv.text(std::string(kRayKinds[k].name) + "_rays",
             std::to_string(point.stats.meter.tally[k].rays));
  }
}

void writeErrors(CsvWriter& csv, const Point& point) {
  writeDifference(csv, "total", &point.total);
  csv.number("total_hdr_flip", point.totalHdrFlip);
  writeDifference(csv, "same_samples", point.sameSamples ? &*point.sameSamples : nullptr);
  writeDifference(csv, "sampling", &point.sampling);
  writeDifference(csv, "algorithm", &point.algorithm);
  const ArithmeticError* a = point.arithmetic ? &*point.arithmetic : nullptr;
  writeDifference(csv, "arithmetic", a ? &a->samePath : nullptr);
  writeDifference(csv, "transport", point.transport ? &*point.transport : nullptr);
  const auto optional = [&](const char* name, double value) {
    csv.text(name, a ? formatted("%.6g", value) : "");
  };
  optional("path_flips", a ? static_cast<double>(a->divergences) : 0);
  optional("path_flips_per_mpx", a ? a->divergencesPerMpx : 0);
  optional("median_ulp", a ? a->medianUlp : 0);
  optional("p999_ulp", a ? a->ulp999 : 0);
  optional("worst_ulp", a ? a->worstUlp : 0);
  csv.text("nonfinite", std::to_string(point.total.nonFinite));
  csv.text("front", point.onFront ? "yes" : "no");
  csv.text("covers_neighbor", point.coversNeighbor ? "yes" : "no");
  csv.text("front_same_samples", point.onFrontSameSamples ? "yes" : "no");
}

void writeTruth(CsvWriter& csv, const SceneSweep& sweep) {
  csv.text("truth", kTruthNames[static_cast<std::size_t>(sweep.truth())]);
  const TransportFacts* t = sweep.transport ? &*sweep.transport : nullptr;
  const auto put = [&](const char* name, double value) {
    csv.text(name, t ? formatted("%.7g", value) : "");
  };
  put("truth_passes", t ? t->passes : 0);
  put("truth_samples", t ? t->samples : 0);
  put("truth_standard_error", t ? t->standardError : 0);
  put("truth_mean_radiance", t ? t->meanRadiance : 0);
  put("truth_noise_flip", t ? t->noiseFlip : 0);
  csv.text("truth_digest", t ? t->digest : "");
}

void writeRun(CsvWriter& csv, const SceneSweep& sweep, const Point& point, const RunFacts& facts) {
  std::string options;
  for (const auto& [name, value] : pictureOptions(point.options)) {
    options += (options.empty() ? "" : " ") + name + "=" + value;
  }
  csv.text("options", options);
  csv.number("reference_samples", sweep.referenceSamples);
  csv.text("reference_cutoff", formatted("%g", static_cast<double>(sweep.referenceCutoff)));
  csv.text("reference_digest", sweep.referenceDigest);
  writeTruth(csv, sweep);
  csv.text("sweep", facts.full ? "full" : "quick");
  csv.number("seed", facts.seed);
  csv.text("cpu", facts.cpu);
  csv.number("cores", facts.cores);
  csv.number("threads", sweep.machine.threads);
  csv.text("simd", sweep.machine.simd);
  csv.text("embree", sweep.machine.embree);
  csv.text("compiler", facts.compiler);
  csv.text("commit", facts.commit);
}

// Splits one line that may hold quoted fields; `at` moves behind its end.
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

// What must agree for two rows to be about the same point, measured alike.
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
    if (fresh && *fresh <= limit) return;  // written so that a NaN has grown
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

std::string sweepCsv(const std::vector<SceneSweep>& sweeps, const RunFacts& facts) {
  CsvWriter csv;
  for (const SceneSweep& sweep : sweeps) {
    for (const Point& point : sweep.points) {
      csv.text("scene", sweep.scene);
      csv.number("width", sweep.width);
      csv.number("height", sweep.height);
      csv.text("kind", kPointKindNames[static_cast<std::size_t>(point.kind)]);
      csv.text("knob", point.knob);
      csv.text("value", point.value);
      csv.text("cause", point.cause ? kCauseNames[static_cast<std::size_t>(*point.cause)] : "");
      writeTiming(csv, point);
      writeErrors(csv, point);
      writeRun(csv, sweep, point, facts);
      csv.end();
    }
  }
  return csv.all();
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
