#include <algorithm>

#include "bake/sphere.h"
#include "core/worker_pool.h"
#include "reference/add_impulses.h"
#include "reference/find_intersections.h"
#include "reference/generate_rays.h"
#include "reference/initial_medium_stack.h"
#include "reference/reference.h"
#include "reference/settle_coplanar.h"
#include "sampling/sample_pattern.h"

namespace whit::reference {

namespace {

Vec2f uvAt(const Scene& scene, std::uint32_t triangle, const TriangleHit& hit) {
  if (scene.isSphere(triangle)) {
    const std::array<double, 2> uv = sphereUv(spherePoint(hit.u, hit.v));
    return {static_cast<float>(uv[0]), static_cast<float>(uv[1])};
  }
  const TexturePoint point = texturePoint(scene.uvsOf(triangle, false), hit);
  return {static_cast<float>(point.u), static_cast<float>(point.v)};
}

}  // namespace

ChannelValues Tracer::channels(const CameraFrame& camera, int x, int y, const Vec2f& at,
                               std::size_t sample) const {
  const auto [ray, path] = primaryRay(camera, x, y, at, sample);
  const std::optional<Settled> met = nearest(ray, 0);
  ChannelValues values;
  if (!met) return values;
  const Candidate& candidate = met->candidate;
  const TriangleHit hit = refineHit(scene_, ray, candidate);
  Surfel surfel = surfelAt(ray, *met, hit);
  const MediaStack media = mediaAtStart(scene_, effects_, intersector_, camera, ray);
  limitDiffuse(
      scene_, effects_,
      crossMedia(scene_, effects_, surfel.material, surfel.entering, media, met->alsoCrossed),
      options_.shading, {path.number, lobeSampling(0, options_.glossy, path.sample)}, surfel);
  values.distance = static_cast<float>(hit.t);
  values.z = static_cast<float>(hit.t * dot(ray.direction, camera.forward));
  values.position = Vec3f(surfel.position);
  values.normal = Vec3f(surfel.shadingNormal);
  values.albedo = Rgb(surfel.diffuse);
  values.uv = uvAt(scene_, candidate.triangle, hit);
  const Scene::MetNumbers numbers = scene_.numbersOf(candidate.triangle, candidate.instance);
  values.object = numbers.item;
  values.triangle = numbers.triangle;
  values.material = surfel.material;
  return values;
}

void keepChannels(const Scene& scene, const Intersector& intersector, const Camera& camera,
                  const Settings& settings, const Image& image, ChannelLayers& layers) {
  const CameraFrame frame =
      frameWithMedia(scene, settings.effects, intersector, camera, image.width, image.height);
  const Tracer tracer(scene, intersector, settings);
  const int spp = tracer.samplesAdaptively() ? 1 : settings.options.spp;
  const std::vector<Vec2f> samples = samplePattern(spp);
  const std::size_t number = nearestToCenter(samples);
  const Crop& window = image.window;
  const auto rows = static_cast<std::size_t>(image.windowHeight());
  parallelFor(settings.threads, rows, [&](std::size_t row, int) {
    const int y = window.y0 + static_cast<int>(row);
    for (int x = window.x0; x < window.x1; ++x) {
      const std::size_t pixel = image.index(x, y);
      layers.keep(pixel, tracer.channels(frame, x, y, samples[number], number));
      if (!layers.channels().has(Channel::rays)) continue;
      RayCounts counts;
      tracer.sampled(frame, x, y, samples[number], number, counts);
      layers.numbers(Channel::rays)[pixel] = static_cast<std::uint32_t>(counts.all());
    }
  });
}

}  // namespace whit::reference
