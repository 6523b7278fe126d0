// The results of a sweep as text for a terminal.
#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "accuracy/findings.h"
#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

// Longer labels, which combinations have, get a line of their own.
constexpr std::size_t kLongestLabel = 25;

constexpr const char* kWords =
    "FLIP: how visible a difference is, 0 to 1. RMSE: root of the mean squared difference of "
    "linear radiance. Code: a step of an 8-bit sRGB channel; off: share of the pixels that are off "
    "by a code or more. At equal samples: against the exact picture with as many samples a pixel. "
    "ms: time of a frame; +-: half the interval that holds its median with 90 % confidence.";

// Breaks the text into lines of at most kTableColumns letters. The first line keeps its
// indentation, and the others get `indent`.
std::string wrapped(const std::string& text, std::size_t indent = 2) {
  std::istringstream words(text);
  std::string all, line(std::min(text.find_first_not_of(' '), text.size()), ' '), word;
  const auto end = [&] {
    all += line + "\n";
    line.assign(indent, ' ');
  };
  bool begun = false;
  while (words >> word) {
    if (begun && line.size() + 1 + word.size() > kTableColumns) end(), begun = false;
    for (; line.size() + word.size() > kTableColumns; end()) {
      const std::size_t room = kTableColumns - line.size();
      line += word.substr(0, room);
      word.erase(0, room);
    }
    line += (begun ? " " : "") + word;
    begun = true;
  }
  return all + line + "\n";
}

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
  std::string_view group, title;
  int width;  // including the space before it
  std::string (*cell)(const Point& point);
};

constexpr std::string_view kAgainstTruth = "against the reference", kEqualSamples = "equal samples";
constexpr std::array kColumns{
    Column{"time", "ms", 9, [](const Point& p) { return formatted("%.2f", p.timing.settledMs); }},
    Column{"time", "+-% ", 6, spreadCell},
    Column{"time", "x base", 7,
           [](const Point& p) {
             const double ratio = p.timing.ratio;
             return formatted(ratio <= kLargest ? "%.2f" : "%.1e", ratio);
           }},
    Column{"thousand", "rays", 9, thousandRays},
    Column{kAgainstTruth, "FLIP", 9,
           [](const Point& p) { return formatted("%.5f", p.total.flipMean); }},
    Column{kAgainstTruth, "RMSE", 8,
           [](const Point& p) { return formatted("%.1e", p.total.rmse); }},
    Column{kAgainstTruth, "off %", 8,
           [](const Point& p) { return formatted("%.2f", p.total.pixelsGe1CodePct); }},
    Column{kEqualSamples, "FLIP", 9,
           [](const Point& p) {
             return p.sameSamples ? formatted("%.5f", p.sameSamples->flipMean) : "-";
           }},
    Column{kEqualSamples, "off %", 8, [](const Point& p) {
             return p.sameSamples ? formatted("%.3f", p.sameSamples->pixelsGe1CodePct) : "-";
           }}};

std::string rightAligned(std::string_view text, int width) {
  return formatted("%*.*s", width, static_cast<int>(text.size()), text.data());
}

// Two lines: the groups, each right-aligned over its columns, and the titles.
std::string headOf(const SceneSweep& sweep, std::size_t labelWidth) {
  std::string groups(labelWidth + 1, ' '), titles = groups;
  int width = 0;
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const Column& column = kColumns[i];
    titles += rightAligned(column.title, column.width);
    width += column.width;
    if (i + 1 < kColumns.size() && kColumns[i + 1].group == column.group) continue;
    const bool transport = sweep.transport && column.group == kAgainstTruth;
    groups += rightAligned(transport ? "against all transport" : column.group, width);
    width = 0;
  }
  return groups + "\n" + titles + "\n";
}

std::string rowOf(const Point& point, std::size_t labelWidth) {
  std::string label = point.label(), row;
  if (label.size() > labelWidth) {
    row = wrapped(label);
    label.clear();
  }
  label.resize(labelWidth, ' ');
  row += label + (point.onFront ? "*" : " ");
  for (const Column& column : kColumns) row += rightAligned(column.cell(point), column.width);
  return row + "\n";
}

std::string causesOf(const Point& point) {
  const auto line = [](const char* cause, const char* how, const ImageDifference& d) {
    return formatted(
        "  %-11s FLIP %.5f, RMSE %.1e, %7.3f %% off by a code or more, at most %d\n"
        "  %-11s (%s)\n",
        cause, d.flipMean, d.rmse, d.pixelsGe1CodePct, d.maxCode, "", how);
  };
  std::string text = wrapped("errors of '" + point.label() + "' by cause");
  text += line("sampling", "without approximations, against the reference", point.sampling);
  text += line("algorithm", "against the same without approximations", point.algorithm);
  if (point.transport) {
    text += line("transport", "what more samples lead to, against all transport", *point.transport);
  }
  if (point.arithmetic) {
    const ArithmeticError& a = *point.arithmetic;
    text += line("arithmetic", "packets against doubles, pixels of the same path", a.samePath);
    text +=
        wrapped(formatted("  path divergences: %llu pixels (%.1f in a million) saw another "
                          "surface by rounding; of the others half are within %.3g ulp, 99.9 %% "
                          "within %.3g, all within %.3g",
                          static_cast<unsigned long long>(a.divergences), a.divergencesPerMpx,
                          a.medianUlp, a.ulp999, a.worstUlp));
  }
  return text;
}

std::string notFinite(const SceneSweep& sweep) {
  std::string text;
  for (const Point& point : sweep.points) {
    if (point.total.nonFinite == 0) continue;
    text += wrapped(formatted("pixels that are not finite: %llu of ",
                              static_cast<unsigned long long>(point.total.nonFinite)) +
                    point.label());
  }
  return text;
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
  text += "\n" + headOf(sweep, width);
  for (const Point& point : sweep.points) text += rowOf(point, width);
  text += wrapped(formatted("* on the front of FLIP over time; ~ noisy: not known within %g %%; ? "
                            "fewer than %d rounds, and therefore on no front; measured in random "
                            "order, seed %u; more columns are in sweep.csv",
                            kNoisyPct, kLeastRounds, seed)) +
          "\n";
  if (sweep.transport) text += wrapped(choiceText(sweep)) + "\n";
  text += causesOf(sweep.points.front()) + notFinite(sweep);
  for (const IdleKnob& group : groupedByReason(sweep.idle))
    text += wrapped("not swept: " + group.name + ": " + group.because);
  return text;
}

}  // namespace whit::accuracy
