// The timing of a sweep's points, in turns with the baseline: so that times mean something on a
// machine that is busy with other things as well.
#pragma once

#include <vector>

#include "accuracy/measurement.h"
#include "accuracy/scope.h"

namespace whit::accuracy {

// A way to render frames of one view.
class FrameSource {
 public:
  FrameSource(const Scene& scene, const Camera& camera, const RenderOptions& options);
  const FrameStats& render();  // one frame, by the pipeline or the scalar reference

  Renderer renderer;
  Film film;
  FrameStats stats;  // of the last frame

 private:
  Camera camera_;
  Mode mode_;
};

// A block of frames begins with `warmUp` frames that do not count.
struct Rounds {
  int count = 3, frames = 4, warmUp = 1;
};
// As many as fit into `budgetMs` of frames that take so long; always at least one of one frame.
Rounds roundsFor(double pointMs, double baselineMs, double budgetMs);

// Times `point` between frames of `baseline`: a block of the baseline's frames, then in each round
// a block of the point's and another of the baseline's. The baseline's times are added to
// `baselineMs`. Leaves settledMs alone.
Timing timePoint(FrameSource& point, FrameSource& baseline, const Rounds& rounds,
                 std::vector<double>& baselineMs);

// Of the baseline itself, from all of its frames.
Timing timingOf(const std::vector<double>& ms);

// Times the points of a sweep, each as thoroughly as the sweep can afford: long ones by a single
// frame. `baseline` has rendered a frame; it and `scope` must outlive the timer.
class PointTimer {
 public:
  PointTimer(FrameSource& baseline, const Scope& scope) : baseline_(baseline), scope_(scope) {}

  // `frames` has rendered a frame of the point. Leaves settledMs alone.
  void time(Point& point, FrameSource& frames);
  // Of the baseline's frames so far, at least one.
  const std::vector<double>& baselineMs();

 private:
  void takeSingleFrame(Point& point, double ms);

  FrameSource& baseline_;
  const Scope& scope_;
  std::vector<double> baselineMs_;
  int singleFrames_ = 0;  // of points, taken so far
};

}  // namespace whit::accuracy
