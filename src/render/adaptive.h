// Adaptive sampling (--adaptive): a frame in several passes. The center of every pixel is traced
// first; where that picture has edges, probe samples; and where these differ, all samples
// (sampling/adaptive_pixels.h). What happens to a pixel in the later passes depends on whole
// pictures of the earlier ones and on nothing else, so that the result is the same for any tiles
// and threads. Channels are those of the centers.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/frame.h"
#include "render/scheduler.h"

namespace whit {

class AdaptiveSampler {
 public:
  explicit AdaptiveSampler(Scheduler& scheduler) : scheduler_(scheduler) {}

  // The pixels that are traced for the film's window: those next to it are compared with it.
  static Crop tracedWindow(const Image& image);

  // `frame` has the pattern of all samples; the scheduler's window is tracedWindow().
  FrameStats render(const Frame& frame);
  // The samples of `pattern` whose mean a pixel of the last film has.
  std::vector<Vec2f> samplesAt(int x, int y, std::vector<Vec2f> pattern) const;
  std::size_t bytes() const;

 private:
  void startOver(const Frame& frame);
  FrameStats traceCenters(const Frame& frame);
  FrameStats traceProbes(const Frame& frame);
  FrameStats findContrast(const Frame& frame);
  FrameStats traceMarked(const Frame& frame, const Crop& window,
                         const std::vector<std::uint8_t>& marks);

  Scheduler& scheduler_;
  // The picture of the first pass, then of the probe samples as well, and what is seen there.
  Film first_;
  std::vector<PixelSurface> surfaces_;
  // A mark a pixel: where probe samples are traced, and where all samples are.
  std::vector<std::uint8_t> edges_, contrasting_;
  std::optional<ProbeSamples> probes_;
  std::size_t samples_ = 0;  // number of samples of the probes' pattern
};

}  // namespace whit
