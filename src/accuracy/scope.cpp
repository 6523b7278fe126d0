#include "accuracy/scope.h"

#include <algorithm>

#include "accuracy/reference_cache.h"

namespace whit::accuracy {

int Scope::samples() const {
  int samples = limits.samples;
  while (samples > limits.leastSamples && samples * raysPerSample > limits.referenceRays) {
    samples /= 2;
  }
  return samples;
}

int Scope::transportSamples(double rays) const {
  int count = samples();
  while (count > 1 && kTransportPasses * count * rays > limits.transportRays) count /= 2;
  return count;
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
  if (transportPaths > 0 && whit::accuracy::transportPaths(point.options) > transportPaths / 2) {
    return "more than half of the paths that the picture with all transport has";
  }
  return {};
}

bool Scope::comparesPaths(const Point& point) const {
  if (point.options.mode == Mode::reference) return false;
  if (point.kind == PointKind::baseline) return true;
  return point.cause == Cause::arithmetic && (chosenKnobs || !longFrames());
}

}  // namespace whit::accuracy
