#include "render/renderer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "core/error.h"
#include "reference/eye_media.h"
#include "render/build_tables.h"
#include "render/embree_intersector.h"
#include "render/enclosure.h"
#include "render/renderer_parts.h"
#include "render/tiles.h"

namespace whit {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Embree's name for the ISA that goes with a kernel target.
std::string embreeIsa(const std::string& target) {
  if (target == "avx3" || target == "avx3_dl") return "avx512";
  if (target == "avx2") return "avx2";
  if (target == "sse4") return "sse4.2";
  if (target == "sse2" || target == "scalar") return "sse2";
  return "";
}

// What Renderer::setOptions() takes over.
void takeOver(const RenderOptions& from, RenderOptions& to) {
  to.spp = from.spp;
  to.adaptive = from.adaptive;
  to.contrast = from.contrast;
  to.impulseRate = from.impulseRate;
  to.shadowRate = from.shadowRate;
  to.depth = from.depth;
  to.glossy = from.glossy;
  to.cutoff = from.cutoff;
  to.shading = from.shading;
  to.exposure = from.exposure;
  to.toneCurve = from.toneCurve;
  to.film = from.film;
  to.srgb = from.srgb;
  to.effects = from.effects;
  to.disable = from.disable;
}

// What is said to each frame anew, or means nothing to a renderer.
void takeOverFrame(const RenderOptions& from, RenderOptions& to) {
  to.size = from.size;
  to.crop = from.crop;
  to.camera = from.camera;
  to.eye = from.eye;
  to.at = from.at;
  to.up = from.up;
  to.fov = from.fov;
  to.ortho = from.ortho;
  to.mode = from.mode;
  to.quality = from.quality;
  to.strict = from.strict;
}

void chooseSimd(const std::string& name) {
  if (simd::chooseTarget(name)) return;
  std::string have;
  for (const std::string& target : simd::availableTargets()) have += " " + target;
  throwUsage("--simd " + name + " is not available here; there are: auto" + have);
}

// What the acceleration structure has built in of a plan's effects.
EffectSet builtIn(const Plan& plan) {
  constexpr EffectSet kBuiltIn = EffectSet().with(Effect::alphaMasks).with(Effect::instances);
  return EffectSet(plan.effects.bits() & kBuiltIn.bits());
}

}  // namespace

Renderer::Renderer(const Scene& scene, const RenderOptions& options, Progress* progress)
    : parts_(std::make_unique<Parts>(scene, options)) {
  const Clock::time_point start = Clock::now();
  Parts& p = *parts_;
  chooseSimd(options.simd);
  p.plan = makePlan(scene, options);
  p.machine.threads = options.threads > 0 ? options.threads : usableThreads();
  AccelOptions accel;
  accel.robust = options.robust;
  accel.quality = options.bvh;
  accel.alphaMasks = p.plan.effects.has(Effect::alphaMasks);
  accel.instances = p.plan.effects.has(Effect::instances);
  accel.threads = p.machine.threads;
  accel.packet = options.packet;
  // Also when the target was chosen by itself: kernels of another target than the processor's best,
  // as in sanitized builds, would else meet an Embree that asking for that target by name does not
  // give.
  accel.isa = embreeIsa(simd::chosenTarget());
  p.accel.emplace(scene, accel, progress);
  p.enclosed = options.robust && options.retry && isEnclosed(scene, *p.accel);
  p.tables = buildTables(scene, p.plan.effects, options.shading, p.machine.threads);
  p.pool.emplace(p.machine.threads);
  p.machine.simd = simd::chosenTarget();
  p.machine.embree = p.accel->description();
  p.machine.packet = p.accel->packet();
  p.buildMs = since(start);
}

Renderer::~Renderer() = default;

const Plan& Renderer::plan() const { return parts_->plan; }
const Machine& Renderer::machine() const { return parts_->machine; }
double Renderer::buildMs() const { return parts_->buildMs; }

std::uint64_t Renderer::memoryBytes() const {
  const Parts& p = *parts_;
  std::uint64_t sum = p.accel->memoryBytes() + p.tables.texels.size() * sizeof(std::uint32_t);
  for (const TileTracer& tracer : p.tracers) sum += tracer.bytes();
  sum += p.surfaces.capacity() * sizeof(PixelSurface) + p.edges.capacity() +
         p.contrasting.capacity() + (p.pilots ? p.pilots->bytes() : 0);
  sum +=
      p.firstSamples.image.pixels.capacity() * sizeof(Rgb) + p.firstSamples.display.rgba.capacity();
  return sum;
}

