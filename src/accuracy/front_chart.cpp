#include "accuracy/front_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/label_layout.h"
#include "accuracy/report.h"
#include "accuracy/text_width.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

constexpr double kHeight = 420;
// Left of it there is room for 0.0002, as wide a number as scales of FLIP have.
constexpr Box kPlot{60, 92, 470, 374};
constexpr double kZeroY = 362;                                     // where an error of 0 stands
constexpr double kFontSize = 14, kLineHeight = 17, kBaseline = 5;  // below a line's middle
constexpr double kRadius = 4.5;
constexpr const char* kNoiseWords = "noise of the truth";
constexpr std::size_t kMostTicks = 8;     // on a scale
constexpr std::size_t kMostLetters = 26;  // letters; combinations have more

// A logarithmic scale over whole steps of 1, 2 and 5.
struct LogScale {
  double least = 1, most = 10, from = 0, to = 1;
  double at(double value) const {
    return from + (to - from) * std::log(value / least) / std::log(most / least);
  }
};

bool isDecade(double tick) {
  const double power = std::log10(tick);
  return std::abs(power - std::round(power)) < 1e-9;
}

std::vector<double> ticksBetween(double least, double most) {
  std::vector<double> ticks;
  const int last = static_cast<int>(std::floor(std::log10(most)));
  for (int power = static_cast<int>(std::floor(std::log10(least))) - 1; power <= last; ++power) {
    const double decade = std::pow(10, power);
    for (const double step : {1.0, 2.0, 5.0}) {
      const double tick = step * decade;
      if (tick >= least * 0.999 && tick <= most * 1.001) ticks.push_back(tick);
    }
  }
  if (ticks.size() > kMostTicks) std::erase_if(ticks, [](double tick) { return !isDecade(tick); });
  return ticks;
}

LogScale scaleFor(const std::vector<double>& values, double from, double to) {
  LogScale scale{1, 10, from, to};
  if (values.empty()) return scale;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  scale.least = *low / 1.25;
  scale.most = std::max(*high * 1.5, scale.least * 3);
  return scale;
}

struct Mark {
  const Point* point;
  double x = 0, y = 0, error = 0;
  bool front = false;
};

const ImageDifference* errorOf(const Point& point, Against against) {
  if (against == Against::reference) return &point.total;
  return point.sameSamples ? &*point.sameSamples : nullptr;
}

bool isPreset(const Mark& mark) {
  return mark.point->kind == PointKind::baseline || mark.point->kind == PointKind::preset;
}

bool isLabelled(const Mark& mark) { return isPreset(mark) || mark.front; }

int rankOf(const Mark& mark) { return isPreset(mark) ? 0 : mark.front ? 1 : 2; }

std::vector<Mark> marksOf(const SceneSweep& sweep, Against against) {
  std::vector<Mark> marks;
  for (const Point& point : sweep.points) {
    const ImageDifference* error = errorOf(point, against);
    if (!error || !(point.timing.settledMs > 0) || !std::isfinite(error->flipMean)) continue;
    Mark mark{&point};
    mark.front = against == Against::reference ? point.onFront : point.onFrontSameSamples;
    mark.error = error->flipMean;
    marks.push_back(mark);
  }
  // In the order in which labels find places.
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark& a, const Mark& b) { return rankOf(a) < rankOf(b); });
  return marks;
}

std::string labelOf(const Mark& mark) {
  const std::string label = mark.point->label();
  return label.size() <= kMostLetters ? label : label.substr(0, kMostLetters - 1) + "\u2026";
}

