// A frame describes which pixels and samples of a picture are traced, and holds what the workers
// that trace it share.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/choose_camera.h"
#include "render/film.h"
#include "render/frame_stats.h"
#include "render/sample_sums.h"
#include "render/stage_observer.h"
#include "sampling/adaptive_pixels.h"

namespace whit {

// Samples of the pattern, [first, end).
struct SampleRange {
  int first = 0, end = 0;
};

// Called by the workers while they trace a frame, possibly several at a time.
struct FrameHooks {
  // Asked between tiles and between samples; null: never. True: the frame is given up, and its film
  // is useless.
  std::function<bool()> stop;
  // Called when the film holds the pixels of a tile; null: not wanted. Batches do not call it.
  std::function<void(std::span<const std::uint32_t> pixels)> finished;
};

// Packed pixels (core/image.h), which a worker takes a list at a time.
using PixelLists = std::vector<std::vector<std::uint32_t>>;
// Number of entries behind the end of a list, because kernels read whole vectors of pixels.
inline constexpr std::size_t kListPadding = 2 * kBlock;

// Says which part of a picture is traced. The default is all samples of the film's pixels; with
// --adaptive only the samples that are needed are traced.
struct TraceRequest {
  const Camera& camera;
  Film& film;  // its image has its size and window
  // Pixels in place of the film's, in lists as render/scheduler.h makes them for tiles.
  const PixelLists* pixels = nullptr;
  // Samples in place of the options' pattern.
  const std::vector<Vec2f>* pattern = nullptr;
  // With `sums` some of the samples are traced and added to the sums, which have those before them
  // and whose window holds the film's. The film shows the mean of all so far: with the last sample
  // it is the picture, bit for bit.
  SampleRange part = {};
  SampleSums* sums = nullptr;
  // See Frame::observers. `uniform`: they see all samples of all pixels, whatever --adaptive says.
  std::span<StageObserver* const> observers = {};
  bool uniform = false;
  const FrameHooks* hooks = nullptr;
};

// Read-only while it is traced, but for the film, the probe samples and the sums, of which each
// pixel is written by one worker.
struct Frame {
  FrameConstants constants;
  std::vector<Vec2f> samples;   // samples of each pixel in the order of the pattern
  std::size_t firstSample = 0;  // earlier ones were traced for the probes, or are in `sums`
  std::size_t endSample = 0;    // the first that is not traced
  Film* film = nullptr;
  // Adaptive sampling stores its first samples here, or takes their sum from here.
  ProbeSamples* probes = nullptr;
  // Accumulation takes the sums of the earlier samples from here and stores the new sums here.
  SampleSums* sums = nullptr;
  // Part of the frame's work: sees the chunks of all workers, at the same time.
  StageObserver* observer = nullptr;
  // If there are any, each sees the chunks of one worker, which traces tile by tile, and workers
  // without one rest. Their time is not the frame's. There must not be more of them than workers.
  std::span<StageObserver* const> observers;
  const FrameHooks* hooks = nullptr;
  bool stops() const { return hooks && hooks->stop && hooks->stop(); }
};

}  // namespace whit