void Renderer::Parts::layOut(const Crop& window) {
  if (!tracers.empty() && laidOut == window) return;
  laidOut = window;
  tiles = makeTiles(laidOut, options.tile);
  batches.clear();
  const auto workers = static_cast<std::size_t>(machine.threads);
  const auto side = static_cast<std::size_t>(options.tile);
  std::size_t capacity = side * side;
  if (options.batch == Batch::frame) {
    batches = dealOut(tiles, workers);
    capacity = kBlock;
    for (const auto& batch : batches) capacity = std::max(capacity, batch.size());
  }
  if (options.queue > 0) capacity = static_cast<std::size_t>(options.queue);
  if (tracers.empty() || capacity != tracerCapacity) {
    tracers.clear();
    tracers.reserve(workers);
    for (std::size_t i = 0; i < workers; ++i) tracers.emplace_back(plan, capacity);
    tracerCapacity = capacity;
  }
  padForVectors(tiles);
  padForVectors(batches);
}

void sizeDisplay(Film& film) {
  if (!film.wantDisplay) return;
  film.display.width = film.image.windowWidth();
  film.display.height = film.image.windowHeight();
  film.display.rgba.resize(film.image.pixels.size() * 4);
}

void Renderer::Parts::lookFrom(const Vec3f& eye) {
  if (!enclosed || lookedFrom == eye) return;
  lookedFrom = eye;
  accel->setEnclosed(false);
  accel->setEnclosed(isEnclosed(*accel, eye));
}

FrameJob Renderer::Parts::makeJob(const Camera& camera, Film& film, const Crop& window) {
  layOut(window);
  lookFrom(camera.eye);
  sizeDisplay(film);
  FrameJob job;
  job.plan = &plan;
  job.tables = &tables;
  job.accel = &*accel;
  job.camera = makeCameraFrame(camera, film.image.width, film.image.height);
  job.camera.media =
      reference::mediaAround(scene, plan.effects, EmbreeIntersector(*accel), job.camera.eye);
  job.coneSpread = static_cast<float>(pixelCone(job.camera).spread);
  job.samples = samplePattern(options.spp);
  job.cutoff = options.cutoff;
  job.exposureScale = std::exp2(options.exposure);
  job.toneCurve = options.toneCurve;
  job.precision = options.film;
  job.srgb = options.srgb;
  job.film = &film;
  return job;
}

FrameStats Renderer::Parts::renderTiles(FrameJob& job, const PixelLists& lists,
                                        std::vector<RayLog>* logs) {
  std::atomic<std::size_t> next{0};
  std::vector<FrameStats> stats(tracers.size());
  const std::size_t firstLog = logs ? logs->size() : 0;
  if (logs) logs->resize(firstLog + lists.size());
  pool->run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    FrameStats mine;  // on this worker's stack: no cache line is shared while the frame runs
    for (std::size_t i = next++; i < lists.size(); i = next++) {
      tracers[w].trace(job, lists[i], mine, logs ? &(*logs)[firstLog + i] : nullptr);
    }
    stats[w] = mine;
  });
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  return sum;
}

FrameStats Renderer::Parts::renderBatches(FrameJob& job, const PixelLists& lists) {
  std::barrier<> stageBarrier(static_cast<std::ptrdiff_t>(tracers.size()));
  job.stageBarrier = &stageBarrier;
  std::vector<FrameStats> stats(tracers.size());
  pool->run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    FrameStats mine;
    // Also when memory runs out: the others may have deeper queues, and would wait for ever.
    const std::unique_ptr<std::barrier<>, void (*)(std::barrier<>*)> leave(
        &stageBarrier, [](std::barrier<>* barrier) { barrier->arrive_and_drop(); });
    tracers[w].trace(job, lists[w], mine, nullptr);
    stats[w] = mine;
  });
  job.stageBarrier = nullptr;
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  return sum;
}

