// A sweep as a table of text.
#include <algorithm>
#include <sstream>

#include "accuracy/choice.h"
#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

constexpr std::size_t kLongestLabel = 25;  // longer ones, of combinations, have a line of their own

constexpr const char* kWords =
    "FLIP: how visible a difference is, 0 to 1. RMSE: root of the mean squared difference of "
    "linear "
    "radiance. Code: a step of an 8-bit sRGB channel; off: share of the pixels that are off by a "
    "code "
    "or more. At equal samples: against the exact picture with as many samples a pixel. ms: of a "
    "frame; +-: within what it is known.";

// In lines of kTableColumns at most; the first begins as the text does, the others are indented.
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

std::string thousands(const FrameStats& stats) {
  double rays = 0;
  for (const RayTally& tally : stats.meter.tally) rays += static_cast<double>(tally.rays);
  return formatted(rays < 1e6 ? "%.1f" : "%.0f", rays / 1e3);
}

// In four columns and a mark. On a busy machine a frame of microseconds may take a thousand times
// as long as the one before.
std::string spreadColumn(const Timing& t) {
  if (!t.hasSpread()) return "   ? ";
  constexpr double kLargest = 9999;
  const double pct = t.spreadPct();
  const std::string number = pct <= kLargest ? formatted("%4.*f", pct < 10 ? 1 : 0, pct) : ">1e4";
  return number + (t.noisy() ? "~" : " ");
}

std::string ratioColumn(double ratio) {
  constexpr double kLargest = 9999;
  return formatted(ratio <= kLargest ? "%6.2f" : "%6.1e", ratio);
}

std::string rowOf(const Point& point, std::size_t labelWidth) {
  const Timing& t = point.timing;
  std::string label = point.label(), row;
  if (label.size() > labelWidth) {
    row = wrapped(label);
    label.clear();
  }
  row += formatted("%-*s%s%9.2f", static_cast<int>(labelWidth), label.c_str(),
                   point.onFront ? "*" : " ", t.settledMs);
  row += " " + spreadColumn(t) + " " + ratioColumn(t.ratio);
  row += formatted(" %8s", thousands(point.stats).c_str());
  const ImageDifference& d = point.total;
  row += formatted("  %7.5f %7.1e %7.2f", d.flipMean, d.rmse, d.pixelsGe1CodePct);
  if (!point.sameSamples) return row + formatted("  %7s %7s\n", "-", "-");
  return row + formatted("  %7.5f %7.3f\n", point.sameSamples->flipMean,
                         point.sameSamples->pixelsGe1CodePct);
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

std::vector<IdleKnob> groupedByReason(const std::vector<IdleKnob>& idle) {
  std::vector<IdleKnob> groups;
  for (const IdleKnob& knob : idle) {
    const auto same = [&](const IdleKnob& group) { return group.because == knob.because; };
    const auto group = std::find_if(groups.begin(), groups.end(), same);
    if (group == groups.end()) {
      groups.push_back(knob);
    } else {
      group->name += ", " + knob.name;
    }
  }
  return groups;
}

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
  const int label = static_cast<int>(width);
  text += formatted("\n%-*s %22s %8s  %23s  %15s\n", label, "", "time", "thousand",
                    sweep.transport ? "against all transport" : "against the reference",
                    "equal samples");
  text += formatted("%-*s %9s %4s %7s %8s  %7s %7s %7s  %7s %7s\n", label, "", "ms", "+-%",
                    "x base", "rays", "FLIP", "RMSE", "off %", "FLIP", "off %");
  for (const Point& point : sweep.points) text += rowOf(point, width);
  text +=
      wrapped(formatted("* on the front of FLIP over time; ~ noisy: not known within %g %%; ? of "
                        "fewer than %d rounds, and so on no front; measured in random order, seed "
                        "%u; more columns are in sweep.csv",
                        kNoisyPct, kLeastRounds, seed)) +
      "\n";
  if (sweep.transport) text += wrapped(choiceText(sweep)) + "\n";
  text += causesOf(sweep.points.front()) + notFinite(sweep);
  for (const IdleKnob& group : groupedByReason(sweep.idle))
    text += wrapped("not swept: " + group.name + ": " + group.because);
  return text;
}

}  // namespace whit::accuracy
