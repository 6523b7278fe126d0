#include "accuracy/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/label_layout.h"
#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

constexpr double kWidth = 920, kHeight = 560;
constexpr Box kPlot{70, 64, 900, 500};
constexpr double kZeroY = 488;  // where an error of 0 stands
constexpr double kRadius = 4, kCharWidth = 6.9, kLineHeight = 13;

// A logarithmic scale over whole steps of 1, 2 and 5.
struct LogScale {
  double least = 1, most = 10, from = 0, to = 1;
  double at(double value) const {
    return from + (to - from) * std::log(value / least) / std::log(most / least);
  }
};

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

// Combinations off the front would hide everything else: they are in the table.
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
  // The front first, then what is named, then combinations: the order in which labels find places.
  const auto rank = [](const Mark& m) {
    return m.front ? 0 : m.point->kind == PointKind::joint ? 2 : 1;
  };
  std::stable_sort(marks.begin(), marks.end(),
                   [&](const Mark& a, const Mark& b) { return rank(a) < rank(b); });
  return marks;
}

bool isLabelled(const Mark& mark) { return mark.front || mark.point->kind != PointKind::joint; }

std::string head(const SceneSweep& sweep, Against against) {
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"pareto\" viewBox=\"0 0 %.0f %.0f\" "
      "width=\"%.0f\" height=\"%.0f\" role=\"img\">\n",
      kWidth, kHeight, kWidth, kHeight);
  svg +=
      "<style>\n"
      ".pareto text{font:11px system-ui,sans-serif;fill:#1f2328}\n"
      ".pareto .h{font-size:14px;font-weight:600}.pareto .s,.pareto .d{fill:#59636e}\n"
      ".pareto .back{fill:#fff}.pareto .grid{stroke:#d8dee4}.pareto .axis{stroke:#8c959f}\n"
      ".pareto .front{fill:none;stroke:#1f5fa8;stroke-width:2}.pareto .p{fill:#1f5fa8}\n"
      ".pareto .q{fill:#afb8c1}.pareto .lead{stroke:#8c959f;stroke-width:.7}\n"
      ".pareto .f{font-weight:600}\n"
      "@media(prefers-color-scheme:dark){.pareto text{fill:#f0f6fc}\n"
      ".pareto .s,.pareto .d{fill:#9da7b1}.pareto .back{fill:#0d1117}\n"
      ".pareto .grid{stroke:#262c36}.pareto .front{stroke:#79b8ff}.pareto .p{fill:#79b8ff}\n"
      ".pareto .q{fill:#59636e}}\n"
      "@media print{.pareto text{fill:#000}.pareto .back{fill:#fff}\n"
      ".pareto .front{stroke:#1f5fa8}.pareto .p{fill:#1f5fa8}.pareto .q{fill:#afb8c1}}\n"
      "</style>\n";
  const char* const what = against == Against::reference
                               ? "against the reference"
                               : "at equal samples: what algorithm and arithmetic do";
  svg += formatted("<title>%s: error over time, %s</title>\n", escaped(sweep.scene).c_str(), what);
  svg += formatted("<rect class=\"back\" width=\"%.0f\" height=\"%.0f\" rx=\"6\"/>\n", kWidth,
                   kHeight);
  svg += formatted("<text class=\"h\" x=\"16\" y=\"26\">%s: mean FLIP over time, %s</text>\n",
                   escaped(sweep.scene).c_str(), what);
  svg += formatted(
      "<text class=\"s\" x=\"16\" y=\"44\">%dx%d pixels, %d thread%s, %s, packets of %d; "
      "%d reference samples; gray: beaten in time and error by another</text>\n",
      sweep.width, sweep.height, sweep.machine.threads, sweep.machine.threads == 1 ? "" : "s",
      escaped(sweep.machine.simd).c_str(), sweep.machine.packet, sweep.referenceSamples);
  return svg;
}

std::string axes(const LogScale& x, const LogScale& y, bool zeros) {
  std::string svg;
  for (const double tick : ticksBetween(x.least, x.most)) {
    const double at = x.at(tick);
    svg += formatted("<line class=\"grid\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%.0f\" y2=\"%.0f\"/>\n", at,
                     at, kPlot.top, kPlot.bottom);
    svg += formatted("<text class=\"s\" x=\"%.1f\" y=\"%.0f\" text-anchor=\"middle\">%g</text>\n",
                     at, kPlot.bottom + 16, tick);
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
  svg += formatted(
      "<text class=\"s\" x=\"%.0f\" y=\"%.0f\" text-anchor=\"end\">milliseconds a "
      "frame</text>\n",
      kPlot.right, kPlot.bottom + 34);
  return svg;
}

std::string tooltip(const Mark& mark) {
  const Timing& t = mark.point->timing;
  return escaped(formatted("%s: %.2f ms (%.2f x baseline%s), FLIP %.5f",
                           mark.point->label().c_str(), t.settledMs, t.ratio,
                           t.noisy() ? ", noisy" : "", mark.error));
}

std::string frontPath(std::vector<Mark> marks) {
  marks.erase(std::remove_if(marks.begin(), marks.end(), [](const Mark& m) { return !m.front; }),
              marks.end());
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
  std::string path;
  for (const Mark& m : marks) path += formatted("%s%.1f %.1f", path.empty() ? "M" : "L", m.x, m.y);
  return path.empty() ? path : "<path class=\"front\" d=\"" + path + "\"/>\n";
}

std::string labels(const std::vector<Mark>& marks) {
  // Points without a label still take their place.
  std::vector<LabelRequest> requests;
  for (const Mark& m : marks) {
    const double width =
        isLabelled(m) ? kCharWidth * static_cast<double>(m.point->label().size()) : 0;
    requests.push_back({m.x, m.y, width, isLabelled(m) ? kLineHeight : 0});
  }
  const std::vector<PlacedLabel> placed = placeLabels(requests, kPlot, kRadius);
  std::string svg;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (!isLabelled(marks[i])) continue;
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
                     marks[i].front ? "f" : "d", x, y + 4, anchor,
                     escaped(marks[i].point->label()).c_str());
  }
  return svg;
}

}  // namespace

std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
    return points[a].error < points[b].error;
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (points[i].error >= least) continue;
    least = points[i].error;
    front.push_back(i);
  }
  return front;
}

std::string paretoSvg(const SceneSweep& sweep, Against against) {
  std::vector<Mark> marks = marksOf(sweep, against);
  std::vector<double> times, errors;
  for (const Mark& m : marks) {
    times.push_back(m.point->timing.settledMs);
    if (m.error > 0) errors.push_back(m.error);
  }
  const bool zeros = errors.size() < marks.size();
  const LogScale x = scaleFor(times, kPlot.left, kPlot.right);
  const LogScale y = scaleFor(errors, zeros ? kZeroY - 24 : kPlot.bottom, kPlot.top);
  for (Mark& m : marks) {
    m.x = x.at(m.point->timing.settledMs);
    m.y = m.error > 0 ? y.at(m.error) : kZeroY;
  }
  std::string svg = head(sweep, against) + axes(x, y, zeros) + frontPath(marks);
  // Gray points first, so that none hides the front.
  for (auto m = marks.rbegin(); m != marks.rend(); ++m) {
    svg += formatted(
        "<circle class=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.0f\"><title>%s</title>"
        "</circle>\n",
        m->front ? "p" : "q", m->x, m->y, kRadius, tooltip(*m).c_str());
  }
  return svg + labels(marks) + "</svg>\n";
}

}  // namespace whit::accuracy
