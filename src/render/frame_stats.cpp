#include "render/frame_stats.h"

namespace whit {

void FrameStats::add(const FrameStats& worker) {
  for (std::size_t i = 0; i < kStageCount; ++i) {
    stageWorkerMs[i] += worker.stageWorkerMs[i];
    kernelCalls[i] += worker.kernelCalls[i];
  }
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    tally[i].rays += worker.tally[i].rays;
    tally[i].lanes += worker.tally[i].lanes;
  }
  embreeWorkerMs += worker.embreeWorkerMs;
  reflectionCalls += worker.reflectionCalls;
  glossyCalls += worker.glossyCalls;
  refractionCalls += worker.refractionCalls;
  nonFinitePixels += worker.nonFinitePixels;
}

}  // namespace whit
