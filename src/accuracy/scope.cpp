#include "accuracy/scope.h"

#include <algorithm>

namespace whit::accuracy {

int Scope::samples() const {
  int samples = limits.samples;
  while (samples > limits.leastSamples && samples * raysPerSample > limits.referenceRays) {
    samples /= 2;
  }
  return samples;
}

std::string Scope::leavesOut(const Point& point) const {
  if (point.kind == PointKind::baseline) return {};
  if (point.options.mode == Mode::reference &&
      point.options.spp * raysPerSample > limits.scalarRays) {
    return "the scalar reference would take too long here";
  }
  if (point.options.spp > std::max(samples() / 2, baselineSpp)) {
    return "more than half of the reference's samples";
  }
  return {};
}

bool Scope::comparesPaths(const Point& point) const {
  if (point.options.mode == Mode::reference) return false;
  if (point.kind == PointKind::baseline) return true;
  return point.cause == Cause::arithmetic && (chosenKnobs || !longFrames());
}

}  // namespace whit::accuracy
