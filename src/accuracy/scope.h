// The time that a sweep has: how many samples its reference gets, which points are left out, how
// far it has come and how long it will still take.
#pragma once

#include <cstddef>
#include <string>

#include "accuracy/measurement.h"
#include "core/progress.h"
#include "core/stopwatch.h"

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

// Work is counted in whatever unit its steps agree on; time left follows from what has been done.
// While a step runs, it can itself report its fraction.
class Pace : public Progress {
 public:
  Pace(Progress* out, std::string subject) : out_(out), subject_(std::move(subject)) {}

  void plan(double work) { total_ += work; }
  void begin(const std::string& step, double work);
  void end();   // of the step that was begun
  void skip();  // instead of end(): the step turned out not to be needed
  void report(const std::string& phase, double fraction) override;
  double seconds() const { return stopwatch_.ms() / 1000; }  // since the start

 private:
  Progress* out_;
  std::string subject_, step_;
  double total_ = 0, done_ = 0, current_ = 0;
  Stopwatch stopwatch_;
};

// "sponza: depth=4, 35 s left"; no time while nothing is known.
std::string paceText(const std::string& subject, const std::string& step, double elapsedSeconds,
                     double fraction);

}  // namespace whit::accuracy
