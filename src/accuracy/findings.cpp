#include "accuracy/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.h"

namespace whit::accuracy {

std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
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

void markFronts(std::vector<Point>& points) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<CostAndError> total, same;
  for (Point& point : points) {
    point.onFront = point.onFrontSameSamples = false;
    const double ms = point.timing.hasSpread() ? point.timing.settledMs : kNone;
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

}  // namespace whit::accuracy
