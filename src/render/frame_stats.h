// Times and counters of a frame, by stage, step and kind of ray.
#pragma once

#include <array>
#include <cstdint>

#include "simd/kernels.h"
#include "stages/chunk.h"
#include "stages/ray_kinds.h"
#include "stages/stage.h"

namespace whit {

// Times are summed over the workers; `stageMs` and `embreeMs` divide by their number, which gives
// the wall-clock share. All that happens below depth 0 counts as addImpulses.
struct FrameStats {
  double frameMs = 0;
  int workers = 1;
  std::array<double, kStageCount> stageWorkerMs{};
  TraceMeter meter;                                              // rays, and the time inside Embree
  std::array<std::uint64_t, kStageCount> stageCalls{};           // times that a stage has ended
  std::array<std::uint64_t, simd::kKernels.size()> stepCalls{};  // by Step::number
  std::uint64_t nonFinitePixels = 0;

  double stageMs(Stage s) const { return stageWorkerMs[static_cast<std::size_t>(s)] / workers; }
  double embreeMs() const { return meter.embreeMs / workers; }
  const RayTally& of(RayKind k) const { return meter.tally[static_cast<std::size_t>(k)]; }
  std::uint64_t callsOf(Stage s) const { return stageCalls[static_cast<std::size_t>(s)]; }
  std::uint64_t callsOf(const simd::Kernel& k) const { return stepCalls[simd::indexOf(k)]; }
  std::uint64_t allRays() const {
    std::uint64_t sum = 0;
    for (const RayTally& t : meter.tally) sum += t.rays;
    return sum;
  }
  void add(const FrameStats& worker);  // counters and times of one worker
};

}  // namespace whit
