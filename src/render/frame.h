// A frame: what all workers that trace it share. Read-only while it is traced, but for the film and
// the probe samples, of which each pixel is written by one worker.
#pragma once

#include <vector>

#include "render/film.h"
#include "render/observer.h"
#include "sampling/probe_samples.h"
#include "stages/chunk.h"

namespace whit {

struct Frame {
  FrameConstants constants;
  std::vector<Vec2f> samples;   // of each pixel, in the order of the pattern
  std::size_t firstSample = 0;  // those before it were traced for the probes
  Film* film = nullptr;
  // Of adaptive sampling: where the first samples go, or whence their sum comes.
  ProbeSamples* probes = nullptr;
  // Part of the frame's work: sees the chunks of all workers, at the same time.
  StageObserver* observer = nullptr;
};

}  // namespace whit
