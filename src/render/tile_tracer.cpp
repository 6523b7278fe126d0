#include "render/tile_tracer.h"

#include <algorithm>

#include "core/pixel.h"
#include "render/contract_check.h"
#include "render/update_image.h"

namespace whit {

TileTracer::TileTracer(const Plan& plan, std::size_t capacity)
    : plan_(plan), work_(plan, capacity) {}

std::size_t TileTracer::bytes() const {
  return work_.bytes() + sums_.capacity() * sizeof(SampleSum);
}

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
    if (frame.samples.size() == 1 && !frame.probes && !frame.sums) {
      chunk_.sample = frame.samples[0];
      chunk_.sampleNumber = 0;
      traceSample(watch);
    } else if (!traceSamples(frame, watch)) {
      return;
    }
    work_.returnToPixels(chunk_);
    for (const Step& step : plan_.perTile) run(step, stats);
    stats.nonFinitePixels += countNonFinite(chunk_);
    clock.lap(Stage::updateImage, 0);
  }
}

// Leaves the mean over the samples so far. Returns false when the frame is given up.
bool TileTracer::traceSamples(const Frame& frame, const Watch& watch) {
  const std::size_t n = chunk_.pixels.size();
  sums_.assign(n, SampleSum());
  takeUpSums(frame);
  for (std::size_t s = frame.firstSample; s < frame.endSample; ++s) {
    if (frame.stops()) return false;
    chunk_.sample = frame.samples[s];
    chunk_.sampleNumber = static_cast<std::uint32_t>(s);
    traceSample(watch);
    work_.returnToPixels(chunk_);
    addSample(frame);
    if (frame.probes && frame.firstSample == 0) keepProbeCodes(frame);
  }
  leaveSums(frame);
  const RadianceColumns& radiance = chunk_.radiance;
  for (std::size_t i = 0; i < n; ++i) {
    const Rgb mean(sums_[i].total / static_cast<double>(frame.endSample));
    radiance.r[i] = mean.x, radiance.g[i] = mean.y, radiance.b[i] = mean.z;
  }
  return true;
}

void TileTracer::addSample(const Frame& frame) {
  const RadianceColumns& radiance = chunk_.radiance;
  const std::size_t n = chunk_.pixels.size();
  for (std::size_t i = 0; i < n; ++i) {
    sums_[i].total += RgbD(Rgb{radiance.r[i], radiance.g[i], radiance.b[i]});
  }
  if (!frame.sums) return;
  for (std::size_t i = 0; i < n; ++i) {
    const double mean = (double{radiance.r[i]} + double{radiance.g[i]} + double{radiance.b[i]}) / 3;
    sums_[i].squares += mean * mean;
  }
}

void TileTracer::takeUpSums(const Frame& frame) {
  for (std::size_t i = 0; frame.firstSample > 0 && i < chunk_.pixels.size(); ++i) {
    const int x = pixelX(chunk_.pixels[i]), y = pixelY(chunk_.pixels[i]);
    if (frame.probes) sums_[i].total = frame.probes->at(x, y).total;
    if (frame.sums) sums_[i] = frame.sums->at(x, y);
  }
}

void TileTracer::leaveSums(const Frame& frame) {
  const bool toProbes = frame.probes && frame.firstSample == 0;
  for (std::size_t i = 0; (toProbes || frame.sums) && i < chunk_.pixels.size(); ++i) {
    const int x = pixelX(chunk_.pixels[i]), y = pixelY(chunk_.pixels[i]);
    if (toProbes) frame.probes->at(x, y).total = sums_[i].total;
    if (frame.sums) frame.sums->at(x, y) = sums_[i];
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
    if (step.runsFor(chunk_.materialFlags)) most += step.childrenAt(chunk_.depth);
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
  if (!step.runsFor(chunk_.materialFlags)) return;
  const std::size_t children = chunk_.childCount;
  {
    const ContractCheck check(step, chunk_);
    step.run(chunk_);
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
