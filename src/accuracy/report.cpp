#include "accuracy/report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "accuracy/reference_pictures.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/quantile.h"
#include "core/text.h"
#include "output/report_page.h"

namespace whit::accuracy {

namespace {

// Returns the number, or a word if it is not finite, which JSON has no number for.
Json numberOf(double value) {
  if (std::isfinite(value)) return value;
  return value > 0 ? "inf" : "nan";
}

template <typename Value>
Json orNull(bool known, const Value& value) {
  if (known) return value;
  return nullptr;
}

// Adds the measures of a difference. Null stands for one that was not measured.
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

  // Ratios to the baseline cancel the drift of the machine; an interval needs several rounds.
  row["rounds"] = t.rounds;
  row["x_baseline"] = numberOf(t.ratio);
  row["x_baseline_low"] = orNull(t.hasSpread(), t.ratioLow);
  row["x_baseline_high"] = orNull(t.hasSpread(), t.ratioHigh);
  row["noisy"] = t.noisy();
  row["steady_ms"] = numberOf(t.steadyMs);

  for (const auto k : indices(kRayKindCount))
    row[std::string(kRayKinds[k].name) + "_rays"] = point.stats.meter.tally[k].rays;
}

void addErrors(Json& row, const Point& point) {
  addDifference(row, "total", &point.total);
  addDifference(row, "same_samples", point.sameSamples ? &*point.sameSamples : nullptr);
  addDifference(row, "sampling", &point.sampling);
  addDifference(row, "algorithm", &point.algorithm);

  const ArithmeticError* const a = point.arithmetic ? &*point.arithmetic : nullptr;
  addDifference(row, "arithmetic", a ? &a->samePath : nullptr);
  addDifference(row, "transport", point.transport ? &*point.transport : nullptr);

  // Pixels whose path diverged are counted; the errors in ulps are those of the other pixels.
  row["path_flips"] = a ? Json(a->divergences) : Json();
  row["path_flips_per_mpx"] = a ? numberOf(a->divergencesPerMpx) : Json();
  row["median_ulp"] = a ? numberOf(a->medianUlp) : Json();
  row["p999_ulp"] = a ? numberOf(a->ulp999) : Json();
  row["worst_ulp"] = a ? numberOf(a->worstUlp) : Json();

  row["nonfinite"] = point.total.nonFinite;
  row["front"] = point.onFront;
  row["front_same_samples"] = point.onFrontSameSamples;
}

void addRun(Json& row, const SceneSweep& sweep, const Point& point, const Json& facts) {
  std::string options;
  for (const auto& [name, value] : pictureOptions(point.options)) {
    options += (options.empty() ? "" : " ") + name + "=" + value;
  }

  row["options"] = options;
  row["reference_samples"] = sweep.referenceSamples;
  row["reference_cutoff"] = double{sweep.referenceCutoff};
  row["truth"] = entryOf(kTruthNames, sweep.truth());

  // The columns of the picture with all transport are null if Whitted's model is the truth.
  const bool known = sweep.transport.has_value();
  const TransportFacts t = sweep.transport.value_or(TransportFacts());
  row["truth_passes"] = orNull(known, t.passes);
  row["truth_samples"] = orNull(known, t.samples);
  row["truth_standard_error"] = orNull(known, t.standardError);
  row["truth_mean_radiance"] = orNull(known, t.meanRadiance);
  row["truth_noise_flip"] = orNull(known, t.noiseFlip);
  row.update(facts);
}

// An array of one object for each point, all with the same keys.
Json sweepRows(const SceneSweep& sweep, const Json& facts) {
  Json rows = Json::array();
  for (const Point& point : sweep.points) {
    Json row{{"scene", sweep.scene}, {"width", sweep.width}, {"height", sweep.height}};
    row["kind"] = entryOf(kPointKindNames, point.kind);
    row["knob"] = point.knob;
    row["value"] = point.value;
    row["cause"] = point.cause ? entryOf(kCauseNames, *point.cause) : "";

    addTiming(row, point);
    addErrors(row, point);
    addRun(row, sweep, point, facts);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string referenceText(const SceneSweep& sweep) {
  return formatted(
      "reference: scalar, double precision, depth %d, cutoff %g, %d samples a pixel, "
      "%.1f s",
      kDepthLimit, double{sweep.referenceCutoff}, sweep.referenceSamples, sweep.referenceMs / 1e3);
}

Json pointsJson(const SceneSweep& sweep, const Json& facts) {
  Json points = sweepRows(sweep, facts);
  for (const auto i : indices(sweep.points)) {
    const Point& point = sweep.points[i];
    points[i]["label"] = point.label();
    const auto addPicture = [&](const char* name, const std::string& png) {
      if (!png.empty()) points[i][name] = base64(png);
    };
    addPicture("image_png", point.imagePng);
    addPicture("total_map_png", point.totalMapPng);
    addPicture("same_samples_map_png", point.sameSamplesMapPng);
  }
  return points;
}

// A larger increase of FLIP is called visible.
constexpr double kVisibleFlip = 0.01;

Json sceneJson(const SceneSweep& sweep, const Json& facts) {
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
             {"points", pointsJson(sweep, facts)},
             {"truth_png", base64(sweep.truthPng)},
             {"not_swept", Json::array()},
             {"order", sweep.order}};

  if (sweep.transport) scene["transport"] = transportText(sweep);
  for (const IdleKnob& group : groupedByReason(sweep.idle))
    scene["not_swept"].push_back({{"names", group.name}, {"because", group.because}});
  return scene;
}

// Longer labels, which combinations have, get a line of their own.
constexpr std::size_t kLongestLabel = 25;

constexpr const char* kWords =
    "FLIP: how visible a difference from the truth is, 0 to 1. RMSE: root of the mean squared "
    "difference of linear radiance. Off: share of the pixels that differ by a step of an 8-bit "
    "sRGB "
    "channel or more. The last two columns are against the exact picture with as many samples a "
    "pixel. +-: half the interval that holds the median time with 90 % confidence.";

std::string wrapped(const std::string& text) { return whit::wrapped(text, 0, 2, kTableColumns); }

// Frames of microseconds on a busy machine have spreads and ratios beyond any column.
constexpr double kLargest = 9999;

std::string spreadCell(const Point& point) {
  const Timing& t = point.timing;
  if (!t.hasSpread()) return "? ";
  const double pct = t.spreadPct();
  const int decimals = pct < 10 ? 1 : 0;
  const std::string number = pct <= kLargest ? formatted("%.*f", decimals, pct) : ">1e4";
  return number + (t.noisy() ? "~" : " ");
}

// The rows below have these columns.
std::string headOf(std::size_t labelWidth) {
  return "\n" + std::string(labelWidth + 1, ' ') +
         formatted("%9s%6s%7s%9s%9s%8s%8s%9s%8s\n", "ms", "+-% ", "x base", "krays", "FLIP", "RMSE",
                   "off %", "FLIP", "off %");
}

std::string rowOf(const Point& point, std::size_t labelWidth) {
  std::string label = point.label(), row;
  // A label that is too long gets a line of its own, and the columns follow on the next line.
  if (label.size() > labelWidth) {
    row = wrapped(label);
    label.clear();
  }
  label.resize(labelWidth, ' ');

  const Timing& t = point.timing;
  const double rays = static_cast<double>(point.stats.allRays());
  row += label + (point.onFront ? "*" : " ");
  row += formatted("%9.2f%6s", t.steadyMs, spreadCell(point).c_str());
  row += t.ratio <= kLargest ? formatted("%7.2f", t.ratio) : formatted("%7.1e", t.ratio);
  row += formatted("%9.*f%9.5f%8.1e%8.2f", rays < 1e6 ? 1 : 0, rays / 1e3, point.total.flipMean,
                   point.total.rmse, point.total.pixelsGe1CodePct);

  // The last columns compare with the exact picture at equal samples, which may not exist.
  if (!point.sameSamples) return row + formatted("%9s%8s\n", "-", "-");
  return row + formatted("%9.5f%8.3f\n", point.sameSamples->flipMean,
                         point.sameSamples->pixelsGe1CodePct);
}

}  // namespace

std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order;
  for (const auto i : indices(points)) {
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  }

