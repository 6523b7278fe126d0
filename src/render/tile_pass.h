// What TileTracer hands from step to step.
#pragma once

#include "render/stage_clock.h"
#include "render/tile_tracer.h"
#include "simd/kernels.h"

namespace whit {

// One sample of one batch of pixels.
struct TileTracer::Pass {
  const FrameJob& job;
  std::span<const std::uint32_t> pixels;
  Vec2f sample;
  FrameStats& stats;
  StageClock& clock;
  RayLog* log;
  std::uint32_t sampleNumber = 0;  // of `sample`, in the pattern
  std::size_t children = 0;        // of the chunk that was shaded last
};

}  // namespace whit
