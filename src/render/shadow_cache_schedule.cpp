#include "render/shadow_cache_schedule.h"

#include <algorithm>
#include <cmath>

#include "stages/lobes.h"

namespace whit {

namespace {

// Proving a part takes as long as tracing this many shadow rays, or twice as many (whit bench
// --ab-shadow-cache).
constexpr double kRaysAProof = 400;
// A part is expected to stay in view for at most this many frames of a moving camera.
constexpr std::size_t kFramesInView = 96;
// Measured in films along sponza-mirror's path: with 53 samples of pixels for each triangle they
// lost 6 % of their time by tables, with 264 they neither lost nor gained, with 337 they gained 4
// %.
constexpr double kSamplesATriangle = 250;
// One of the samples of a view is spent on collecting requests, if there are many.
constexpr std::size_t kFewestFrames = 2 * ShadowCacheSchedule::kTurns, kFewestSamples = 32;
constexpr double kMostCounted = 255;

std::size_t samplesOf(const Scene& scene, const RenderOptions& options) {
  return samplesAdaptively(options, scene.effects) ? 1 : static_cast<std::size_t>(options.spp);
}

bool pays(const Scene& scene, const RenderOptions& options, const ShadowCacheRun& run) {
  const std::size_t samples = samplesOf(scene, options);
  if (run.frames < kFewestFrames && samples < kFewestSamples) return false;
  const double traced = static_cast<double>(run.frames) * static_cast<double>(run.pixels) *
                        static_cast<double>(samples);
  return traced >= samplesThatPay(scene);
}

}  // namespace

double samplesThatPay(const Scene& scene) {
  return kSamplesATriangle * static_cast<double>(scene.triangles.size());
}

ShadowCacheSchedule::ShadowCacheSchedule(Renderer& renderer, const ShadowCacheRun& run)
    : renderer_(renderer), run_(run) {
  const RenderOptions& options = renderer.options();
  if (options.shadowCache == ShadowCacheMode::off || options.mode == Mode::reference) return;
  if (!audits() && !pays(renderer.scene(), options, run)) return;
  renderer_.expectFrames(run.mostBytes, audits() ? 1 : kTurns);
  used_ = renderer_.decidesShadows();
}

void ShadowCacheSchedule::prepare(const Camera& camera, Film& film) {
  const std::size_t samples = samplesOf(renderer_.scene(), renderer_.options());
  if (!used_ || done_ > 0) return;
  if (audits()) {
    renderer_.render(camera, film);
    return fill(1);
  }
  if (samples < kFewestSamples) return;
  const RenderOptions all = renderer_.options();
  RenderOptions one = all;
  one.spp = 1;
  renderer_.expectFrames(run_.mostBytes, 1);
  renderer_.setOptions(one);
  renderer_.render(camera, film);
  renderer_.setOptions(all);
  fill(static_cast<double>(samples * std::min(run_.frames, kFramesInView)));
  renderer_.expectFrames(run_.mostBytes, kTurns);
}

void ShadowCacheSchedule::frameDone() {
  if (!used_) return;
  ++done_;
  if (audits()) return fill(1);
  if (done_ % kTurns != 0 || done_ >= run_.frames) return;
  fill(static_cast<double>(std::min(run_.frames - done_, kFramesInView)));
}

// Each request is expected to occur this many more times.
void ShadowCacheSchedule::fill(double repeats) {
  const double least = audits() ? 1 : std::ceil(kRaysAProof / repeats);
  if (least <= kMostCounted) {
    fillMs_ += renderer_.fillShadowCache({.leastRays = static_cast<unsigned>(least)}).ms;
  }
  renderer_.forgetShadowRequests();
}

}  // namespace whit
