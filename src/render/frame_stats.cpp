#include "render/frame_stats.h"

namespace whit {

void FrameStats::add(const FrameStats& worker) {
  for (std::size_t i = 0; i < kStageCount; ++i) {
    stageWorkerMs[i] += worker.stageWorkerMs[i];
    stageCalls[i] += worker.stageCalls[i];
  }
  for (std::size_t i = 0; i < stepCalls.size(); ++i) stepCalls[i] += worker.stepCalls[i];
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    meter.tally[i].rays += worker.meter.tally[i].rays;
    meter.tally[i].lanes += worker.meter.tally[i].lanes;
  }
  meter.shadows.lit += worker.meter.shadows.lit;
  meter.shadows.dark += worker.meter.shadows.dark;
  if (!meter.wrongShadow) meter.wrongShadow = worker.meter.wrongShadow;
  meter.embreeMs += worker.meter.embreeMs;
  nonFinitePixels += worker.nonFinitePixels;
}

}  // namespace whit
