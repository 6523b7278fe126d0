#include "accuracy/csv.h"

#include <cmath>

#include "core/formatted.h"

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
  csv.number("iqr_pct", t.iqrPct);
  csv.text("noisy", t.noisy() ? "yes" : "no");
  csv.number("x_baseline", t.ratio);
  csv.number("settled_ms", t.settledMs);
  for (std::size_t k = 0; k < kRayKindCount; ++k) {
    csv.text(std::string(kRayKindNames[k]) + "_rays", std::to_string(point.stats.meter.tally[k].rays));
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
  csv.text("front_same_samples", point.onFrontSameSamples ? "yes" : "no");
}

void writeRun(CsvWriter& csv, const SceneSweep& sweep, const Point& point, const RunFacts& facts) {
  std::string options;
  for (const auto& [name, value] : facts.describe(point.options)) {
    options += (options.empty() ? "" : " ") + name + "=" + value;
  }
  csv.text("options", options);
  csv.number("reference_samples", sweep.referenceSamples);
  csv.text("reference_cutoff", formatted("%g", static_cast<double>(sweep.referenceCutoff)));
  csv.text("reference_digest", sweep.referenceDigest);
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

}  // namespace whit::accuracy
