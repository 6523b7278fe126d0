// The reference's pictures, its candidates from Embree.
#include "core/display.h"
#include "core/stopwatch.h"
#include "reference/reference.h"
#include "render/embree_intersector.h"
#include "render/renderer_parts.h"

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

reference::Settings Renderer::Parts::referenceSettings() const {
  return {options, plan.effects, machine.threads};
}

FrameStats Renderer::renderReference(const Camera& camera, Film& film, Progress* progress) {
  Parts& p = *parts_;
  const Stopwatch stopwatch;
  p.lookFrom(camera.eye);
  const EmbreeIntersector intersector(*p.accel);
  const reference::RayCounts counts =
      reference::render(p.scene, intersector, camera, p.referenceSettings(), film.image, progress);
  if (film.wantDisplay) {
    film.display = toDisplay(film.image, p.options.exposure, p.options.toneCurve, p.options.srgb);
  }
  FrameStats stats;
  stats.frameMs = stopwatch.ms();
  stats.workers = p.machine.threads;
  const std::uint64_t rays[] = {counts.primary, counts.shadow, counts.reflection,
                                counts.refraction};
  for (std::size_t k = 0; k < kRayKindCount; ++k) stats.tally[k] = {rays[k], rays[k]};
  for (const Rgb& pixel : film.image.pixels) stats.nonFinitePixels += !isFinite(pixel);
  return stats;
}

}  // namespace whit