constexpr const char* kFrontStyle =
    // Widths follow the scale exactly, so that what is apart stays so at any size.
    ".pareto text{font:14px system-ui,sans-serif;fill:#1f2328;text-rendering:geometricPrecision}\n"
    ".pareto .h{font-size:16px;font-weight:600}.pareto .s,.pareto .d{fill:#59636e}\n"
    ".pareto .back{fill:#fff}.pareto .grid{stroke:#d8dee4}.pareto .axis{stroke:#8c959f}\n"
    ".pareto .front{fill:none;stroke:#1f5fa8;stroke-width:2}.pareto .p{fill:#1f5fa8}\n"
    ".pareto .tie{fill:#fff;stroke:#1f5fa8;stroke-width:2}\n"
    ".pareto .tied{stroke-dasharray:3 3}.pareto .noise{stroke:#c4501b;stroke-dasharray:6 3}\n"
    ".pareto .q{fill:#afb8c1}.pareto .lead{stroke:#8c959f;stroke-width:.7}\n"
    ".pareto .one{fill:none;stroke:#8c959f;stroke-width:1.5;stroke-dasharray:2 1.5}\n"
    ".pareto .w{stroke:#1f5fa8}.pareto .f{font-weight:600}.pareto .area{fill:transparent}\n"
    ".pareto .f,.pareto .d{paint-order:stroke;stroke:#fff;stroke-width:3px}\n"
    ".pareto a:hover .area{fill:#1f5fa833}\n"
    "@media(prefers-color-scheme:dark){.pareto text{fill:#f0f6fc}\n"
    ".pareto .s,.pareto .d{fill:#9da7b1}.pareto .back{fill:#0d1117}\n"
    ".pareto .grid{stroke:#262c36}.pareto .front{stroke:#79b8ff}.pareto .p{fill:#79b8ff}\n"
    ".pareto .tie{fill:#0d1117;stroke:#79b8ff}.pareto .noise{stroke:#ff9a62}\n"
    ".pareto .q{fill:#59636e}.pareto .w{stroke:#79b8ff}\n"
    ".pareto .f,.pareto .d{stroke:#0d1117}}\n"
    "@media print{.pareto text{fill:#000}.pareto .back{fill:#fff}.pareto .f,.pareto "
    ".d{stroke:#fff}\n"
    ".pareto .front{stroke:#1f5fa8}.pareto .p{fill:#1f5fa8}.pareto .q{fill:#afb8c1}\n"
    ".pareto .tie{fill:#fff;stroke:#1f5fa8}}\n";

// How many times have no spread, and of how many frames they are: "12 of 31 times are of one
// frame".
std::string spreadWords(const std::vector<Mark>& marks) {
  std::size_t without = 0;
  int most = 0;
  for (const Mark& mark : marks) {
    const Timing& t = mark.point->timing;
    if (t.hasSpread()) continue;
    ++without;
    most = std::max(most, t.frames);
  }
  if (without == 0) return {};
  return formatted("dashed: %zu of %zu times, of %s, are without a spread", without, marks.size(),
                   most <= 1 ? "one frame" : "few frames");
}

bool coversNeighbor(const Mark& mark, Against against) {
  return against == Against::reference && mark.front && mark.point->coversNeighbor;
}

std::string head(const SceneSweep& sweep, Against against, const std::vector<Mark>& marks) {
  const char* const what = against == Against::sameSamples ? "error at equal samples"
                           : sweep.transport               ? "off all transport, over time"
                                                           : "error over time";
  const std::string title = sweep.scene + ": " + what;
  std::vector<std::string> lines{"mean FLIP; gray: beaten in both"};
  if (const std::string words = spreadWords(marks); !words.empty()) lines.push_back(words);
  const auto covers = [&](const Mark& mark) { return coversNeighbor(mark, against); };
  if (std::any_of(marks.begin(), marks.end(), covers)) {
    lines.emplace_back("rings: the spread of the time reaches a neighbor's");
  }
  std::string svg =
      beginChart("pareto", kHeight, kFrontStyle, title) +
      formatted("<text class=\"h\" x=\"12\" y=\"24\">%s</text>\n", escaped(title).c_str());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    svg += formatted("<text class=\"s\" x=\"12\" y=\"%zu\">%s</text>\n", 44 + 18 * i,
                     lines[i].c_str());
  }
  return svg;
}

