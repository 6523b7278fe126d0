#include "accuracy/findings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "core/formatted.h"
#include "core/quantile.h"

namespace whit::accuracy {

namespace {

// Limits of the findings, at equal samples.
constexpr double kWithinACodePct = 99.9, kGoodFlip = 0.01, kFastFlip = 0.03;

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

bool isWithin(double value, double noise) { return std::abs(value) <= noise; }

// True if the point takes less time than the baseline, beyond the noise.
bool savesTime(const Point& point, const Noise& noise) {
  const Timing& t = point.timing;
  const bool noiseAlone =
      isWithin(t.ratio - 1, noise.time) || (t.hasSpread() && t.ratioLow <= 1 && t.ratioHigh >= 1);
  return t.ratio < 1 && !noiseAlone;
}

const Point* cheaper(const Point* a, const Point* b) {
  return !a || b->timing.ratio < a->timing.ratio ? b : a;
}

// The points whose time has a spread, or all of them if there is none.
std::vector<const Point*> bestTimed(const std::vector<const Point*>& values) {
  std::vector<const Point*> timed;
  std::copy_if(values.begin(), values.end(), std::back_inserter(timed),
               [](const Point* point) { return point->timing.hasSpread(); });
  return timed.empty() ? values : timed;
}

// The point that represents a knob, of all its values.
const Point* chosenOf(const std::vector<const Point*>& values, const SceneSweep& sweep) {
  const double baseFlip = sweep.points.front().total.flipMean;
  const Noise noise = noiseOf(sweep);
  const Point *saving = nullptr, *best = nullptr;
  double least = values.front()->total.flipMean;
  for (const Point* point : values) least = std::min(least, point->total.flipMean);
  for (const Point* point : bestTimed(values)) {
    const bool visible = point->total.flipMean - baseFlip >= kVisibleFlip;
    if (savesTime(*point, noise) && !visible) saving = cheaper(saving, point);
  }
  if (saving) return saving;
  for (const Point* point : values) {
    if (isWithin(point->total.flipMean - least, noise.flip)) best = cheaper(best, point);
  }
  return best ? best : values.front();
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

void markFronts(std::vector<Point>& points) {
  std::vector<CostAndError> total, same;
  std::vector<Point*> timed, withSame;
  for (Point& point : points) {
    point.onFront = point.onFrontSameSamples = point.coversNeighbor = false;
    if (!point.timing.hasSpread()) continue;
    total.push_back({point.timing.settledMs, point.total.flipMean});
    timed.push_back(&point);
    if (!point.sameSamples) continue;
    same.push_back({point.timing.settledMs, point.sameSamples->flipMean});
    withSame.push_back(&point);
  }
  Point* before = nullptr;
  for (const std::size_t i : paretoFront(total)) {
    Point* const point = timed[i];
    point->onFront = true;
    if (before) {
      before->coversNeighbor |= before->timing.reaches(point->timing);
      point->coversNeighbor = point->timing.reaches(before->timing);
    }
    before = point;
  }
  for (const std::size_t i : paretoFront(same)) withSame[i]->onFrontSameSamples = true;
}

const Point* bestWithin(const SceneSweep& sweep, double ms) {
  const Point* best = nullptr;
  for (const Point& point : sweep.points) {
    const double error = point.total.flipMean;
    if (!std::isfinite(error) || !(longestMs(point.timing) <= ms)) continue;
    const bool better =
        !best || error < best->total.flipMean ||
        (error == best->total.flipMean && point.timing.settledMs < best->timing.settledMs);
    if (better) best = &point;
  }
  return best;
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

std::vector<const Point*> chosenPoints(const SceneSweep& sweep) {
  std::vector<const Point*> presets, chosen;
  std::map<std::string, std::vector<const Point*>> valuesOf;
  for (const Point& point : sweep.points) {
    if (point.kind == PointKind::preset) presets.push_back(&point);
    if (point.kind == PointKind::knob) valuesOf[point.knob].push_back(&point);
  }
  for (const auto& [knob, values] : valuesOf) chosen.push_back(chosenOf(values, sweep));
  std::stable_sort(chosen.begin(), chosen.end(), [](const Point* a, const Point* b) {
    return a->timing.ratio < b->timing.ratio;
  });
  presets.insert(presets.end(), chosen.begin(), chosen.end());
  return presets;
}

std::vector<Finding> findingsOf(const SceneSweep& sweep) {
  const Point& base = sweep.points.front();
  std::vector<Finding> findings;
  if (base.sameSamples) {
    const ImageDifference& d = *base.sameSamples;
    const double withinACode = 100 - d.pixelsGe2CodesPct;
    findings.push_back(
        {withinACode >= kWithinACodePct && d.flipMean < kGoodFlip,
         formatted("%s is within one code (a step of an 8-bit sRGB channel) of the exact picture "
                   "at equal samples in %g %% of pixels, with a mean FLIP below %g",
                   base.label().c_str(), kWithinACodePct, kGoodFlip),
         formatted("%.3f %%, FLIP %.5f", withinACode, d.flipMean)});
  }
  if (base.arithmetic) {
    const ArithmeticError& a = *base.arithmetic;
    findings.push_back(
        {a.samePath.maxCode <= 1,
         "arithmetic alone moves no pixel of the same path by more than a code",
         formatted("at most %d; path divergences (pixels where rounding at an edge or a cutoff "
                   "led to another surface): %llu",
                   a.samePath.maxCode, static_cast<unsigned long long>(a.divergences))});
  }
  const Point* fast = nullptr;
  for (const Point& point : sweep.points) {
    if (!point.timing.hasSpread()) continue;
    if (point.sameSamples && point.sameSamples->flipMean < kFastFlip) fast = cheaper(fast, &point);
  }
  if (fast) {
    findings.push_back(
        {fast->timing.ratio <= 0.5,
         formatted("half the time with a mean FLIP below %g at equal samples", kFastFlip),
         formatted("the cheapest is %s, %.2f times the time, FLIP %.5f", fast->label().c_str(),
                   fast->timing.ratio, fast->sameSamples->flipMean)});
  }
  return findings;
}

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

}  // namespace whit::accuracy