FrameStats Renderer::Parts::renderLists(FrameJob& job, const PixelLists& tileLists,
                                        const PixelLists& batchLists, std::vector<RayLog>* logs) {
  return options.batch == Batch::frame && !logs ? renderBatches(job, batchLists)
                                                : renderTiles(job, tileLists, logs);
}

FrameStats Renderer::Parts::renderFrame(FrameJob& job, std::vector<RayLog>* logs) {
  const Clock::time_point start = Clock::now();
  FrameStats stats =
      inPasses() ? renderInPasses(job, logs) : renderLists(job, tiles, batches, logs);
  stats.frameMs = since(start);
  stats.workers = machine.threads;
  return stats;
}

FrameStats Renderer::Parts::renderObserved(const FrameJob& job,
                                           std::span<StageObserver* const> observers) {
  std::atomic<std::size_t> next{0};
  std::vector<FrameStats> stats(observers.size());
  const Clock::time_point start = Clock::now();
  pool->run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    if (w >= observers.size()) return;
    FrameJob mine = job;
    mine.observer = observers[w];
    for (std::size_t i = next++; i < tiles.size(); i = next++) {
      tracers[w].trace(mine, tiles[i], stats[w], nullptr);
    }
  });
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  sum.frameMs = since(start);
  return sum;
}

void Renderer::Parts::replan(const Plan& next) {
  const bool otherQueues =
      next.groups != plan.groups || next.effects != plan.effects || next.depth != plan.depth;
  plan = next;
  if (otherQueues) tracers.clear();  // laid out again by the next frame
}

void Renderer::shadingChanged() {
  Parts& p = *parts_;
  const Plan plan = makePlan(p.scene, p.options);
  if (plan.effects == p.plan.effects) {
    refreshShading(p.scene, plan.effects, p.machine.threads, p.tables);
  } else {
    p.tables = buildTables(p.scene, plan.effects, p.options.shading, p.machine.threads);
  }
  p.replan(plan);
}

void Renderer::setOptions(const RenderOptions& options) {
  Parts& p = *parts_;
  const Plan plan = makePlan(p.scene, options);
  if (builtIn(plan) != builtIn(p.plan)) {
    throwUsage(
        "alpha masks and instances are part of the acceleration structure: it has to be built "
        "anew");
  }
  const bool lacksMips = plan.groups.cones && p.tables.mipLevels.empty();
  if (plan.effects != p.plan.effects || lacksMips) {
    p.tables = buildTables(p.scene, plan.effects, options.shading, p.machine.threads);
  }
  p.tables.shading = options.shading;
  p.replan(plan);
  if (options.spp != p.options.spp) p.pilots.reset();
  takeOver(options, p.options);
}

bool Renderer::canSetOptions(const RenderOptions& options) const {
  const Parts& p = *parts_;
  RenderOptions reached = p.options;
  takeOver(options, reached);
  takeOverFrame(options, reached);
  return reached == options && builtIn(makePlan(p.scene, options)) == builtIn(p.plan);
}

FrameStats Renderer::render(const Camera& camera, Film& film) {
  FrameJob job = parts_->makeJob(camera, film, parts_->tracedWindow(film));
  return parts_->renderFrame(job, nullptr);
}

FloorResult Renderer::measureFloor(const Camera& camera, Film& film, int frames) {
  Parts& p = *parts_;
  FrameJob job = p.makeJob(camera, film, p.tracedWindow(film));
  std::vector<RayLog> logs;
  p.renderFrame(job, &logs);
  FloorResult result;
  for (const RayLog& log : logs) {
    for (const RayLog::Stream& stream : log.streams()) result.rays += stream.rays.size() / 7;
  }
  std::vector<double> floors, whole;
  for (int frame = 0; frame < std::max(frames, 1); ++frame) {
    whole.push_back(p.renderFrame(job, nullptr).frameMs);
    std::atomic<std::size_t> next{0};
    std::vector<double> ms(p.tracers.size());
    p.pool->run([&](int worker) {
      double mine = 0;
      for (std::size_t i = next++; i < logs.size(); i = next++) mine += p.accel->replay(logs[i]);
      ms[static_cast<std::size_t>(worker)] = mine;
    });
    double sum = 0;
    for (const double m : ms) sum += m;
    floors.push_back(sum / p.machine.threads);
  }
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(),
                     values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  result.floorMs = median(floors);
  result.frameMs = median(whole);
  return result;
}

}  // namespace whit