std::string axes(const LogScale& x, const LogScale& y, bool zeros) {
  std::string svg;
  for (const double tick : ticksBetween(x.least, x.most)) {
    const double at = x.at(tick);
    svg += formatted("<line class=\"grid\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%.0f\" y2=\"%.0f\"/>\n", at,
                     at, kPlot.top, kPlot.bottom);
    const std::string text = formatted("%g", tick);
    const double half = widthOf(text, kFontSize, Weight::regular) / 2;
    svg += formatted("<text class=\"s\" x=\"%.1f\" y=\"%.0f\" text-anchor=\"middle\">%s</text>\n",
                     std::min(at, kChartWidth - half), kPlot.bottom + 16, text.c_str());
  }
  const auto level = [&](double at, const std::string& text) {
    svg += formatted("<line class=\"grid\" x1=\"%.0f\" x2=\"%.0f\" y1=\"%.1f\" y2=\"%.1f\"/>\n",
                     kPlot.left, kPlot.right, at, at);
    svg += formatted("<text class=\"s\" x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n",
                     kPlot.left - 6, at + 4, text.c_str());
  };
  for (const double tick : ticksBetween(y.least, y.most)) level(y.at(tick), formatted("%g", tick));
  if (zeros) level(kZeroY, "0");
  svg += formatted("<path class=\"axis\" fill=\"none\" d=\"M%.0f %.0fV%.0fH%.0f\"/>\n", kPlot.left,
                   kPlot.top, kPlot.bottom, kPlot.right);
  svg +=
      formatted("<text class=\"s\" x=\"%.0f\" y=\"%.0f\" text-anchor=\"end\">ms a frame</text>\n",
                kPlot.right, kPlot.bottom + 34);
  return svg;
}

// A dot and its numbers; a ring around nothing where the time has no spread. The area makes it as
// easy to hit as a finger is wide.
std::string dot(const Mark& mark, Against against) {
  const char* const kind = coversNeighbor(mark, against)    ? "tie"
                           : mark.front                     ? "p"
                           : mark.point->timing.hasSpread() ? "q"
                                                            : "one";
  return formatted("<g data-point=\"%s\"><title>%s</title>", escaped(mark.point->label()).c_str(),
                   escaped(numbersOf(*mark.point)).c_str()) +
         formatted("<circle class=\"area\" cx=\"%.1f\" cy=\"%.1f\" r=\"9\"/>", mark.x, mark.y) +
         formatted("<circle class=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/></g>", kind, mark.x,
                   mark.y, kRadius);
}

// Where the time of a point on the front lies.
std::string whisker(const Mark& mark, const LogScale& x) {
  const Timing& t = mark.point->timing;
  if (!mark.front || !(t.ratioLow > 0)) return {};
  const double baselineMs = t.settledMs / t.ratio;
  return formatted("<line class=\"w\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\"/>\n",
                   std::clamp(x.at(t.ratioLow * baselineMs), kPlot.left, kPlot.right),
                   std::clamp(x.at(t.ratioHigh * baselineMs), kPlot.left, kPlot.right), mark.y,
                   mark.y);
}

std::vector<Mark> frontOf(std::vector<Mark> marks) {
  std::erase_if(marks, [](const Mark& m) { return !m.front; });
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
  return marks;
}

// From point to point: dashed where it is not known which of the two takes longer.
std::string frontPath(const std::vector<Mark>& marks, Against against) {
  const std::vector<Mark> line = frontOf(marks);
  std::string svg;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Timing &a = line[i].point->timing, &b = line[i + 1].point->timing;
    const bool tied = against == Against::reference && (a.reaches(b) || b.reaches(a));
    svg += formatted("<path class=\"front%s\" d=\"M%.1f %.1fL%.1f %.1f\"/>\n", tied ? " tied" : "",
                     line[i].x, line[i].y, line[i + 1].x, line[i + 1].y);
  }
  return svg;
}

// What the truth is off by itself, where that is known: errors can tell no less.
double noiseOfTruth(const SceneSweep& sweep, Against against) {
  return against == Against::reference && sweep.transport ? sweep.transport->noiseFlip : 0;
}

// Its words stand above the line.
std::string noiseLine(double at) {
  return formatted("<line class=\"noise\" x1=\"%.0f\" x2=\"%.0f\" y1=\"%.1f\" y2=\"%.1f\"/>\n",
                   kPlot.left, kPlot.right, at, at) +
         formatted("<text class=\"s\" x=\"%.0f\" y=\"%.1f\">%s</text>\n", kPlot.left + 4, at - 5,
                   kNoiseWords);
}

