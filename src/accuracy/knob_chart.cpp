#include "accuracy/knob_chart.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "accuracy/report.h"
#include "core/formatted.h"
#include "core/quantile.h"

namespace whit::accuracy {

namespace {

constexpr double kZero = 240, kUnit = 200, kMargin = 12;
constexpr double kTop = 92, kRow = 42, kLane = 8;
constexpr double kCut = 1.08;  // where a bar beyond the scale ends, in units

// What changes by less is drawn and said as no change.
bool isWithin(double value, double noise) { return std::abs(value) <= noise; }

bool isTimeWithin(const Point& point, double noise) {
  const Timing& t = point.timing;
  return isWithin(t.ratio - 1, noise) || (t.hasSpread() && t.ratioLow <= 1 && t.ratioHigh >= 1);
}

bool savesTime(const Point& point, double noise) {
  return point.timing.ratio < 1 && !isTimeWithin(point, noise);
}

const Point* cheaper(const Point* a, const Point* b) {
  return !a || b->timing.ratio < a->timing.ratio ? b : a;
}

// Times without a spread count only where no value of the knob has one.
std::vector<const Point*> bestTimed(const std::vector<const Point*>& values) {
  std::vector<const Point*> timed;
  std::copy_if(values.begin(), values.end(), std::back_inserter(timed),
               [](const Point* point) { return point->timing.hasSpread(); });
  return timed.empty() ? values : timed;
}

const Point* chosenOf(const std::vector<const Point*>& values, const SceneSweep& sweep) {
  const Point& baseline = sweep.points.front();
  const Trade noise = noiseOf(sweep);
  const Point *saving = nullptr, *best = nullptr;
  double least = values.front()->total.flipMean;
  for (const Point* point : values) least = std::min(least, point->total.flipMean);
  for (const Point* point : bestTimed(values)) {
    const bool visible = tradeOf(*point, baseline).error >= kVisibleFlip;
    if (savesTime(*point, noise.time) && !visible) saving = cheaper(saving, point);
  }
  if (saving) return saving;
  for (const Point* point : values) {
    if (isWithin(point->total.flipMean - least, noise.error)) best = cheaper(best, point);
  }
  return best ? best : values.front();
}

constexpr const char* kKnobStyle =
    ".knobs text{font:14px system-ui,sans-serif;fill:#1f2328}\n"
    ".knobs .h{font-size:16px;font-weight:600}.knobs .b{font-weight:600}\n"
    ".knobs .s{fill:#59636e}.knobs .back{fill:#fff}.knobs .n{fill:#d8dee4}\n"
    ".knobs .zero{stroke:#8c959f}.knobs .t{fill:#1f5fa8;stroke:#1f5fa8}\n"
    ".knobs .e{fill:#c4501b;stroke:#c4501b}.knobs rect.one,.knobs path.one{fill:none;"
    "stroke-dasharray:3 2}\n"
    ".knobs text.t,.knobs text.e,.knobs tspan.t,.knobs tspan.e{stroke:none}\n"
    ".knobs tspan.s{fill:#59636e}.knobs .w{stroke:#1f2328;stroke-width:1.5}\n"
    ".knobs .row{fill:transparent}.knobs a:hover .row{fill:#1f5fa81a}\n"
    "@media(prefers-color-scheme:dark){.knobs text{fill:#f0f6fc}\n"
    ".knobs .s,.knobs tspan.s{fill:#9da7b1}.knobs .back{fill:#0d1117}.knobs .n{fill:#343b44}\n"
    ".knobs .t{fill:#79b8ff;stroke:#79b8ff}.knobs .e{fill:#ff9a62;stroke:#ff9a62}\n"
    ".knobs .w{stroke:#f0f6fc}}\n"
    "@media print{.knobs text{fill:#000}.knobs .back{fill:#fff}.knobs .n{fill:#d8dee4}\n"
    ".knobs .t{fill:#1f5fa8;stroke:#1f5fa8}.knobs .e{fill:#c4501b;stroke:#c4501b}}\n";

std::string textAt(const char* kind, double x, double y, const char* anchor,
                   const std::string& content) {
  return formatted("<text class=\"%s\" x=\"%.0f\" y=\"%.0f\" text-anchor=\"%s\">", kind, x, y,
                   anchor) +
         content + "</text>\n";
}

// The two scales, in the colors of their bars.
std::string scales(const SceneSweep& sweep, double bottom) {
  std::string svg =
      textAt("h", kMargin, 24, "start",
             escaped(sweep.scene) + ": against " + escaped(sweep.points.front().label()));
  svg += textAt("s", kMargin, 44, "start", "&#9664; better");
  svg += textAt("s", kChartWidth - kMargin, 44, "end", "worse &#9654;");
  svg += textAt("s", kZero, 44, "middle", "gray: too little to tell");
  const auto both = [&](double x, const char* anchor, const std::string& time,
                        const std::string& error) {
    svg += textAt("t", x, 64, anchor, time) + textAt("e", x, 80, anchor, error);
  };
  both(kMargin, "start", "&#8722;100 %", formatted("&#8722;%g FLIP", kFullFlip));
  both(kZero, "middle", "time", "error");
  both(kChartWidth - kMargin, "end", "+100 %", formatted("+%g FLIP", kFullFlip));
  return svg + formatted("<line class=\"zero\" x1=\"%.0f\" x2=\"%.0f\" y1=\"86\" y2=\"%.0f\"/>\n",
                         kZero, kZero, bottom);
}

// From zero; one that is cut ends in a point.
std::string bar(const char* kind, double units, double y) {
  const double side = units < 0 ? -1 : 1, length = std::min(std::abs(units), kCut) * kUnit;
  if (std::abs(units) > 1) {
    const double shoulder = kZero + side * kUnit, tip = kZero + side * length;
    return formatted("<path class=\"%s\" d=\"M%.0f %.1fH%.1fL%.1f %.1fL%.1f %.1fH%.0fZ\"/>", kind,
                     kZero, y, shoulder, tip, y + kLane / 2, shoulder, y + kLane, kZero);
  }
  return formatted("<rect class=\"%s\" x=\"%.2f\" y=\"%.1f\" width=\"%.2f\" height=\"%.0f\"/>",
                   kind, units < 0 ? kZero - length : kZero, y, length, kLane);
}

std::string noiseAt(double units, double y) {
  const double half = std::min(units, kCut) * kUnit;
  return formatted("<rect class=\"n\" x=\"%.2f\" y=\"%.1f\" width=\"%.2f\" height=\"%.0f\"/>",
                   kZero - half, y - 2, 2 * half, kLane + 4);
}

std::string whisker(const Timing& t, double y) {
  if (!t.hasSpread() || t.ratioLow - 1 > 1) return {};
  const auto at = [](double ratio) { return kZero + std::min(ratio - 1, kCut) * kUnit; };
  return formatted("<line class=\"w\" x1=\"%.2f\" x2=\"%.2f\" y1=\"%.1f\" y2=\"%.1f\"/>",
                   at(t.ratioLow), at(t.ratioHigh), y + kLane / 2, y + kLane / 2);
}

std::string timeWords(const Point& point, double noise) {
  const double ratio = point.timing.ratio;
  if (isTimeWithin(point, noise)) return "<tspan class=\"s\">same time</tspan>";
  const std::string words = ratio >= 2 ? formatted("%.1f &#215; time", ratio)
                                       : formatted("%s%.0f %% time", ratio < 1 ? "&#8722;" : "+",
                                                   100 * std::abs(ratio - 1));
  return formatted("<tspan class=\"%s\">", point.timing.hasSpread() ? "t" : "s") + words +
         "</tspan>";
}

std::string errorWords(double error, double noise) {
  if (isWithin(error, noise)) return "<tspan class=\"s\">same error</tspan>";
  return formatted("<tspan class=\"e\">%s%.4f error</tspan>", error < 0 ? "&#8722;" : "+",
                   std::abs(error));
}

std::string rowOf(const SceneSweep& sweep, const Point& point, const Trade& noise, double y) {
  const Timing& t = point.timing;
  const Trade trade = tradeOf(point, sweep.points.front());
  const std::string label = escaped(point.label());
  std::string svg = formatted("<g data-point=\"%s\"><title>%s</title>", label.c_str(),
                              escaped(numbersOf(point)).c_str());
  svg +=
      formatted("<rect class=\"row\" x=\"4\" y=\"%.0f\" width=\"%.0f\" height=\"%.0f\" rx=\"4\"/>",
                y, kChartWidth - 8, kRow - 2);
  const double timeY = y + 19, errorY = timeY + kLane + 2;
  svg += noiseAt(noise.time, timeY) + noiseAt(noise.error / kFullFlip, errorY);
  svg += bar(t.hasSpread() ? "t" : "t one", trade.time, timeY);
  svg += bar("e", trade.error / kFullFlip, errorY) + whisker(t, timeY);
  svg += textAt("b", kMargin, y + 14, "start",
                label + (t.hasSpread() ? "" : " <tspan class=\"s\">" + spreadText(t) + "</tspan>"));
  svg += textAt("v", kChartWidth - kMargin, y + 14, "end",
                timeWords(point, noise.time) + " &#160;" + errorWords(trade.error, noise.error));
  return svg + "</g>";
}

}  // namespace

Trade tradeOf(const Point& point, const Point& baseline) {
  return {point.timing.ratio - 1, point.total.flipMean - baseline.total.flipMean};
}

Trade noiseOf(const SceneSweep& sweep) {
  std::vector<double> spreads;
  for (const Point& point : sweep.points) {
    if (point.kind != PointKind::baseline && point.timing.hasSpread())
      spreads.push_back(point.timing.spreadPct() / 100);
  }
  const auto& rounding = sweep.points.front().sameSamples;
  return {quantile(spreads, 0.5), rounding ? rounding->flipMean : 0};
}

std::vector<const Point*> namedPoints(const SceneSweep& sweep) {
  std::vector<const Point*> named;
  for (const Point& point : sweep.points) {
    if (point.kind == PointKind::knob || point.kind == PointKind::preset) named.push_back(&point);
  }
  return named;
}

std::vector<const Point*> chosenPoints(const SceneSweep& sweep) {
  std::vector<const Point*> presets, chosen, values;
  const std::vector<const Point*> named = namedPoints(sweep);
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named[i]->kind == PointKind::preset) {
      presets.push_back(named[i]);
      continue;
    }
    values.push_back(named[i]);
    if (i + 1 < named.size() && named[i + 1]->knob == named[i]->knob) continue;
    chosen.push_back(chosenOf(values, sweep));
    values.clear();
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const Point* a, const Point* b) {
    return a->timing.ratio < b->timing.ratio;
  });
  presets.insert(presets.end(), chosen.begin(), chosen.end());
  return presets;
}

std::string knobSvg(const SceneSweep& sweep, const std::vector<const Point*>& rows,
                    const ChartLinks& links) {
  const Trade noise = noiseOf(sweep);
  const double bottom = kTop + kRow * static_cast<double>(rows.size());
  std::string svg =
      beginChart("knobs", bottom + 8, kKnobStyle, sweep.scene + ": time and error of each knob") +
      scales(sweep, bottom);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double y = kTop + kRow * static_cast<double>(i);
    svg += linkToPicture(links, sweep, *rows[i], rowOf(sweep, *rows[i], noise, y)) + "\n";
  }
  return svg + "</svg>\n";
}

}  // namespace whit::accuracy
