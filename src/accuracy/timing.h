// Times that mean something on a machine that is busy with other things as well.
#pragma once

#include <vector>

#include "accuracy/measurement.h"

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
// `thorough`: at least nine frames whatever they take, unless one takes the whole budget.
Rounds roundsFor(double pointMs, double baselineMs, double budgetMs, bool thorough);

// Times `point` between frames of `baseline`: a block of the baseline's frames, then in each round
// a block of the point's and another of the baseline's. The baseline's times are added to
// `baselineMs`. Leaves settledMs alone.
Timing timePoint(FrameSource& point, FrameSource& baseline, const Rounds& rounds,
                 std::vector<double>& baselineMs);

// Of the baseline itself, from all of its frames.
Timing timingOf(const std::vector<double>& ms);

}  // namespace whit::accuracy