Box noiseWordsAt(double at) {
  const double left = kPlot.left + 4, bottom = at - 5 + kLineHeight / 2 - kBaseline;
  return {left, bottom - kLineHeight, left + widthOf(kNoiseWords, kFontSize, Weight::regular),
          bottom};
}

double labelWidth(const Mark& mark) {
  return widthOf(labelOf(mark), kFontSize, mark.front ? Weight::bold : Weight::regular);
}

// Presets first, then the front, each in the sweep's order. A label that finds no place beside its
// point or around it is left out: its words are in the point's tooltip as well.
std::string labels(const std::vector<Mark>& marks, const std::vector<Box>& taken) {
  // Points without a label still take their place.
  std::vector<LabelRequest> requests;
  requests.reserve(marks.size());
  for (const Mark& m : marks) {
    requests.push_back(
        {m.x, m.y, isLabelled(m) ? labelWidth(m) : 0, isLabelled(m) ? kLineHeight : 0});
  }
  // And so does the line.
  const std::vector<Mark> line = frontOf(marks);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double dx = line[i].x - line[i - 1].x, dy = line[i].y - line[i - 1].y;
    const int steps = static_cast<int>(std::hypot(dx, dy) / kRadius);
    for (int k = 1; k < steps; ++k)
      requests.push_back({line[i - 1].x + dx * k / steps, line[i - 1].y + dy * k / steps, 0, 0});
  }
  const std::vector<PlacedLabel> placed = placeLabels(requests, kPlot, kRadius, taken);
  std::string svg;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (!isLabelled(marks[i]) || !placed[i].free) continue;
    const Box& box = placed[i].box;
    // Written from the end that is next to the point, as fonts differ in width.
    const bool right = box.left >= marks[i].x, left = box.right <= marks[i].x;
    const double x = right ? box.left : left ? box.right : (box.left + box.right) / 2;
    const double y = (box.top + box.bottom) / 2;
    if (placed[i].leader) {
      const double endX = std::clamp(marks[i].x, box.left, box.right);
      const double endY = std::clamp(marks[i].y, box.top, box.bottom);
      svg += formatted("<line class=\"lead\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
                       marks[i].x, marks[i].y, endX, endY);
    }
    const char* const anchor = right ? "start" : left ? "end" : "middle";
    svg += formatted("<text class=\"%s\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n",
                     marks[i].front ? "f" : "d", x, y + kBaseline, anchor,
                     escaped(labelOf(marks[i])).c_str());
  }
  return svg;
}

}  // namespace

std::string frontSvg(const SceneSweep& sweep, Against against, const ChartLinks& links) {
  std::vector<Mark> marks = marksOf(sweep, against);
  std::vector<double> times, errors;
  for (const Mark& m : marks) {
    times.push_back(m.point->timing.settledMs);
    if (m.error > 0) errors.push_back(m.error);
  }
  const bool zeros = errors.size() < marks.size();
  const LogScale x = scaleFor(times, kPlot.left, kPlot.right);
  const double noise = noiseOfTruth(sweep, against);
  if (noise > 0) errors.push_back(noise);
  const LogScale y = scaleFor(errors, zeros ? kZeroY - 24 : kPlot.bottom, kPlot.top);
  for (Mark& m : marks) {
    m.x = x.at(m.point->timing.settledMs);
    m.y = m.error > 0 ? y.at(m.error) : kZeroY;
  }
  std::string svg = head(sweep, against, marks) + axes(x, y, zeros);
  std::vector<Box> taken;
  if (noise > 0) {
    svg += noiseLine(y.at(noise));
    taken.push_back(noiseWordsAt(y.at(noise)));
  }
  svg += frontPath(marks, against);
  // Gray points first, so that none hides the front.
  for (auto m = marks.rbegin(); m != marks.rend(); ++m)
    svg += whisker(*m, x) + linkToPicture(links, sweep, *m->point, dot(*m, against)) + "\n";
  return svg + labels(marks, taken) + "</svg>\n";
}

}  // namespace whit::accuracy