  // In order of cost, and of error among equal costs, every point comes after all that could
  // dominate it.
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
    return points[a].error < points[b].error;
  });

  // A point is on the front if its error is below the errors of all points before it.
  std::vector<std::size_t> front;
  double least = kInfinity;
  for (const std::size_t i : order) {
    if (points[i].error >= least) continue;
    least = points[i].error;
    front.push_back(i);
  }
  return front;
}

void markFronts(std::vector<Point>& points) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<CostAndError> total, same;

  for (Point& point : points) {
    point.onFront = point.onFrontSameSamples = false;
    const double ms = point.timing.hasSpread() ? point.timing.steadyMs : kNone;
    total.push_back({ms, point.total.flipMean});
    same.push_back({ms, point.sameSamples ? point.sameSamples->flipMean : kNone});
  }

  for (const std::size_t i : paretoFront(total)) points[i].onFront = true;
  for (const std::size_t i : paretoFront(same)) points[i].onFrontSameSamples = true;
}

Noise noiseOf(const SceneSweep& sweep) {
  std::vector<double> spreads;
  for (const Point& point : sweep.points) {
    if (point.kind != PointKind::baseline && point.timing.hasSpread())
      spreads.push_back(point.timing.spreadPct() / 100);
  }

  const auto& rounding = sweep.points.front().sameSamples;
  return {quantile(spreads, 0.5), rounding ? rounding->flipMean : 0};
}

