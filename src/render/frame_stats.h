// Times and counters of a frame.
#pragma once

#include <array>
#include <cstdint>

#include "bake/scene.h"
#include "core/options.h"
#include "simd/kernels.h"
#include "stages/chunk.h"
#include "stages/ray_kinds.h"
#include "stages/stage.h"

namespace whit {

// By stage, step and kind of ray. Times are summed over the workers;
// `stageMs` and `embreeMs` divide by their number, which gives the wall-clock share. All that
// happens below depth 0 counts as addImpulses.
struct FrameStats {
  double frameMs = 0;
  int workers = 1;
  std::array<double, kStageCount> stageWorkerMs{};
  TraceMeter meter;                                              // rays, and the time inside Embree
  std::array<std::uint64_t, kStageCount> stageCalls{};           // times that a stage has ended
  std::array<std::uint64_t, simd::kKernels.size()> stepCalls{};  // indexed by Step::number
  std::uint64_t nonFinitePixels = 0;
  // Pixels of which a sample had more rays than --max-rays; with --adaptive once for each pass.
  std::uint64_t limitedPixels = 0;

  double stageMs(Stage s) const { return entryOf(stageWorkerMs, s) / workers; }
  double embreeMs() const { return meter.embreeMs / workers; }
  const RayTally& of(RayKind k) const { return entryOf(meter.tally, k); }
  std::uint64_t callsOf(Stage s) const { return entryOf(stageCalls, s); }
  std::uint64_t callsOf(const simd::Kernel& k) const { return stepCalls[simd::indexOf(k)]; }
  std::uint64_t allRays() const {
    std::uint64_t sum = 0;
    for (const RayTally& t : meter.tally) sum += t.rays;
    return sum;
  }
  void add(const FrameStats& worker);  // counters and times of one worker
};

// Throws Error(badScene) for a frame with pixels that are not finite when the options are strict.
void refuseNonFinite(const Scene& scene, const RenderOptions& options, const FrameStats& frame);

}  // namespace whit
