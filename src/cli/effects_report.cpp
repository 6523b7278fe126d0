#include "cli/effects_report.h"

#include <algorithm>

#include "core/formatted.h"

namespace whit::cli {

namespace {

double outside(const FrameStats& frame) { return frame.frameMs - frame.embreeMs(); }

// The median over the turns of what `of` gives for this run's frame more than for the other's.
template <typename Of>
double medianAdded(const RunSummary& run, const RunSummary& before, const Of& of) {
  std::vector<double> added;
  for (std::size_t i = 0; i < std::min(run.frames.size(), before.frames.size()); ++i) {
    added.push_back(of(run.frames[i]) - of(before.frames[i]));
  }
  return quantile(added, 0.5);
}

double raysOf(const EffectStep& step) {
  return static_cast<double>(medianFrame(step.run).allRays());
}

// The name of a step with what it stands for; names are the program's own and need no escaping.
std::string label(const EffectStep& step, std::size_t index) {
  return index == 0 ? step.added : "+ " + step.added;
}

// One column of bars. Bars begin at zero, to whose left what an effect saves reaches.
struct Bars {
  double left, width;
  const char *title, *format;
  double least = 0, most = 0;

  void include(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  double at(double value) const {
    const double span = most - least;
    return left + (span > 0 ? (value - least) / span : 0) * width;
  }
};

constexpr double kRowHeight = 22, kTop = 74, kLabelWidth = 150, kBarsWidth = 150, kGap = 85;

// In the row whose text stands on the line `y`.
void appendBar(std::string& svg, const Bars& bars, double y, double value, const char* kind,
               double height = 14) {
  const double from = bars.at(std::min(value, 0.0)), to = bars.at(std::max(value, 0.0));
  svg += formatted("<rect class=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.0f\"/>\n",
                   kind, from, y - 4 - height / 2, std::max(to - from, 0.5), height);
}

// Behind a bar that ends at `end`.
void appendNumber(std::string& svg, const Bars& bars, double y, double end, double value) {
  svg += formatted("<text class=\"n\" x=\"%.1f\" y=\"%.1f\">", bars.at(std::max(end, 0.0)) + 5, y);
  svg += formatted(bars.format, value) + "</text>\n";
}

std::string svgHead(const EffectStep& first, double width, double height) {
  const RunSummary& run = first.run;
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
      "height=\"%.0f\" role=\"img\" aria-label=\"What each effect adds to a frame\">\n",
      width, height, width, height);
  svg +=
      "<style>\n"
      "text{font:13px system-ui,sans-serif;fill:#1f2328}.h{font-weight:600}\n"
      ".n,.s{font-size:12px;fill:#59636e}.back{fill:#ffffff}.axis{stroke:#8c959f}\n"
      ".time{fill:#6aa5e8}.own{fill:#1f5fa8}.rays{fill:#d08a2c}.memory{fill:#3f9a63}\n"
      "@media(prefers-color-scheme:dark){text{fill:#f0f6fc}.n,.s{fill:#9da7b1}\n"
      ".back{fill:#0d1117}.time{fill:#3d76b8}.own{fill:#9cc8ff}.rays{fill:#e0a552}\n"
      ".memory{fill:#5bbd82}}\n</style>\n";
  svg +=
      formatted("<rect class=\"back\" width=\"%.0f\" height=\"%.0f\" rx=\"6\"/>\n", width, height);
  svg += formatted(
      "<text class=\"h\" x=\"14\" y=\"24\">What each effect adds to a frame</text>\n"
      "<text class=\"s\" x=\"14\" y=\"42\">%dx%d pixels, %d thread%s, %s, packets of %d; medians "
      "of "
      "%zu turns</text>\n",
      run.width, run.height, run.machine.threads, run.machine.threads == 1 ? "" : "s",
      run.machine.simd.c_str(), run.machine.packet, run.frames.size());
  return svg;
}

}  // namespace

std::vector<EffectCost> effectCosts(const std::vector<EffectStep>& steps) {
  std::vector<EffectCost> costs;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EffectStep& step = steps[i];
    EffectCost cost;
    cost.frameMs = medianFrame(step.run).frameMs;
    if (i == 0) {
      cost.addedMs = cost.frameMs;
      cost.outsideMs = outsideEmbreeMs(step.run);
      cost.addedRays = raysOf(step);
      cost.addedMb = step.memoryMb;
    } else {
      const EffectStep& before = steps[i - 1];
      cost.addedMs =
          medianAdded(step.run, before.run, [](const FrameStats& f) { return f.frameMs; });
      cost.outsideMs = medianAdded(step.run, before.run, outside);
      cost.addedRays = raysOf(step) - raysOf(before);
      cost.addedMb = step.memoryMb - before.memoryMb;
    }
    costs.push_back(cost);
  }
  return costs;
}

