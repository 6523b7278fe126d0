#include "accuracy/cause_chart.h"

#include <algorithm>
#include <array>

#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

constexpr double kSide = 12, kFirstRow = 80, kCauseRow = 52, kCauseBar = 7, kAboveBars = 16;
constexpr double kBarsLeft = kSide, kBarsWidth = kChartWidth - 2 * kSide;

// In the order of their bars.
constexpr std::array kShownCauses{Cause::sampling, Cause::arithmetic, Cause::algorithm,
                                  Cause::transport};

constexpr const char* kCauseStyle =
    ".causes text{font:14px system-ui,sans-serif;fill:#1f2328}\n"
    ".causes .h{font-size:16px;font-weight:600}.causes .b{font-weight:600}\n"
    ".causes .v{fill:#59636e}.causes .back{fill:#fff}.causes .row{fill:transparent}\n"
    ".causes .all{stroke:#1f2328;stroke-width:1.5}\n"
    ".causes .sampling{fill:#1f5fa8}.causes .arithmetic{fill:#6e7781}\n"
    ".causes .algorithm{fill:#8250df}.causes .transport{fill:#c4501b}\n"
    ".causes a:hover .row{fill:#1f5fa81a}\n"
    "@media(prefers-color-scheme:dark){.causes text{fill:#f0f6fc}\n"
    ".causes .v{fill:#9da7b1}.causes .back{fill:#0d1117}.causes .all{stroke:#f0f6fc}\n"
    ".causes .sampling{fill:#79b8ff}.causes .arithmetic{fill:#9da7b1}\n"
    ".causes .algorithm{fill:#d2a8ff}.causes .transport{fill:#ff9a62}}\n"
    "@media print{.causes text{fill:#000}.causes .back{fill:#fff}}\n";

// Null: it was not measured.
const ImageDifference* errorBy(Cause cause, const Point& point) {
  switch (cause) {
    case Cause::sampling:
      return &point.sampling;
    case Cause::algorithm:
      return &point.algorithm;
    case Cause::arithmetic:
      return point.arithmetic ? &point.arithmetic->samePath : nullptr;
    case Cause::transport:
      return point.transport ? &*point.transport : nullptr;
  }
  return nullptr;
}

// To what there is room for beside a number.
std::string shortened(const std::string& label) {
  constexpr std::size_t kMostLetters = 44;
  return label.size() <= kMostLetters ? label : label.substr(0, kMostLetters - 1) + "\u2026";
}

std::string legend(const SceneSweep& sweep) {
  std::string svg;
  double x = kBarsLeft;
  for (const Cause cause : kShownCauses) {
    if (cause == Cause::transport && !sweep.transport) continue;
    const char* const name = kCauseNames[static_cast<std::size_t>(cause)];
    svg +=
        formatted("<rect class=\"%s\" x=\"%.0f\" y=\"38\" width=\"11\" height=\"11\"/>", name, x);
    svg += formatted("<text x=\"%.0f\" y=\"48\">%s</text>\n", x + 16, name);
    x += 104;
  }
  return svg +
         formatted("<line class=\"all\" x1=\"%.0f\" x2=\"%.0f\" y1=\"58\" y2=\"70\"/>",
                   kBarsLeft + 5, kBarsLeft + 5) +
         formatted("<text x=\"%.0f\" y=\"69\">all together; mean FLIP</text>\n", kBarsLeft + 16);
}

std::string rowOf(const Point& point, double y, double most) {
  const auto lengthOf = [&](double flip) { return most > 0 ? kBarsWidth * flip / most : 0; };
  const std::string label = escaped(point.label()), shown = escaped(shortened(point.label()));
  std::string svg = formatted("<g data-point=\"%s\"><title>%s</title>", label.c_str(),
                              escaped(numbersOf(point)).c_str());
  svg +=
      formatted("<rect class=\"row\" x=\"4\" y=\"%.0f\" width=\"%.0f\" height=\"%.0f\" rx=\"4\"/>",
                y, kChartWidth - 8, kCauseRow - 2);
  svg += formatted("<text class=\"b\" x=\"%.0f\" y=\"%.0f\">%s</text>", kBarsLeft,
                   y + kAboveBars - 3, shown.c_str());
  svg += formatted("<text class=\"v\" x=\"%.0f\" y=\"%.0f\" text-anchor=\"end\">%.4f</text>",
                   kBarsLeft + kBarsWidth, y + kAboveBars - 3, point.total.flipMean);
  double lane = y + kAboveBars;
  for (const Cause cause : kShownCauses) {
    if (const ImageDifference* const error = errorBy(cause, point)) {
      svg += formatted("<rect class=\"%s\" x=\"%.0f\" y=\"%.1f\" width=\"%.2f\" height=\"%.0f\"/>",
                       kCauseNames[static_cast<std::size_t>(cause)], kBarsLeft, lane,
                       lengthOf(error->flipMean), kCauseBar - 1);
    }
    lane += kCauseBar;
  }
  const double at = kBarsLeft + lengthOf(point.total.flipMean);
  return svg +
         formatted("<line class=\"all\" x1=\"%.2f\" x2=\"%.2f\" y1=\"%.1f\" y2=\"%.1f\"/></g>", at,
                   at, y + kAboveBars - 1, lane);
}

}  // namespace

std::vector<const Point*> pointsByCause(const SceneSweep& sweep) {
  std::vector<const Point*> points;
  for (const Point& point : sweep.points) {
    const bool named = point.kind == PointKind::baseline || point.kind == PointKind::preset;
    if (named || point.onFront) points.push_back(&point);
  }
  std::stable_sort(points.begin(), points.end(), [](const Point* a, const Point* b) {
    return a->timing.settledMs < b->timing.settledMs;
  });
  return points;
}

std::string causeSvg(const SceneSweep& sweep, const ChartLinks& links) {
  const std::vector<const Point*> rows = pointsByCause(sweep);
  double most = 0;
  for (const Point* point : rows) {
    most = std::max(most, point->total.flipMean);
    for (const Cause cause : kShownCauses) {
      if (const ImageDifference* const error = errorBy(cause, *point))
        most = std::max(most, error->flipMean);
    }
  }
  const std::string title = sweep.scene + ": errors by cause";
  const double bottom = kFirstRow + kCauseRow * static_cast<double>(rows.size());
  std::string svg = beginChart("causes", bottom + 8, kCauseStyle, title) +
                    formatted("<text class=\"h\" x=\"%.0f\" y=\"24\">%s</text>\n", kSide,
                              escaped(title).c_str()) +
                    legend(sweep);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double y = kFirstRow + kCauseRow * static_cast<double>(i);
    svg += linkToPicture(links, sweep, *rows[i], rowOf(*rows[i], y, most)) + "\n";
  }
  return svg + "</svg>\n";
}

}  // namespace whit::accuracy
