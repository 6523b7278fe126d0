// The timing of a sweep's points. Their frames take turns with frames of the baseline, so that
// ratios mean something on a busy machine too.
#pragma once

#include <vector>

#include "accuracy/measurement.h"
#include "inspect/reference_frame.h"
#include "render/renderer.h"

namespace whit::accuracy {

// Renders frames of one view.
class FrameSource {
 public:
  FrameSource(const Scene& scene, const Camera& camera, const RenderOptions& options)
      : renderer(scene, options),
        film(makeFilm(scene, options)),
        camera_(camera),
        mode_(options.mode) {}
  // Renders one frame, with packets or with the scalar reference.
  const FrameStats& render() { return stats = renderFrame(renderer, mode_, camera_, film); }

  Renderer renderer;
  Film film;
  FrameStats stats;  // statistics of the last frame

 private:
  Camera camera_;
  Mode mode_;
};

struct Interval {
  double low = 0, high = 0;
};

// Five values, the fewest, allow this confidence: the median of their distribution is outside their
// range with a probability of 2 in 32.
inline constexpr double kMedianConfidence = 0.9;

// The narrowest interval between two order statistics of the values, symmetric about the middle,
// that holds the median of the distribution with this confidence at least, whatever the
// distribution is (the inverted sign test: Conover, Practical Nonparametric Statistics, 1999,
// section 3.2). It is the whole range of values that are too few for the confidence, and 0 to 0 of
// none.
Interval medianInterval(std::vector<double> values, double confidence = kMedianConfidence);

// More rounds do not help a time that is still noisy.
inline constexpr int kMostRounds = 25;

// The times of a point so far.
struct TimeSamples {
  std::vector<double> ms;      // time of each frame
  std::vector<double> ratios;  // ratio to the baseline of each round
  bool provisional = false;    // only the first frame, which allocates
  Timing timing() const;       // without steadyMs
};

// Times all points of a sweep within `budgetMs`. `baseline` has rendered a frame and must outlive
// the timer.
class PointTimer {
 public:
  PointTimer(FrameSource& baseline, double budgetMs)
      : baseline_(baseline), budgetMs_(budgetMs), baselineMs_{baseline.render().frameMs} {}

  // Times the first of `points` points that are still to come. Measures rounds until the time is no
  // longer noisy, or until the point's share of the remaining budget is spent. If no round fits,
  // the frame that `frames` has rendered gives the time.
  void time(Point& point, FrameSource& frames, std::size_t points);

  double spentMs() const { return spentMs_; }

  // The timing of the baseline itself, from all of its frames.
  Timing baselineTiming() const;

 private:
  double secondFrameMs(FrameSource& source);

  FrameSource& baseline_;
  double budgetMs_, spentMs_ = 0;
  std::vector<double> baselineMs_;  // all frames of the baseline that count
};

}  // namespace whit::accuracy
