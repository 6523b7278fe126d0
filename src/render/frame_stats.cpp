#include "render/frame_stats.h"

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"

namespace whit {

void refuseNonFinite(const Scene& scene, const RenderOptions& options, const FrameStats& frame) {
  if (!options.strict || frame.nonFinitePixels == 0) return;
  throw Error(ExitStatus::badScene, concat(scene.name, ": the image has ", frame.nonFinitePixels,
                                           " pixels that are not finite (refused by --strict)"));
}

void FrameStats::add(const FrameStats& worker) {
  for (const auto i : indices(kStageCount)) {
    stageWorkerMs[i] += worker.stageWorkerMs[i];
    stageCalls[i] += worker.stageCalls[i];
  }
  for (const auto i : indices(stepCalls)) stepCalls[i] += worker.stepCalls[i];
  for (const auto i : indices(kRayKindCount)) {
    meter.tally[i].rays += worker.meter.tally[i].rays;
    meter.tally[i].lanes += worker.meter.tally[i].lanes;
  }
  meter.embreeMs += worker.meter.embreeMs;
  nonFinitePixels += worker.nonFinitePixels;
  limitedPixels += worker.limitedPixels;
}

}  // namespace whit
