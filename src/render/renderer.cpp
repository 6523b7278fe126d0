#include "render/renderer.h"

#include <cmath>

#include "core/error.h"
#include "core/stopwatch.h"
#include "core/usable_threads.h"
#include "reference/initial_medium_stack.h"
#include "render/build_tables.h"
#include "render/embree_intersector.h"
#include "render/enclosure.h"
#include "render/renderer_parts.h"
#include "sampling/sample_pattern.h"
#include "simd/kernels.h"

namespace whit {

namespace {

// Embree's name for the ISA that goes with a kernel target.
std::string embreeIsa(const std::string& target) {
  if (target == "avx3" || target == "avx3_dl") return "avx512";
  if (target == "avx2") return "avx2";
  if (target == "sse4") return "sse4.2";
  if (target == "sse2" || target == "scalar") return "sse2";
  return "";
}

void chooseSimd(const std::string& name) {
  if (simd::chooseTarget(name)) return;
  std::string have;
  for (const std::string& target : simd::availableTargets()) have += " " + target;
  throwUsage("--simd " + name + " is not available here; there are: auto" + have);
}

}  // namespace

Renderer::Renderer(const Scene& scene, const RenderOptions& options, Progress* progress)
    : parts_(std::make_unique<Parts>(scene, options)) {
  const Stopwatch stopwatch;
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
  p.buildMs = stopwatch.ms();
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
         p.contrasting.capacity() + (p.probes ? p.probes->bytes() : 0);
  sum +=
      p.firstSamples.image.pixels.capacity() * sizeof(Rgb) + p.firstSamples.display.rgba.capacity();
  return sum;
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
      reference::initialMediumStack(scene, plan.effects, EmbreeIntersector(*accel), job.camera.eye);
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

FrameStats Renderer::render(const Camera& camera, Film& film) {
  FrameJob job = parts_->makeJob(camera, film, parts_->tracedWindow(film));
  return parts_->renderFrame(job, nullptr);
}

}  // namespace whit
