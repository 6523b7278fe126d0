// The scope of a sweep: how many samples its reference has, and which points it leaves out so as
// to end in time.
#pragma once

#include <cstddef>
#include <string>

#include "accuracy/measurement.h"

namespace whit::accuracy {

// Counted in rays where they can be: a reference must not depend on the machine's speed.
struct Limits {
  int samples, leastSamples;
  double referenceRays;  // of the reference of all
  double transportRays;  // of the picture with all transport
  double scalarRays;     // of a point that is rendered by the scalar reference
  double longFrameRays;  // frames of the baseline with more are long
  double timingSeconds;  // for all points of a scene
  std::size_t joint;     // combinations
  double seconds;        // after which no more point is begun
};
inline constexpr Limits kQuick{64, 2, 30e6, 400e6, 20e6, 2.5e6, 20, 0, 50};
inline constexpr Limits kFull{256, 8, 400e6, 4e9, 100e6, 1e300, 600, 40, 1e300};

struct Scope {
  Limits limits;
  double frameRays = 0;      // of a frame of the baseline
  double raysPerSample = 0;  // of the exact picture
  bool chosenKnobs = false;  // by name: all of them are measured
  int baselineSpp = 1;
  double transportPaths = 0;  // of a pixel of the picture with all transport; 0: there is none

  // Of the reference.
  int samples() const;
  // Of each pass of the picture with all transport, of so many rays a sample.
  int transportSamples(double rays) const;
  bool longFrames() const { return frameRays > limits.longFrameRays; }
  // Why the point is left out; empty where it is measured.
  std::string leavesOut(const Point& point) const;
  // Whether so many seconds are all that the sweep has for points; and what it says of the others.
  bool isOver(double seconds) const { return !chosenKnobs && seconds > limits.seconds; }
  static constexpr const char* kOverBecause =
      "the minute of a quick sweep was over: --full, or --knobs with one of them, measures it";
  // Whether packets are compared with the scalar reference of the very same options, path by path.
  bool comparesPaths(const Point& point) const;
};

}  // namespace whit::accuracy
