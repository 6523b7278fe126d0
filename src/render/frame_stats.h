// What one frame cost, by stage and by kind of ray.
#pragma once

#include <array>
#include <cstdint>

#include "stages/ray_tally.h"
#include "stages/stage.h"

namespace whit {

// Times are summed over the workers; `stageMs` and `embreeMs` divide by their number, which gives
// the wall-clock share. All that happens below depth 0 counts as addImpulses.
struct FrameStats {
  double frameMs = 0;
  int workers = 1;
  std::array<double, kStageCount> stageWorkerMs{};
  double embreeWorkerMs = 0;
  std::array<RayTally, kRayKindCount> tally{};
  std::array<std::uint64_t, kStageCount> kernelCalls{};
  // The kernels of addImpulses.
  std::uint64_t reflectionCalls = 0, glossyCalls = 0, refractionCalls = 0;
  std::uint64_t nonFinitePixels = 0;

  double stageMs(Stage s) const { return stageWorkerMs[static_cast<std::size_t>(s)] / workers; }
  double embreeMs() const { return embreeWorkerMs / workers; }
  const RayTally& of(RayKind k) const { return tally[static_cast<std::size_t>(k)]; }
  std::uint64_t allRays() const {
    std::uint64_t sum = 0;
    for (const RayTally& t : tally) sum += t.rays;
    return sum;
  }
  void add(const FrameStats& worker);  // counters and times of one worker
};

}  // namespace whit
