// The results of a sweep as text for a terminal.
#include <algorithm>
#include <array>

#include "accuracy/findings.h"
#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

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
  return (pct <= kLargest ? formatted("%.*f", pct < 10 ? 1 : 0, pct) : ">1e4") +
         (t.noisy() ? "~" : " ");
}

std::string thousandRays(const Point& point) {
  double rays = 0;
  for (const RayTally& tally : point.stats.meter.tally) rays += static_cast<double>(tally.rays);
  return formatted(rays < 1e6 ? "%.1f" : "%.0f", rays / 1e3);
}

struct Column {
  const char* title;
  int width;  // including the space before it
  std::string (*cell)(const Point& point);
};

constexpr std::array kColumns{
    Column{"ms", 9, [](const Point& p) { return formatted("%.2f", p.timing.settledMs); }},
    Column{"+-% ", 6, spreadCell},
    Column{"x base", 7,
           [](const Point& p) {
             const double ratio = p.timing.ratio;
             return formatted(ratio <= kLargest ? "%.2f" : "%.1e", ratio);
           }},
    Column{"krays", 9, thousandRays},
    Column{"FLIP", 9, [](const Point& p) { return formatted("%.5f", p.total.flipMean); }},
    Column{"RMSE", 8, [](const Point& p) { return formatted("%.1e", p.total.rmse); }},
    Column{"off %", 8, [](const Point& p) { return formatted("%.2f", p.total.pixelsGe1CodePct); }},
    Column{"FLIP", 9,
           [](const Point& p) {
             return p.sameSamples ? formatted("%.5f", p.sameSamples->flipMean) : "-";
           }},
    Column{"off %", 8, [](const Point& p) {
             return p.sameSamples ? formatted("%.3f", p.sameSamples->pixelsGe1CodePct) : "-";
           }}};

std::string rowOf(const Point& point, std::size_t labelWidth) {
  std::string label = point.label(), row;
  if (label.size() > labelWidth) {
    row = wrapped(label);
    label.clear();
  }
  label.resize(labelWidth, ' ');
  row += label + (point.onFront ? "*" : " ");
  for (const Column& c : kColumns) row += formatted("%*s", c.width, c.cell(point).c_str());
  return row + "\n";
}

}  // namespace

std::string referenceText(const SceneSweep& sweep) {
  return formatted(
      "reference: scalar, double precision, depth %d, cutoff %g, %d samples a pixel, "
      "%.1f s%s, %.8s",
      kDepthLimit, static_cast<double>(sweep.referenceCutoff), sweep.referenceSamples,
      sweep.referenceMs / 1e3, sweep.referenceFromFile ? " (by an earlier run)" : "",
      sweep.referenceDigest.c_str());
}

std::string transportText(const SceneSweep& sweep) {
  if (!sweep.transport) return {};
  const TransportFacts& t = *sweep.transport;
  std::string text = formatted(
      "truth: all transport, by packets, depth %d, cutoff %g, %d samples a pixel in %d independent "
      "passes, %.1f s%s, %.8s; standard error of a pixel, root mean square: %.2e",
      kDepthLimit, static_cast<double>(kTransportCutoff), t.samples, t.passes, t.renderMs / 1e3,
      t.fromFile ? " (by an earlier run)" : "", t.digest.c_str(), t.standardError);
  if (t.meanRadiance > 0)
    text += formatted(", %.2g %% of the mean radiance", 100 * t.standardError / t.meanRadiance);
  text += formatted("; half of its passes differ from the others by a FLIP of %.4f", t.noiseFlip);
  const auto& arithmetic = sweep.points.front().arithmetic;
  if (arithmetic) {
    text += formatted("; single precision is off by %.1e", arithmetic->samePath.rmse);
  }
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
  text += "\n" + std::string(width + 1, ' ');
  for (const Column& c : kColumns) text += formatted("%*s", c.width, c.title);
  text += "\n";
  for (const Point& point : sweep.points) text += rowOf(point, width);
  text += wrapped(formatted("* on the front of FLIP over time; ~ noisy: not known within %g %%; ? "
                            "fewer than %d rounds, and therefore on no front; measured in random "
                            "order, seed %u; the errors by cause are in report.html",
                            kNoisyPct, kLeastRounds, seed)) +
          "\n";
  if (sweep.transport) text += wrapped(choiceText(sweep)) + "\n";
  for (const IdleKnob& group : groupedByReason(sweep.idle))
    text += wrapped("not swept: " + group.name + ": " + group.because);
  return text;
}

}  // namespace whit::accuracy
