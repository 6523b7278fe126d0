#include "accuracy/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.h"
#include "core/text.h"

namespace whit::accuracy {

namespace {

// The upper end of the interval that holds the time of a frame.
double longestMs(const Timing& t) {
  return t.ratio > 0 ? t.settledMs * std::max(t.ratioHigh / t.ratio, 1.0) : t.settledMs;
}

std::string durationText(double ms) {
  return ms < 1000 ? formatted("%g ms", ms) : formatted("%g s", ms / 1000);
}

std::string pointText(const Point& point) {
  std::string text = formatted("%s (FLIP %.4f", point.label().c_str(), point.total.flipMean);
  if (!point.timing.hasSpread()) text += "; a time without a spread";
  return text + ")";
}

}  // namespace

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

const Point* bestWithin(const SceneSweep& sweep, double ms) {
  std::vector<CostAndError> points;
  for (const Point& p : sweep.points) points.push_back({longestMs(p.timing), p.total.flipMean});
  const auto best = whit::bestWithin(points, ms);
  return best ? &sweep.points[*best] : nullptr;
}

std::string choiceText(const SceneSweep& sweep) {
  std::string text =
      formatted("%s at %dx%d pixels: ", sweep.scene.c_str(), sweep.width, sweep.height);
  const Point* before = nullptr;
  for (std::size_t i = 0; i < kChoiceMs.size(); ++i) {
    const Point* const best = bestWithin(sweep, kChoiceMs[i]);
    text += formatted(i == 0 ? "in %s " : ", in %s ", durationText(kChoiceMs[i]).c_str());
    if (!best) {
      text += "nothing that was measured";
    } else if (best == before) {
      text += "no more than that";
    } else {
      text += (before ? "" : "choose ") + pointText(*best);
    }
    before = best;
  }
  return text + ".";
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
