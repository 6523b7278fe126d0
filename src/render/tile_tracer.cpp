#include "render/tile_tracer.h"

#include <algorithm>

#include "core/pixel.h"
#include "render/contract_check.h"
#include "render/update_image.h"

namespace whit {

TileTracer::TileTracer(const Plan& plan, std::size_t capacity)
    : plan_(plan), work_(plan, capacity) {}

std::size_t TileTracer::bytes() const { return work_.bytes() + sums_.capacity() * sizeof(RgbD); }

void TileTracer::trace(const Frame& frame, std::span<const std::uint32_t> pixels, FrameStats& stats,
                       std::barrier<>* stageBarrier, StageObserver* observer) {
  StageClock clock(stats);
  const Watch watch{stats, clock, stageBarrier, frame.observer, observer};
  chunk_.frame = &frame.constants;
  chunk_.film = frame.film;
  chunk_.meter = &stats.meter;
  for (std::size_t begin = 0; begin < pixels.size(); begin += work_.capacity()) {
    chunk_.pixels = pixels.subspan(begin, std::min(work_.capacity(), pixels.size() - begin));
    work_.reserveCodes(chunk_.pixels.size());
    if (frame.samples.size() == 1 && !frame.probes) {
      chunk_.sample = frame.samples[0];
      chunk_.sampleNumber = 0;
      traceSample(watch);
    } else {
      traceSamples(frame, watch);
    }
    work_.returnToPixels(chunk_);
    for (const Step& step : plan_.perTile) run(step, stats);
    stats.nonFinitePixels += countNonFinite(chunk_);
    clock.lap(Stage::updateImage, 0);
  }
}

// The mean over the frame's samples.
void TileTracer::traceSamples(const Frame& frame, const Watch& watch) {
  const std::size_t n = chunk_.pixels.size(), count = frame.samples.size();
  const auto probesOf = [&](std::size_t i) -> PixelProbes& {
    return frame.probes->at(pixelX(chunk_.pixels[i]), pixelY(chunk_.pixels[i]));
  };
  sums_.assign(n, RgbD());
  const bool goesOn = frame.firstSample > 0;
  for (std::size_t i = 0; goesOn && i < n; ++i) sums_[i] = probesOf(i).total;
  for (std::size_t s = frame.firstSample; s < count; ++s) {
    chunk_.sample = frame.samples[s];
    chunk_.sampleNumber = static_cast<std::uint32_t>(s);
    traceSample(watch);
    work_.returnToPixels(chunk_);
    const RadianceColumns& radiance = chunk_.radiance;
    for (std::size_t i = 0; i < n; ++i) {
      sums_[i] += RgbD(Rgb{radiance.r[i], radiance.g[i], radiance.b[i]});
    }
    if (frame.probes && !goesOn) keepProbeCodes(frame);
  }
  const RadianceColumns& radiance = chunk_.radiance;
  for (std::size_t i = 0; i < n; ++i) {
    if (frame.probes && !goesOn) probesOf(i).total = sums_[i];
    const Rgb mean(sums_[i] / static_cast<double>(count));
    radiance.r[i] = mean.x, radiance.g[i] = mean.y, radiance.b[i] = mean.z;
  }
}

void TileTracer::keepProbeCodes(const Frame& frame) {
  encodeForDisplay(chunk_);
  for (std::size_t i = 0; i < chunk_.n; ++i) {
    const std::uint32_t pixel = chunk_.pixels[i];
    frame.probes->at(pixelX(pixel), pixelY(pixel)).codes[chunk_.sampleNumber] = chunk_.codes[i];
  }
}

// One sample of the batch's pixels, through all depths.
void TileTracer::traceSample(const Watch& watch) {
  work_.startQueue(chunk_.pixels.size());
  work_.takeChunk(0, chunk_);
  runSteps(plan_.perSample, watch);
  for (int depth = 0;;) {
    if (work_.hasMore(depth)) {
      shadeChunk(depth, watch);
      if (work_.startQueueOfChildren(chunk_)) {
        ++depth;
      } else {
        finishChunk(depth, watch);
      }
      continue;
    }
    if (depth == 0) return;
    // The queue is drained: the chunk that it came from is complete.
    --depth;
    work_.returnTo(depth, chunk_);
    finishChunk(depth, watch);
  }
}

void TileTracer::shadeChunk(int depth, const Watch& watch) {
  work_.takeChunk(depth, chunk_);
  runSteps(plan_.perQueue, watch);
  for (const LightSteps& light : plan_.perLight) {
    chunk_.turnTo(light.light, light.sample, light.samples);
    runSteps(light.steps, watch);
  }
  if (depth < plan_.depth) addImpulses(watch);
}

void TileTracer::addImpulses(const Watch& watch) {
  std::size_t most = 0;
  for (const Step& step : plan_.impulses) {
    if (step.functionFor(chunk_.materialFlags)) most += step.childrenAt(chunk_.depth);
  }
  work_.reserveChildren(most * roundUpToBlock(chunk_.n), chunk_);
  runSteps(plan_.impulses, watch);
}

void TileTracer::finishChunk(int depth, const Watch& watch) {
  const std::vector<Step>& steps = depth > 0 ? plan_.onReturn : plan_.atEye;
  for (const Step& step : steps) run(step, watch.stats);
  if (!steps.empty()) watch.clock.lap(Stage::addImpulses, depth);
  work_.finishChunk(depth);
}

void TileTracer::runSteps(const std::vector<Step>& steps, const Watch& watch) {
  for (const Step& step : steps) {
    run(step, watch.stats);
    if (step.endsStage) endStage(step.stage, watch);
  }
}

void TileTracer::run(const Step& step, FrameStats& stats) {
  const StepFunction function = step.functionFor(chunk_.materialFlags);
  if (!function) return;
  const std::size_t children = chunk_.childCount;
  {
    const ContractCheck check(step, chunk_);
    function(chunk_);
  }
  ++stats.stepCalls[step.number];
  Workspace::noteChildren(step.childKind, children, chunk_);
}

void TileTracer::endStage(Stage stage, const Watch& watch) {
  if (watch.frameObserver) watch.frameObserver->after(stage, chunk_);
  watch.clock.lap(stage, chunk_.depth);
  if (watch.stageBarrier) {
    watch.stageBarrier->arrive_and_wait();
    watch.clock.skip();
  }
  if (!watch.observer) return;
  watch.observer->after(stage, chunk_);
  watch.clock.skip();
}

}  // namespace whit
