// The reference's pictures, its candidates from Embree.
#include "core/display.h"
#include "core/stopwatch.h"
#include "reference/reference.h"
#include "render/embree_intersector.h"
#include "render/renderer.h"

namespace whit {

bool EmbreeIntersector::closest(const reference::Ray& ray, reference::Candidate& c) const {
  float t = 0, u = 0, v = 0;
  if (!accel_.closest(Vec3f(ray.origin), Vec3f(ray.direction), c.triangle, c.instance, t, u, v)) {
    return false;
  }
  c.u = static_cast<double>(u);
  c.v = static_cast<double>(v);
  return true;
}

bool EmbreeIntersector::occluded(const reference::Ray& ray, double tFar) const {
  return accel_.occluded(Vec3f(ray.origin), Vec3f(ray.direction), static_cast<float>(tFar));
}

reference::Settings Renderer::referenceSettings() const {
  reference::Settings settings;
  settings.spp = options_.spp;
  settings.adaptive = adaptive();
  settings.contrast = options_.contrast;
  settings.exposure = options_.exposure;
  settings.toneCurve = options_.toneCurve;
  settings.srgb = options_.srgb;
  settings.film = options_.film;
  settings.depth = options_.depth;
  settings.glossy = options_.glossy;
  settings.cutoff = static_cast<double>(options_.cutoff);
  settings.shading = options_.shading;
  settings.effects = plan_.effects;
  settings.threads = machine_.threads;
  return settings;
}

FrameStats Renderer::renderReference(const Camera& camera, Film& film, Progress* progress) {
  const Stopwatch stopwatch;
  lookFrom(camera, film);
  const EmbreeIntersector intersector(*accel_);
  const reference::RayCounts counts =
      reference::render(scene_, intersector, camera, referenceSettings(), film.image, progress);
  if (film.wantDisplay) {
    film.display = toDisplay(film.image, options_.exposure, options_.toneCurve, options_.srgb);
  }
  FrameStats stats;
  stats.frameMs = stopwatch.ms();
  stats.workers = machine_.threads;
  const std::uint64_t rays[] = {counts.primary, counts.shadow, counts.reflection,
                                counts.refraction};
  for (std::size_t k = 0; k < kRayKindCount; ++k) stats.meter.tally[k] = {rays[k], rays[k]};
  for (const Rgb& pixel : film.image.pixels) stats.nonFinitePixels += !isFinite(pixel);
  return stats;
}

}  // namespace whit
