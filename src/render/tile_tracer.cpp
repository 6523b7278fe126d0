#include "render/tile_tracer.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "core/image.h"
#include "core/index.h"
#include "render/steps.h"

namespace whit {

namespace {

#ifndef NDEBUG

// The first steps of a process are checked, and then one in kInterval: enough to cover every kind
// of step, few enough to cost little.
constexpr std::uint64_t kFirstChecks = 200, kInterval = 97;

constexpr std::array kChecked{Part::rays,     Part::hits,          Part::surfels,
                              Part::radiance, Part::unshadowed,    Part::shadows,
                              Part::children, Part::parentRadiance};

template <typename Columns>
std::uint64_t sumOf(const Columns& columns, std::size_t n) {
  std::uint64_t sum = 0xcbf29ce484222325u;  // FNV-1a, a word at a time

  Columns::forEachColumn(columns, [&](const char*, const auto* column, Feature) {
    if (!column) return;
    for (const auto i : indices(n)) {
      std::uint32_t word = 0;
      std::memcpy(&word, column + i, sizeof word);
      sum = (sum ^ word) * 0x100000001b3u;
    }
  });
  return sum;
}

// A checksum of what each part holds; of children, those that were there before the step.
using Sums = std::array<std::uint64_t, kChecked.size()>;
Sums sumsOf(const Chunk& c) {
  return {sumOf(c.rays, c.n),
          sumOf(c.hits, c.n),
          sumOf(c.surfels, c.n),
          sumOf(c.radiance, c.n),
          sumOf(c.unshadowed, c.n),
          sumOf(c.shadows, c.shadowCount),
          sumOf(c.children, c.childCount),
          c.depth > 0 ? sumOf(c.parentRadiance, 1) : 0};
}

#endif

// Runs the step. Builds without NDEBUG hold it to its contract (stages/stage.h): a step that
// writes into a part of its chunk that it does not name ends the program with a message.
void runChecked(const Step& step, Chunk& chunk) {
#ifdef NDEBUG
  step.run(chunk);
#else
  static std::atomic<std::uint64_t> steps{0};
  const std::uint64_t number = steps++;
  const bool checks = number < kFirstChecks || number % kInterval == 0;

  const Chunk start = chunk;  // the columns are shared
  const Sums before = checks ? sumsOf(start) : Sums();
  step.run(chunk);
  const Sums after = checks ? sumsOf(start) : Sums();

  // A step that appends children must not change those that were there before.
  for (const auto i : indices(kChecked)) {
    const bool appends = kChecked[i] == Part::children && step.childrenAtEye > 0;
    if (after[i] == before[i] || (step.writes.has(kChecked[i]) && !appends)) continue;

    std::fprintf(stderr, "step %s has written into part %d, which its contract does not name\n",
                 step.name.c_str(), static_cast<int>(kChecked[i]));
    std::abort();
  }
#endif
}

}  // namespace

Workspace::Workspace(const Plan& plan, std::size_t capacity)
    : plan_(plan),
      capacity_(roundUpToBlock(capacity)),
      levels_(plan.depth + 2),  // the last one for paths that end
      hits_(capacity_, plan.features),
      surfels_(capacity_, plan.features) {
  if (plan.writes(Part::unshadowed)) unshadowed_.allocate(capacity_, plan.features);
  if (plan.has(Stage::checkShadows)) shadows_.allocate(capacity_, plan.features);
  reserveRays(0, capacity_);
}

void Workspace::reserveCodes(std::size_t pixels) { codes_.resize(roundUpToBlock(pixels) + kBlock); }

void Workspace::reserveRays(int depth, std::size_t rays) {
  Level& at = level(depth);
  if (at.rays.capacity() >= rays) return;

  at.rays.allocate(rays, plan_.features);
  if (at.radiance.capacity() == 0) at.radiance.allocate(capacity_, plan_.features);
  if (plan_.writes(Part::rayCounts)) at.rayCounts.resize(capacity_);
  if (plan_.limitsRays) at.pixelSlots.resize(at.rays.capacity());
}

void Workspace::startQueue(std::size_t rays) {
  Level& first = level(0);
  first.count = rays;
  first.segments[0] = {RayKind::primary, 0, rays};
  first.segmentCount = 1;
  first.cursor = 0;

  if (!plan_.limitsRays) return;

  // The first time the impulses of each sample are counted. When samples are traced again, the
  // widths of their rays are kept instead.
  std::iota(first.pixelSlots.begin(), first.pixelSlots.end(), 0u);
  followed_.assign(narrows_ ? 0 : rays, 0);
  if (narrows_) first.narrowings.assign(rays, {});
}

void Workspace::takeChunk(int depth, Chunk& chunk) {
  Level& at = level(depth);
  at.chunk = std::min(capacity_, at.count - at.cursor);
  returnTo(depth, chunk);

  // The segments of the queue are clipped to the chunk, which may hold several kinds of rays.
  chunk.segmentCount = 0;
  for (const auto s : indices(at.segmentCount)) {
    const auto within = [&](std::size_t i) {
      return std::clamp(i, at.cursor, at.cursor + at.chunk) - at.cursor;
    };

    const Segment& of = at.segments[s];
    const Segment part{of.kind, within(of.begin), within(of.end)};
    if (part.begin < part.end) chunk.segments[chunk.segmentCount++] = part;
  }

  chunk.coherent = depth <= plan_.coherentDepth;
  chunk.childCount = chunk.childSegmentCount = 0;
  chunk.shadowCount = 0;
  chunk.light = nullptr;
}

void Workspace::returnTo(int depth, Chunk& chunk) {
  Level& at = level(depth);
  chunk.depth = depth;
  chunk.first = at.cursor;
  chunk.n = at.chunk;
  chunk.rays = advanced(*at.rays, at.cursor);
  chunk.radiance = *at.radiance;
  chunk.rayCounts = at.rayCounts.data();
  if (plan_.limitsRays) {
    chunk.pixelSlots = at.pixelSlots.data() + at.cursor;
    chunk.followed = followed_.data();
    chunk.narrowings = narrows_ ? at.narrowings.data() + at.cursor : nullptr;
  }

  // Primary rays have no parents.
  chunk.parentRadiance = depth > 0 ? *level(depth - 1).radiance : RadianceColumns();
  chunk.parentRayCounts = depth > 0 ? level(depth - 1).rayCounts.data() : nullptr;

  // These columns exist only once, because one chunk is shaded at a time.
  chunk.hits = *hits_;
  chunk.surfels = *surfels_;
  chunk.unshadowed = *unshadowed_;
  chunk.shadows = *shadows_;
  chunk.codes = codes_.data();
}

void Workspace::returnToPixels(Chunk& chunk) {
  level(0).cursor = 0;
  returnTo(0, chunk);
}

void Workspace::reserveChildren(std::size_t count, Chunk& chunk) {
  reserveRays(chunk.depth + 1, count);
  Level& next = level(chunk.depth + 1);
  chunk.children = *next.rays;
  chunk.childPixelSlots = next.pixelSlots.data();
  if (narrows_ && next.narrowings.size() < count) next.narrowings.resize(count);
  chunk.childNarrowings = next.narrowings.data();
}

void Workspace::noteChildren(RayKind kind, std::size_t before, Chunk& chunk) {
  if (chunk.childCount <= before) return;

  Segment* last =
      chunk.childSegmentCount > 0 ? &chunk.childSegments[chunk.childSegmentCount - 1] : nullptr;
  if (!last || last->kind != kind) {
    last = &chunk.childSegments[chunk.childSegmentCount++];
    *last = {kind, before, before};
  }

  last->end = chunk.childCount;
}

bool Workspace::startQueueOfChildren(const Chunk& chunk) {
  if (chunk.childCount == 0) return false;

  Level& next = level(chunk.depth + 1);
  next.count = chunk.childCount;
  next.segments = chunk.childSegments;
  next.segmentCount = chunk.childSegmentCount;
  next.cursor = 0;
  return true;
}

BufferBytes Workspace::bufferBytes() const {
  BufferBytes bytes;
  for (const Level& level : levels_) {
    bytes.rays += level.rays.bytes();
    bytes.radiance += level.radiance.bytes();
    bytes.rayCounts += level.rayCounts.capacity() * sizeof(std::uint32_t);
    bytes.rays += level.pixelSlots.capacity() * sizeof(std::uint32_t) +
                  level.narrowings.capacity() * sizeof(Narrowing);
  }

  bytes.hits = hits_.bytes();
  bytes.surfels = surfels_.bytes();
  bytes.unshadowed = unshadowed_.bytes();
  bytes.shadows = shadows_.bytes();
  return bytes;
}

std::size_t Workspace::bytes() const {
  return bufferBytes().sum() + codes_.capacity() * sizeof(std::uint32_t);
}

TileTracer::TileTracer(const Plan& plan, std::size_t capacity)
    : plan_(plan), work_(plan, capacity) {}

std::size_t TileTracer::bytes() const {
  return work_.bytes() + sums_.capacity() * sizeof(SampleSum) + limited_.capacity();
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
    limited_.assign(plan_.limitsRays ? chunk_.pixels.size() : 0, 0);

    // A single sample is the mean itself, so that no sums are needed.
    if (frame.samples.size() == 1 && !frame.probes && !frame.sums) {
      chunk_.sample = frame.samples[0];
      chunk_.sampleNumber = 0;
      const std::size_t kept = keepsErrors(frame) ? chunk_.pixels.size() : 0;
      sums_.assign(kept, SampleSum());
      traceSample(watch);
    } else if (!traceSamples(frame, watch)) {
      return;
    }

    work_.returnToPixels(chunk_);
    if (keepsErrors(frame)) keepErrors(frame);
    for (const Step& step : plan_.perTile) run(step, stats);

    stats.nonFinitePixels += countNonFinite(chunk_);
    stats.limitedPixels += std::ranges::count(limited_, 1);
    clock.lap(Stage::updateImage, 0);
  }
}