std::string effectsTable(const std::vector<EffectStep>& steps) {
  const std::vector<EffectCost> costs = effectCosts(steps);
  std::string text = formatted("%-18s%10s%10s%16s%12s%10s\n", "effect", "frame ms", "added ms",
                               "outside Embree", "added rays", "added MB");
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EffectCost& c = costs[i];
    text += formatted("%-18s%10.2f%+10.2f%+16.2f%+12.0f%+10.2f\n", label(steps[i], i).c_str(),
                      c.frameMs, c.addedMs, c.outsideMs, c.addedRays, c.addedMb);
  }
  return text + "\n" + effectsNote(steps);
}

std::string effectsNote(const std::vector<EffectStep>& steps) {
  const std::vector<EffectCost> costs = effectCosts(steps);
  double sum = 0;
  for (const EffectCost& c : costs) sum += c.addedMs;
  return formatted(
      "Rays and MB add up. Times are medians of %zu turns, and medians do not: what is added is "
      "that of\n"
      "the differences to the row above within a turn, in which whatever slows both cancels. All "
      "rows\n"
      "together come to %.2f ms; the last frame takes %.2f ms.\n",
      steps.at(0).run.frames.size(), sum, costs.back().frameMs);
}

std::string effectsCsv(const std::vector<EffectStep>& steps) {
  const std::vector<EffectCost> costs = effectCosts(steps);
  std::string text = "effect,frame_ms,added_ms,added_outside_embree_ms";
  for (const RayKindRow& kind : kRayKinds) text += "," + std::string(kind.name) + "_rays";
  text += ",added_rays,memory_mb,added_memory_mb\n";
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EffectCost& c = costs[i];
    text +=
        formatted("%s,%.4f,%.4f,%.4f", steps[i].added.c_str(), c.frameMs, c.addedMs, c.outsideMs);
    for (const RayTally& tally : medianFrame(steps[i].run).meter.tally) {
      text += "," + std::to_string(tally.rays);
    }
    text += formatted(",%.0f,%.3f,%.3f\n", c.addedRays, steps[i].memoryMb, c.addedMb);
  }
  return text;
}

std::string effectsSvg(const std::vector<EffectStep>& steps) {
  const std::vector<EffectCost> costs = effectCosts(steps);
  const double next = kBarsWidth + kGap;
  Bars time{kLabelWidth, kBarsWidth, "ms (thin: outside Embree)", "%+.2f"};
  Bars rays{kLabelWidth + next, kBarsWidth, "thousand rays", "%+.0f"};
  Bars memory{kLabelWidth + 2 * next, kBarsWidth, "megabytes", "%+.2f"};
  // What the scene starts with is a number, not a bar: next to it the others would vanish.
  for (std::size_t i = 1; i < costs.size(); ++i) {
    time.include(costs[i].addedMs);
    time.include(costs[i].outsideMs);
    rays.include(costs[i].addedRays / 1e3);
    memory.include(costs[i].addedMb);
  }
  const double bottom = kTop + kRowHeight * static_cast<double>(steps.size());
  std::string svg = svgHead(steps.at(0), kLabelWidth + 3 * next, bottom + 8);
  for (const Bars* bars : {&time, &rays, &memory}) {
    svg += formatted("<text class=\"s\" x=\"%.1f\" y=\"62\">%s</text>\n", bars->left, bars->title);
    svg += formatted("<line class=\"axis\" x1=\"%.1f\" x2=\"%.1f\" y1=\"68\" y2=\"%.1f\"/>\n",
                     bars->at(0), bars->at(0), bottom);
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EffectCost& c = costs[i];
    const double y = kTop + 14 + kRowHeight * static_cast<double>(i);
    svg += formatted("<text x=\"14\" y=\"%.1f\">%s</text>\n", y, label(steps[i], i).c_str());
    if (i > 0) {
      appendBar(svg, time, y, c.addedMs, "time");
      appendBar(svg, time, y, c.outsideMs, "own", 4);
      appendBar(svg, rays, y, c.addedRays / 1e3, "rays");
      appendBar(svg, memory, y, c.addedMb, "memory");
    }
    const double end = i > 0 ? 1 : 0;
    appendNumber(svg, time, y, end * std::max(c.addedMs, c.outsideMs), c.addedMs);
    appendNumber(svg, rays, y, end * c.addedRays / 1e3, c.addedRays / 1e3);
    appendNumber(svg, memory, y, end * c.addedMb, c.addedMb);
  }
  return svg + "</svg>\n";
}

}  // namespace whit::cli
