// The timing of a sweep's points, in turns with the baseline: so that times mean something on a
// machine that is busy with other things as well.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
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

// Frames in a row; it begins with `warmUp` frames that do not count.
struct Block {
  int frames = 1, warmUp = 0;
};
// The longest of which kConfidentRounds rounds of two such blocks fit into `budgetMs`; where none
// does, a single frame.
Block blockFor(double pointMs, double baselineMs, double budgetMs);
// Of a round: a block of the point and one of the baseline.
double roundMs(const Block& block, double pointMs, double baselineMs);

// More do not settle what is noisy by then.
inline constexpr int kMostRounds = 25;

// What has been taken of a point so far.
struct TimeSamples {
  std::vector<double> ms;      // of frames
  std::vector<double> ratios;  // of rounds
  bool provisional = false;    // of the first frame, which allocates: any other replaces it
  Timing timing() const;       // settledMs is left alone
};

// Times the points of a sweep in `budgetMs` all in all. `baseline` has rendered a frame and must
// outlive the timer.
class PointTimer {
 public:
  PointTimer(FrameSource& baseline, double budgetMs, int usesOfBaseline)
      : baseline_(baseline), leftMs_(budgetMs), usesOfBaseline_(usesOfBaseline) {}

  // By rounds until the time is no longer noisy, or a part of the point's share of what is left is
  // spent; it is the first of `points`, 1 or more, that are still to come. Where not even one round
  // fits, by the frame that `frames` has rendered.
  void time(Point& point, FrameSource& frames, std::size_t points);
  // More rounds of a point that was timed: until it has `rounds`, or is no longer noisy. `open`
  // makes its frames anew.
  using Open = std::function<std::unique_ptr<FrameSource>()>;
  void repeat(Point& point, int rounds, const Open& open);

  double leftMs() const { return leftMs_; }
  // Of the baseline itself, from all of its frames, at least one.
  Timing baselineTiming();

 private:
  void takeRounds(Point& point, FrameSource& frames, int mostRounds, double budgetMs);
  void takeRound(TimeSamples& samples, FrameSource& frames, const Block& block);
  void takeFirstFrame(TimeSamples& samples, double ms);
  std::vector<double> timeBlock(FrameSource& source, const Block& block);

  FrameSource& baseline_;
  double leftMs_;
  int usesOfBaseline_;              // how many first frames one frame of the baseline serves
  int firstFrames_ = 0;             // taken so far
  std::vector<double> baselineMs_;  // of all its frames that count
  double lastBlockMs_ = 0;          // of the baseline, its median
  std::map<std::string, TimeSamples> samples_;  // by the point's label
};

}  // namespace whit::accuracy