// Leaves the mean over the samples so far. Returns false when the frame is given up.
bool TileTracer::traceSamples(const Frame& frame, const Watch& watch) {
  const std::size_t n = chunk_.pixels.size();
  sums_.assign(n, SampleSum());
  loadSums(frame);

  for (std::size_t s = frame.firstSample; s < frame.endSample; ++s) {
    if (frame.stops()) return false;

    chunk_.sample = frame.samples[s];
    chunk_.sampleNumber = static_cast<std::uint32_t>(s);
    traceSample(watch);
    work_.returnToPixels(chunk_);
    addSample(frame);
    if (frame.probes && frame.firstSample == 0) keepProbeCodes(frame);
  }

  storeSums(frame);
  const RadianceColumns& radiance = chunk_.radiance;
  for (const auto i : indices(n)) {
    radiance.rgb.set(i, Rgb(sums_[i].total / static_cast<double>(frame.endSample)));
  }

  return true;
}

void TileTracer::addSample(const Frame& frame) {
  const RadianceColumns& radiance = chunk_.radiance;
  const std::size_t n = chunk_.pixels.size();
  for (const auto i : indices(n)) {
    sums_[i].total += RgbD(radiance.rgb.at(i));
  }

  // The squares give the standard error; only the channel `error` and pictures that gain samples
  // over time use them.
  if (!frame.sums && !keepsErrors(frame)) return;
  for (const auto i : indices(n)) {
    const RgbD sample(radiance.rgb.at(i));
    sums_[i].squares += dot(sample, sample) / 3;
  }
}

