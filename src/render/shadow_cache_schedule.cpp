// When a frame fills the shadow cache: if it has so many samples that proofs take less time than
// the rays that they save.
#include <cmath>

#include "render/renderer.h"
#include "stages/lobes.h"

namespace whit {

namespace {

// Proving a part takes as long as tracing this many shadow rays, or twice as many (whit bench
// --ab-shadow-cache).
constexpr double kRaysAProof = 400;
// Measured in films along sponza-mirror's path: with 53 samples of pixels for each triangle they
// lost 6 % of their time by tables, with 264 they neither lost nor gained, with 337 they gained 4
// %.
constexpr double kSamplesATriangle = 250;
// One sample is spent on collecting requests.
constexpr int kFewestSamples = 32;

bool pays(const Renderer& renderer, const Film& film) {
  const RenderOptions& options = renderer.options();
  if (samplesAdaptively(options, renderer.scene().effects)) return false;
  return options.spp >= kFewestSamples &&
         static_cast<double>(film.image.pixels.size()) * options.spp >=
             samplesThatPay(renderer.scene());
}

}  // namespace

double samplesThatPay(const Scene& scene) {
  return kSamplesATriangle * static_cast<double>(scene.triangles.size());
}

std::optional<double> prepareShadowCache(Renderer& renderer, std::uint64_t mostBytes,
                                         const Camera& camera, Film& film) {
  const RenderOptions all = renderer.options();
  const bool audit = all.shadowCache == ShadowCacheMode::audit;
  if (all.mode == Mode::reference || !(audit || pays(renderer, film))) return std::nullopt;
  renderer.expectFrames(mostBytes);
  if (!renderer.decidesShadows()) return std::nullopt;
  RenderOptions asking = all;
  if (!audit) asking.spp = 1;
  renderer.setOptions(asking);
  renderer.forgetShadowRequests();
  renderer.render(camera, film);
  renderer.setOptions(all);
  // Each request of that sample is expected to occur once more for each of the others.
  const double least = audit ? 1 : std::ceil(kRaysAProof / all.spp);
  return renderer.fillShadowCache({.leastRays = static_cast<unsigned>(least)}).ms;
}

}  // namespace whit