std::vector<IdleKnob> groupedByReason(const std::vector<IdleKnob>& idle) {
  std::vector<IdleKnob> groups;
  for (const IdleKnob& knob : idle) {
    const auto same = [&](const IdleKnob& group) { return group.because == knob.because; };
    const auto group = std::ranges::find_if(groups, same);
    if (group == groups.end()) {
      groups.push_back(knob);
    } else {
      group->name += ", " + knob.name;
    }
  }
  return groups;
}

std::string sweepCsv(const std::vector<SceneSweep>& sweeps, const Json& facts) {
  Json all = Json::array();
  for (const SceneSweep& sweep : sweeps) {
    for (Json& row : sweepRows(sweep, facts)) all.push_back(std::move(row));
  }
  return csvOf(all);
}

Json reportJson(const std::vector<SceneSweep>& sweeps, const Json& facts) {
  Json report{{"report", "accuracy"}, {"scenes", Json::array()}};
  for (const SceneSweep& sweep : sweeps) report["scenes"].push_back(sceneJson(sweep, facts));
  return report;
}

std::string transportText(const SceneSweep& sweep) {
  if (!sweep.transport) return {};
  const TransportFacts& t = *sweep.transport;

  std::string text = formatted(
      "truth: all transport, by packets, depth %d, cutoff %g, %d samples a pixel in %d independent "
      "passes, %.1f s; standard error of a pixel, root mean square: %.2e",
      kDepthLimit, double{kTransportCutoff}, t.samples, t.passes, t.renderMs / 1e3,
      t.standardError);
  if (t.meanRadiance > 0)
    text += formatted(", %.2g %% of the mean radiance", 100 * t.standardError / t.meanRadiance);
  text += formatted("; half of its passes differ from the others by a FLIP of %.4f", t.noiseFlip);

  const auto& arithmetic = sweep.points.front().arithmetic;
  if (arithmetic) text += formatted("; single precision is off by %.1e", arithmetic->samePath.rmse);
  return text;
}

std::string sweepTable(const SceneSweep& sweep, std::uint32_t seed) {
  std::size_t width = 12;
  for (const Point& point : sweep.points) {
    if (point.label().size() <= kLongestLabel) width = std::max(width, point.label().size());
  }

  std::string text =
      wrapped(formatted("%s, %dx%d, %d thread%s, %s, Embree %s", sweep.scene.c_str(), sweep.width,
                        sweep.height, sweep.machine.threads, sweep.machine.threads == 1 ? "" : "s",
                        sweep.machine.simd.c_str(), sweep.machine.embree.c_str()));
  text += wrapped(referenceText(sweep));
  if (sweep.transport) text += wrapped(transportText(sweep));
  text += wrapped(kWords);
  text += headOf(width);
  for (const Point& point : sweep.points) text += rowOf(point, width);

  text += wrapped(formatted("* on the front of FLIP over time; ~ noisy: not known within %g %%; ? "
                            "fewer than %d rounds, and therefore on no front; measured in random "
                            "order, seed %u; the errors by cause are in report.html",
                            kNoisyPct, kLeastRounds, seed)) +
          "\n";

  for (const IdleKnob& group : groupedByReason(sweep.idle))
    text += wrapped("not swept: " + group.name + ": " + group.because);
  return text;
}

}  // namespace whit::accuracy