void TileTracer::keepErrors(const Frame& frame) {
  const std::span<float> errors = frame.film->channels.floats(Channel::error);
  for (const auto i : indices(chunk_.pixels)) {
    const std::uint32_t pixel = chunk_.pixels[i];
    errors[2 * frame.film->image.index(pixelX(pixel), pixelY(pixel))] =
        static_cast<float>(sums_[i].standardError(static_cast<int>(frame.endSample)));
  }
}

void TileTracer::loadSums(const Frame& frame) {
  if (frame.firstSample == 0) return;

  for (const auto i : indices(chunk_.pixels)) {
    const int x = pixelX(chunk_.pixels[i]), y = pixelY(chunk_.pixels[i]);
    if (frame.probes) sums_[i].total = frame.probes->at(x, y).total;
    if (frame.sums) sums_[i] = frame.sums->at(x, y);
  }
}

void TileTracer::storeSums(const Frame& frame) {
  const bool toProbes = frame.probes && frame.firstSample == 0;
  if (!toProbes && !frame.sums) return;

  for (const auto i : indices(chunk_.pixels)) {
    const int x = pixelX(chunk_.pixels[i]), y = pixelY(chunk_.pixels[i]);
    if (toProbes) frame.probes->at(x, y).total = sums_[i].total;
    if (frame.sums) frame.sums->at(x, y) = sums_[i];
  }
}

