#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <vector>

#include "bake/sphere.h"
#include "core/display.h"
#include "core/index.h"
#include "core/worker_pool.h"
#include "reference/add_impulses.h"
#include "reference/find_intersections.h"
#include "reference/generate_rays.h"
#include "reference/reference.h"
#include "reference/update_image.h"

namespace whit::reference {

namespace {

using PixelTask = std::function<void(int x, int y, RayCounts& counts)>;

// Calls the task for every pixel of the window; threads share the rows.
RayCounts forEachPixel(const Crop& window, int threads, Progress* progress, const PixelTask& task) {
  std::vector<RayCounts> counts(std::max(1, threads));
  const int rows = window.y1 - window.y0;
  std::atomic<int> rowsDone{0};
  parallelFor(threads, rows, [&](std::size_t row, int worker) {
    const int y = window.y0 + static_cast<int>(row);
    RayCounts& own = counts[worker];
    for (int x = window.x0; x < window.x1; ++x) {
      const std::uint64_t before = own.limitedSamples;
      task(x, y, own);
      own.limitedPixels += own.limitedSamples > before;
    }
    reportProgress(progress, "tracing the reference", static_cast<double>(++rowsDone) / rows);
  });
  RayCounts sum;
  for (const RayCounts& c : counts) sum += c;
  return sum;
}

// Traces the centers of all pixels first; where that picture, as it would be displayed, has edges,
// the probe samples; and all samples where these differ.
RayCounts renderAdaptively(const Tracer& tracer, const CameraFrame& frame, const Settings& settings,
                           Image& image, Progress* progress) {
  const RenderOptions& options = settings.options;
  RayCounts counts;
  const auto forEach = [&](const Crop& window, const PixelTask& task) {
    counts += forEachPixel(window, settings.threads, progress, task);
  };
  const auto grownBy = [&](int more) {
    return grown(image.window, more, image.width, image.height);
  };
  Image first(image.width, image.height, grownBy(kPassReach));
  std::vector<PixelSurface> surfaces(first.pixels.size());
  CameraFrame wholePixels = frame;
  wholePixels.footprint = 1;
  forEach(first.window, [&](int x, int y, RayCounts& own) {
    surfaces[first.index(x, y)] = tracer.surfaceAtCenter(wholePixels, x, y);
    first.at(x, y) = Rgb(tracer.center(wholePixels, x, y, own));
  });
  std::vector<std::uint8_t> edges(first.pixels.size());
  const DisplayImage display = toDisplay(first, options.exposure.ev, options.toneCurve);
  findEdges(display, surfaces, options.contrast, 0, first.windowHeight(), edges);
  const std::vector<Vec2f> pattern = samplePattern(options.spp);
  ProbeSamples probes(first.window, edges, samplePattern(std::max(options.spp, kProbeSamples)));
  std::vector<RgbD> means(first.pixels.size());  // of the probes
  const double scale = std::exp2(double{options.exposure.ev});
  forEach(grownBy(1), [&](int x, int y, RayCounts& own) {
    if (edges[first.index(x, y)] == 0) return;
    RgbD& mean = means[first.index(x, y)];
    for (int s = 0; s < std::min(options.spp, kProbeSamples); ++s) {
      const std::size_t number = s;
      const RgbD value = tracer.sampled(frame, x, y, pattern[number], number, own);
      addSample(mean, value, s + 1.0);
      probes.at(x, y).codes[number] = displayCode(Rgb(value), scale, options.toneCurve);
    }
    first.at(x, y) = Rgb(mean);
  });
  forEach(image.window, [&](int x, int y, RayCounts& own) {
    image.at(x, y) = first.at(x, y);
    if (options.spp <= kProbeSamples || edges[first.index(x, y)] == 0) return;
    if (!probes.differ(x, y, options.contrast)) return;
    RgbD mean = means[first.index(x, y)];
    for (std::size_t s = kProbeSamples; s < pattern.size(); ++s) {
      addSample(mean, tracer.sampled(frame, x, y, pattern[s], s, own), static_cast<double>(s + 1));
    }
    image.at(x, y) = Rgb(mean);
  });
  return counts;
}

}  // namespace

RgbD Tracer::pixel(const CameraFrame& camera, int x, int y, RayCounts& counts) const {
  RgbD mean;
  double taken = 0;
  for (const auto s : indices(samples_)) {
    addSample(mean, sampled(camera, x, y, samples_[s], s, counts), ++taken);
  }
  return mean;
}

// By the running sum of squared deviations (Welford 1962), which does not cancel.
double Tracer::standardError(const CameraFrame& camera, int x, int y, RayCounts& counts) const {
  RgbD mean;
  double deviations = 0, taken = 0;
  for (const auto s : indices(samples_)) {
    const RgbD sample = sampled(camera, x, y, samples_[s], s, counts), before = sample - mean;
    mean += before / ++taken;
    deviations += dot(before, sample - mean) / 3;
  }
  return taken > 1 ? std::sqrt(deviations / (taken - 1) / taken) : kInfinity;
}

RgbD Tracer::center(const CameraFrame& camera, int x, int y, RayCounts& counts) const {
  return sampled(camera, x, y, {0.5f, 0.5f}, 0, counts);
}

RgbD Tracer::sampled(const CameraFrame& camera, int x, int y, const Vec2f& at, std::size_t sample,
                     RayCounts& counts) const {
  ++counts[RayKind::primary];
  const auto [ray, path] = primaryRay(camera, x, y, at, sample);
  const MediaStack media = mediaAtStart(scene_, effects_, intersector_, camera, ray);
  if (options_.maxRays == 0) return traceImpulse(ray, 0, 1.0, media, counts, path);

  SampleTree tree;
  Path bounded = path;
  bounded.tree = &tree;
  const RayCounts before = counts;
  const RgbD radiance = traceImpulse(ray, 0, 1.0, media, counts, bounded);
  if (tree.followed <= static_cast<std::uint64_t>(options_.maxRays)) return radiance;

  // The tree is too large: it is forgotten, and a narrower one traced.
  counts = before;
  ++counts.limitedSamples;
  tree.narrows = true;
  observer_.beganAgain();
  return traceImpulse(ray, 0, 1.0, media, counts, bounded);
}

PixelSurface Tracer::surfaceAtCenter(const CameraFrame& camera, int x, int y) const {
  const Ray ray = primaryRay(camera, x, y, {0.5f, 0.5f}, 0).ray;
  const std::optional<ChosenSurface> found = nearest(ray, 0);
  if (!found) return {};
  const TriangleHit hit = refineHit(scene_, ray, found->candidate);
  const Surfel s = makeSurfel(scene_, effects_, found->candidate, hit, ray);
  return {s.material, found->candidate.instance, Vec3f(s.position), Vec3f(s.geometricNormal)};
}

ChannelValues Tracer::channels(const CameraFrame& camera, int x, int y, const Vec2f& at,
                               std::size_t sample) const {
  const auto [ray, path] = primaryRay(camera, x, y, at, sample);
  const std::optional<ChosenSurface> found = nearest(ray, 0);
  ChannelValues values;
  if (!found) return values;
  const Candidate& candidate = found->candidate;
  const TriangleHit hit = refineHit(scene_, ray, candidate);
  const Surfel surfel = surfelAt(ray, *found, hit);
  values.distance = static_cast<float>(hit.t);
  values.z = static_cast<float>(hit.t * dot(ray.direction, camera.forward));
  values.position = Vec3f(scene_.inFile(surfel.position));
  values.normal = Vec3f(surfel.shadingNormal);
  values.albedo = Rgb(surfel.diffuse);
  if (earlier_) {
    const Candidate at{candidate.triangle, candidate.instance, hit.u, hit.v};
    values.motion = motionOf(scene_, *earlier_, camera, at, surfel.position);
  }
  const bool hasLobes = effects_.has(Effect::glossy);
  keepFinish(scene_.materials[surfel.material], hasLobes ? surfel.specular : RgbD(),
             hasLobes ? surfel.alpha : 0, values);
  values.uv = uvAt(scene_, candidate.triangle, hit.u, hit.v);
  const Scene::HitNumbers numbers = scene_.numbersOf(candidate.triangle, candidate.instance);
  values.object = numbers.item;
  values.triangle = numbers.triangle;
  values.material = surfel.material;
  return values;
}

RayCounts render(const Scene& scene, const Intersector& intersector, const Camera& camera,
                 const Settings& settings, Image& image, Progress* progress) {
  const CameraFrame frame = frameWithMedia(scene, settings.effects, intersector, camera,
                                           image.width, image.height, settings.options.spp);
  const Tracer tracer(scene, intersector, settings);
  if (tracer.samplesAdaptively()) {
    return renderAdaptively(tracer, frame, settings, image, progress);
  }
  return forEachPixel(image.window, settings.threads, progress,
                      [&](int x, int y, RayCounts& counts) {
                        image.at(x, y) = Rgb(tracer.pixel(frame, x, y, counts));
                      });
}

void keepChannels(const Scene& scene, const Intersector& intersector, const Camera& camera,
                  const Settings& settings, const Image& image, ChannelLayers& layers,
                  Progress* progress) {
  const Tracer tracer(scene, intersector, settings);
  const int spp = tracer.samplesAdaptively() ? 1 : settings.options.spp;
  const CameraFrame frame =
      frameWithMedia(scene, settings.effects, intersector, camera, image.width, image.height, spp);
  const std::vector<Vec2f> samples = samplePattern(spp);
  const std::size_t number = nearestToCenter(samples);
  forEachPixel(image.window, settings.threads, progress, [&](int x, int y, RayCounts&) {
    const std::size_t pixel = image.index(x, y);
    layers.keep(pixel, tracer.channels(frame, x, y, samples[number], number));
    if (layers.channels().has(Channel::alpha)) {
      RayCounts seen;
      for (const auto i : indices(samples)) {
        tracer.sampled(frame, x, y, samples[i], i, seen);
      }
      const double clear = (seen.clear.x + seen.clear.y + seen.clear.z) / 3;
      layers.floats(Channel::alpha)[pixel] =
          static_cast<float>(1 - clear / static_cast<double>(samples.size()));
    }
    RayCounts counts;
    if (layers.channels().has(Channel::error)) {
      const std::span<float> errors = layers.floats(Channel::error);
      errors[2 * pixel] = static_cast<float>(tracer.standardError(frame, x, y, counts));
      errors[2 * pixel + 1] = static_cast<float>(counts.ended / settings.options.spp);
    }
    if (!layers.channels().has(Channel::rays)) return;
    counts = {};
    tracer.sampled(frame, x, y, samples[number], number, counts);
    layers.numbers(Channel::rays)[pixel] = static_cast<std::uint32_t>(counts.all());
  });
}

}  // namespace whit::reference
