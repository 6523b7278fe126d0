// The timing of a sweep's points. Their frames take turns with frames of the baseline, so that
// ratios mean something on a busy machine too.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
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
  FrameStats stats;  // of the last frame

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
// that holds the median of the distribution with kMedianConfidence at least, whatever the
// distribution is (the inverted sign test: Conover, Practical Nonparametric Statistics, 1999,
// section 3.2). It is the whole range of fewer than five values, which is less certain, and 0 to 0
// of none.
Interval medianInterval(std::vector<double> values);

// Frames in a row, after `warmUp` frames that do not count.
struct Block {
  int frames = 1, warmUp = 0;
};
// The longest block of which kConfidentRounds rounds fit into `budgetMs`, or a single frame if none
// does.
Block blockFor(double pointMs, double baselineMs, double budgetMs);
// The time of a round, which is a block of the point and one of the baseline.
double roundMs(const Block& block, double pointMs, double baselineMs);

// More rounds do not help a time that is still noisy.
inline constexpr int kMostRounds = 25;

// The times of a point so far.
struct TimeSamples {
  std::vector<double> ms;      // one for each frame
  std::vector<double> ratios;  // one for each round
  bool provisional = false;    // only the first frame, which allocates; any other replaces it
  Timing timing() const;       // without settledMs
};

// Times all points of a sweep within `budgetMs`. `baseline` has rendered a frame and must outlive
// the timer.
class PointTimer {
 public:
  PointTimer(FrameSource& baseline, double budgetMs, int usesOfBaseline)
      : baseline_(baseline), leftMs_(budgetMs), usesOfBaseline_(usesOfBaseline) {}

  // Times the first of `points` points that are still to come. Measures rounds until the time is no
  // longer noisy, or until a part of the point's share of the remaining budget is spent. If no
  // round fits, the frame that `frames` has rendered gives the time.
  void time(Point& point, FrameSource& frames, std::size_t points);
  // Measures more rounds of a point, until it has `rounds` or is no longer noisy. `open` makes its
  // frames.
  using Open = std::function<std::unique_ptr<FrameSource>()>;
  void repeat(Point& point, int rounds, const Open& open);

  double leftMs() const { return leftMs_; }
  // The timing of the baseline itself, from all of its frames.
  Timing baselineTiming();

 private:
  void measureRounds(Point& point, FrameSource& frames, int mostRounds, double budgetMs);
  std::vector<double> timeBlock(FrameSource& source, const Block& block);

  FrameSource& baseline_;
  double leftMs_;
  int usesOfBaseline_;              // number of first frames that share a frame of the baseline
  int firstFrames_ = 0;             // number of first frames that were used so far
  std::vector<double> baselineMs_;  // all frames of the baseline that count
  std::map<std::string, TimeSamples> samples_;  // key: the point's label
};

}  // namespace whit::accuracy
