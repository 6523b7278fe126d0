#include "accuracy/chart_links.h"

#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

std::string beginChart(const char* kind, double height, const char* style,
                       const std::string& title) {
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"%s\" viewBox=\"0 0 %.0f %.0f\" "
      "width=\"%.0f\" height=\"%.0f\" role=\"img\">\n",
      kind, kChartWidth, height, kChartWidth, height);
  svg += std::string("<style>\n") + style + "</style>\n";
  svg += "<title>" + escaped(title) + "</title>\n";
  return svg + formatted("<rect class=\"back\" width=\"%.0f\" height=\"%.0f\" rx=\"6\"/>\n",
                         kChartWidth, height);
}

std::string pictureId(std::size_t scene, const SceneSweep& sweep, const Point& point) {
  return formatted("s%zu-p%zu", scene, static_cast<std::size_t>(&point - sweep.points.data()));
}

const Point* pictureOf(const SceneSweep& sweep, const Point& point) {
  if (!point.imagePng.empty()) return &point;
  const bool same = point.kind != PointKind::joint && !sweep.points.front().imagePng.empty();
  return same ? &sweep.points.front() : nullptr;
}

std::string linkToPicture(const ChartLinks& links, const SceneSweep& sweep, const Point& point,
                          const std::string& content) {
  const Point* const shown = pictureOf(sweep, point);
  if (!shown) return content;
  return "<a href=\"" + escaped(links.page) + "#" + pictureId(links.scene, sweep, *shown) + "\">" +
         content + "</a>";
}

}  // namespace whit::accuracy