void TileTracer::keepProbeCodes(const Frame& frame) {
  encodeForDisplay(chunk_);
  for (const auto i : indices(chunk_.n)) {
    const std::uint32_t pixel = chunk_.pixels[i];
    frame.probes->at(pixelX(pixel), pixelY(pixel)).codes[chunk_.sampleNumber] = chunk_.codes[i];
  }
}

// Traces one sample of each pixel of the batch.
void TileTracer::traceSample(const Watch& watch) {
  traceTrees(watch);
  if (!plan_.limitsRays) return;

  // Samples that were given up, because of --max-rays, are traced again as narrower trees.
  std::vector<std::uint32_t> tooLarge;
  for (std::uint32_t i = 0; i < chunk_.pixels.size(); ++i) {
    if (!chunk_.isGivenUp(i)) continue;
    tooLarge.push_back(i);
    limited_[i] = 1;
  }

  if (!tooLarge.empty()) traceNarrowed(tooLarge, watch);
}

// Traces the samples of these slots of the batch again, as narrower trees.
void TileTracer::traceNarrowed(const std::vector<std::uint32_t>& slots, const Watch& watch) {
  const std::span<const std::uint32_t> pixels = chunk_.pixels;
  std::vector<std::uint32_t> again;
  again.reserve(slots.size() + kListPadding);
  for (const std::uint32_t slot : slots) again.push_back(pixels[slot]);

  // The samples of the other pixels are put aside meanwhile.
  work_.returnToPixels(chunk_);
  std::vector<std::vector<float>> all;
  RadianceColumns::forEachColumn(chunk_.radiance, [&](const char*, const float* column, Feature) {
    all.emplace_back(column, column ? column + pixels.size() : column);
  });

  chunk_.pixels = again;
  work_.setNarrows(true);
  traceTrees(watch);
  work_.returnToPixels(chunk_);

  // The new samples are written into the values of all pixels, which are then restored.
  std::size_t number = 0;
  RadianceColumns::forEachColumn(chunk_.radiance, [&](const char*, float* column, Feature) {
    std::vector<float>& values = all[number++];
    if (!column) return;
    for (const auto i : indices(slots)) values[slots[i]] = column[i];
    std::ranges::copy(values, column);
  });

  work_.setNarrows(false);
  chunk_.pixels = pixels;
  work_.startQueue(pixels.size());
  work_.takeChunk(0, chunk_);
}

// Traces the ray trees of one sample of the batch's pixels through all depths.
void TileTracer::traceTrees(const Watch& watch) {
  work_.startQueue(chunk_.pixels.size());
  work_.takeChunk(0, chunk_);
  runSteps(plan_.perSample, watch);

  // Queues are walked depth first: a chunk is finished after all of its descendants.
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

  // At the last depth impulses serve only to bound the light that ended paths leave out.
  if (depth < plan_.depth || plan_.features.has(Feature::ended)) addImpulses(watch);
}

void TileTracer::addImpulses(const Watch& watch) {
  // Upper bound on the children of one surfel.
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
  runChecked(step, chunk_);
  ++stats.stepCalls[step.number];
  Workspace::noteChildren(step.childKind, children, chunk_);
}

void TileTracer::endStage(Stage stage, const Watch& watch) {
  if (watch.frameObserver) watch.frameObserver->after(stage, chunk_);
  watch.clock.lap(stage, chunk_.depth);

  // The time of waiting for the other workers belongs to no stage.
  if (watch.stageBarrier) {
    watch.stageBarrier->arrive_and_wait();
    watch.clock.skip();
  }

  // The time of an observer is not part of the frame's.
  if (!watch.observer) return;
  watch.observer->after(stage, chunk_);
  watch.clock.skip();
}

}  // namespace whit
