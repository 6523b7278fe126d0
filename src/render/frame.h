// A frame: what all workers that trace it share. Read-only while it is traced, but for the film,
// the probe samples and the sums, of which each pixel is written by one worker.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/film.h"
#include "render/sample_sums.h"
#include "sampling/probe_samples.h"
#include "stages/chunk.h"

namespace whit {

// Called by the workers while they trace a frame, possibly several at a time.
struct FrameHooks {
  // Asked between tiles and between samples; null: never. True: the frame is given up, and its film
  // is useless.
  std::function<bool()> stop;
  // Called when the film holds the pixels of a tile; null: not wanted. Batches do not call it.
  std::function<void(std::span<const std::uint32_t> pixels)> finished;
};

// Sees each chunk of rays after each stage: comparison with the reference, debug views, ray logs.
class StageObserver {
 public:
  virtual ~StageObserver() = default;
  virtual void after(Stage stage, const Chunk& chunk) = 0;
};

struct Frame {
  FrameConstants constants;
  std::vector<Vec2f> samples;   // of each pixel, in the order of the pattern
  std::size_t firstSample = 0;  // those before it were traced for the probes, or are in `sums`
  std::size_t endSample = 0;    // the first that is not traced
  Film* film = nullptr;
  // Adaptive sampling stores its first samples here, or takes their sum from here.
  ProbeSamples* probes = nullptr;
  // Accumulation takes the sums of the earlier samples from here and stores the new sums here.
  SampleSums* sums = nullptr;
  // Part of the frame's work: sees the chunks of all workers, at the same time.
  StageObserver* observer = nullptr;
  const FrameHooks* hooks = nullptr;
  bool stops() const { return hooks && hooks->stop && hooks->stop(); }
};

}  // namespace whit
