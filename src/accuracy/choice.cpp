#include "accuracy/choice.h"

#include <algorithm>
#include <cmath>

#include "core/formatted.h"

namespace whit::accuracy {

namespace {

// That a frame of the point may take, as far as is known.
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

}  // namespace whit::accuracy
