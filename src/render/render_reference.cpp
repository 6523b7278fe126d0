// The reference's pictures, its candidates from Embree.
#include "core/display.h"
#include "core/stopwatch.h"
#include "reference/initial_medium_stack.h"
#include "reference/reference.h"
#include "render/embree_intersector.h"
#include "render/renderer.h"

namespace whit {

bool EmbreeIntersector::closest(const reference::Ray& ray, reference::Candidate& c) const {
  const Hit hit =
      accel_.closest(Vec3f(ray.origin), Vec3f(ray.direction), static_cast<float>(ray.tNear));
  c.triangle = hit.triangle;
  c.instance = hit.instance;
  c.u = static_cast<double>(hit.u);
  c.v = static_cast<double>(hit.v);
  return hit.found();
}

bool EmbreeIntersector::occluded(const reference::Ray& ray, double tFar) const {
  return accel_.occluded(Vec3f(ray.origin), Vec3f(ray.direction), static_cast<float>(tFar));
}

reference::Settings Renderer::referenceSettings() const {
  return {options_, plan_.effects, machine_.threads};
}

CameraFrame Renderer::referenceFrame(const Camera& camera, const Film& film) {
  lookFrom(camera, film);
  return reference::frameWithMedia(scene_, plan_.effects, EmbreeIntersector(*accel_), camera,
                                   film.image.width, film.image.height);
}

FrameStats Renderer::renderReference(const Camera& camera, Film& film, Progress* progress) {
  const Stopwatch stopwatch;
  lookFrom(camera, film);
  const EmbreeIntersector intersector(*accel_);
  const reference::RayCounts counts =
      reference::render(scene_, intersector, camera, referenceSettings(), film.image, progress);
  film.channels.resize(plan_.channels, film.image.pixels.size());
  if (!plan_.channels.empty()) {
    reference::keepChannels(scene_, intersector, camera, referenceSettings(), film.image,
                            film.channels);
  }
  if (film.wantDisplay) {
    film.display = toDisplay(film.image, options_.exposure.ev, options_.toneCurve, options_.srgb);
  }
  FrameStats stats;
  stats.frameMs = stopwatch.ms();
  stats.workers = machine_.threads;
  for (std::size_t k = 0; k < kRayKindCount; ++k) {
    const std::uint64_t rays = counts[static_cast<RayKind>(k)];
    stats.meter.tally[k] = {rays, rays};
  }
  for (const Rgb& pixel : film.image.pixels) stats.nonFinitePixels += !isFinite(pixel);
  return stats;
}

}  // namespace whit
