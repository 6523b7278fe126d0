// The sweep of a scene, which measures one choice of options after the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "accuracy/reference_pictures.h"

namespace whit::accuracy {

// Limits of a sweep. Most of them count rays, so that the reference depends on the machine's speed
// only if it is slow.
struct Limits {
  int samples, leastSamples;
  double referenceRays;  // rays for the reference
  double transportRays;  // rays for the picture with all transport
  double scalarRays;     // rays for a point that the scalar reference renders
  double longFrameRays;  // a frame of the baseline with more rays is long
  double timingSeconds;  // time for all points of a scene
  double seconds;        // no point is begun later, apart from reference and timing
};
inline constexpr Limits kQuick{64, 2, 30e6, 400e6, 20e6, 2.5e6, 20, 23};
inline constexpr Limits kFull{256, 8, 400e6, 4e9, 100e6, 1e300, 600, 1e300};

// The share of the time for timing that the reference may take besides, so that slow machines come
// to measure points. Budgets below that of a quick sweep leave the reference as it is.
inline constexpr double kReferenceShare = 1.0 / 3;
inline double referenceMs(double timingSeconds) {
  return 1000 * kReferenceShare * std::max(timingSeconds, kQuick.timingSeconds);
}

struct Scope {
  Limits limits;
  double frameRays = 0;      // rays of a frame of the baseline
  double raysPerSample = 0;  // rays of a sample of the exact picture
  bool chosenKnobs = false;  // the user named the knobs, and all of them are measured
  int baselineSpp = 1;
  double transportPaths = 0;  // paths of a pixel in the picture with all transport, or 0 without it
  float cutoff = 0;           // cutoff of exact pictures
  // The time that the reference takes for a sample of the exact picture, and may take for all.
  double msPerSample = 0, mostMs = kInfinity;

  // Samples a pixel of the reference.
  int samples() const {
    const auto takesTooLong = [&](int samples) {
      return samples * raysPerSample > limits.referenceRays || samples * msPerSample > mostMs;
    };

    int samples = limits.samples;
    while (samples > limits.leastSamples && takesTooLong(samples)) samples /= 2;
    return samples;
  }

  // Samples a pixel in each pass of the picture with all transport. `rays` is the number of rays of
  // one sample of the whole picture.
  int transportSamples(double rays) const {
    int count = samples();
    while (count > 1 && kTransportPasses * count * rays > limits.transportRays) count /= 2;
    return count;
  }
  bool longFrames() const { return frameRays > limits.longFrameRays; }

  // The reason why the point is left out; empty if it is measured.
  std::string leavesOut(const Point& point) const {
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

  // True if no point is begun any more after `seconds`; the sweep gives the reason below.
  bool isOver(double seconds) const { return !chosenKnobs && seconds > limits.seconds; }
  static constexpr const char* kOverBecause =
      "the minute of a quick sweep was over: --full, or --knobs with one of them, measures it";

  // True if packets are compared with the scalar reference of the same options, path by path.
  bool comparesPaths(const Point& point) const {
    if (point.options.mode == Mode::reference) return false;
    if (point.kind == PointKind::baseline) return true;
    return point.cause == Cause::arithmetic && (chosenKnobs || !longFrames());
  }
};

struct SweepSettings {
  Truth truth = Truth::model;
  bool full = false;
  // Empty for all knobs, or for knobsTowardsTransport() in a quick sweep with Truth::transport.
  std::vector<std::string> knobs;
  std::uint32_t seed = 1;               // gives the order of the points
  std::optional<double> timingSeconds;  // for all points of a scene; default: see Limits
  int referenceSpp = 0;  // samples a pixel of the reference; 0: as many as the limits allow
};

// `base` is the baseline. kQuick and kFull limit the samples of the reference and of the picture
// with all transport.
SceneSweep sweepScene(const Scene& scene, const RenderOptions& base, const SweepSettings& settings,
                      Progress* progress);

}  // namespace whit::accuracy
