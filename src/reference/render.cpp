#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <vector>

#include "core/display.h"
#include "core/worker_pool.h"
#include "reference/find_intersections.h"
#include "reference/generate_rays.h"
#include "reference/initial_medium_stack.h"
#include "reference/reference.h"
#include "reference/settle_coplanar.h"
#include "reference/update_image.h"
#include "sampling/probe_samples.h"

namespace whit::reference {

namespace {

PixelSurface surfaceOf(const Surfel& s, const Candidate& candidate) {
  return {s.material, candidate.instance, Vec3f(s.position), Vec3f(s.geometricNormal)};
}

using RowTask = std::function<void(int y, RayCounts& counts)>;

// Every row of the window once, shared among threads.
RayCounts forEachRow(const Crop& window, int threads, Progress* progress, const RowTask& task) {
  std::vector<RayCounts> counts(static_cast<std::size_t>(std::max(1, threads)));
  const int rows = window.y1 - window.y0;
  std::atomic<int> rowsDone{0};
  parallelFor(threads, static_cast<std::size_t>(rows), [&](std::size_t row, int worker) {
    task(window.y0 + static_cast<int>(row), counts[static_cast<std::size_t>(worker)]);
    reportProgress(progress, "tracing the reference", static_cast<double>(++rowsDone) / rows);
  });
  RayCounts sum;
  for (const RayCounts& c : counts) sum += c;
  return sum;
}

// The picture of pixels' centers, and what is seen there.
struct FirstPicture {
  Image image;
  std::vector<PixelSurface> surfaces;
};

RayCounts traceCenters(const Tracer& tracer, const CameraFrame& frame, const Settings& settings,
                       FirstPicture& first, Progress* progress) {
  Image& image = first.image;
  return forEachRow(image.window, settings.threads, progress, [&](int y, RayCounts& rowCounts) {
    for (int x = image.window.x0; x < image.window.x1; ++x) {
      first.surfaces[image.index(x, y)] = tracer.surfaceAtCenter(frame, x, y);
      image.at(x, y) = quantized(settings.options.film, Rgb(tracer.center(frame, x, y, rowCounts)));
    }
  });
}

// Pixels at edges: the mean of the probe samples, and those samples' codes.
RayCounts traceProbes(const Tracer& tracer, const CameraFrame& frame, const Settings& settings,
                      const Crop& window, const std::vector<std::uint8_t>& edges,
                      FirstPicture& first, ProbeSamples& probes, Progress* progress) {
  const RenderOptions& options = settings.options;
  const double scale = std::exp2(static_cast<double>(options.exposure.ev));
  const int samples = std::min(options.spp, kProbeSamples);
  const auto trace = [&](int x, int y, RayCounts& counts) {
    PixelProbes& own = probes.at(x, y);
    for (int s = 0; s < samples; ++s) {
      const auto number = static_cast<std::size_t>(s);
      const RgbD value = tracer.sample(frame, x, y, number, counts);
      addSample(own.total, value, s + 1.0);
      own.codes[number] = displayCode(Rgb(value), scale, options.toneCurve, options.srgb);
    }
    first.image.at(x, y) = quantized(options.film, Rgb(own.total));
  };
  return forEachRow(window, settings.threads, progress, [&](int y, RayCounts& counts) {
    for (int x = window.x0; x < window.x1; ++x) {
      if (edges[first.image.index(x, y)] != 0) trace(x, y, counts);
    }
  });
}

// The centers of all pixels first; where that picture, as it would be displayed, has edges then the
// probe samples, and all where these differ.
RayCounts renderAdaptively(const Tracer& tracer, const CameraFrame& frame, const Settings& settings,
                           Image& image, Progress* progress) {
  const RenderOptions& options = settings.options;
  FirstPicture first;
  first.image =
      Image(image.width, image.height, grown(image.window, kPassReach, image.width, image.height));
  first.surfaces.resize(first.image.pixels.size());
  RayCounts counts = traceCenters(tracer, frame, settings, first, progress);
  std::vector<std::uint8_t> edges(first.image.pixels.size());
  const DisplayImage display =
      toDisplay(first.image, options.exposure.ev, options.toneCurve, options.srgb);
  findEdges(display, first.surfaces, options.contrast, 0, first.image.windowHeight(), edges);
  ProbeSamples probes(first.image.window, edges,
                      samplePattern(std::max(options.spp, kProbeSamples)));
  counts += traceProbes(tracer, frame, settings, grown(image.window, 1, image.width, image.height),
                        edges, first, probes, progress);
  const auto refined = [&](int x, int y, RayCounts& rowCounts) {
    RgbD mean = probes.at(x, y).total;
    for (int s = kProbeSamples; s < options.spp; ++s) {
      const auto number = static_cast<std::size_t>(s);
      addSample(mean, tracer.sample(frame, x, y, number, rowCounts), s + 1.0);
    }
    return quantized(options.film, Rgb(mean));
  };
  counts += forEachRow(image.window, settings.threads, progress, [&](int y, RayCounts& rowCounts) {
    for (int x = image.window.x0; x < image.window.x1; ++x) {
      const bool more = options.spp > kProbeSamples && edges[first.image.index(x, y)] != 0 &&
                        probes.differ(x, y, options.contrast);
      image.at(x, y) = more ? refined(x, y, rowCounts) : first.image.at(x, y);
    }
  });
  return counts;
}

}  // namespace

RgbD Tracer::pixel(const CameraFrame& camera, int x, int y, RayCounts& counts) const {
  RgbD mean;
  double taken = 0;
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    addSample(mean, sample(camera, x, y, s, counts), ++taken);
  }
  return mean;
}

RgbD Tracer::sample(const CameraFrame& camera, int x, int y, std::size_t number,
                    RayCounts& counts) const {
  return sampled(camera, x, y, samples_[number], number, counts);
}

RgbD Tracer::center(const CameraFrame& camera, int x, int y, RayCounts& counts) const {
  return sampled(camera, x, y, {0.5f, 0.5f}, 0, counts);
}

RgbD Tracer::sampled(const CameraFrame& camera, int x, int y, const Vec2f& at, std::size_t sample,
                     RayCounts& counts) const {
  ++counts[RayKind::primary];
  const auto [ray, path] = primaryRay(camera, x, y, at, sample);
  const MediaStack media = mediaAtStart(scene_, effects_, intersector_, camera, ray);
  return traceImpulse(ray, 0, 1.0, media, counts, path);
}

PixelSurface Tracer::surfaceAtCenter(const CameraFrame& camera, int x, int y) const {
  const Ray ray = primaryRay(camera, x, y, {0.5f, 0.5f}, 0).ray;
  const std::optional<Settled> met = nearest(ray, 0);
  if (!met) return {};
  const TriangleHit hit = refineHit(scene_, ray, met->candidate);
  const Surfel s = makeSurfel(scene_, effects_, met->candidate, hit, ray);
  return surfaceOf(s, met->candidate);
}

RayCounts render(const Scene& scene, const Intersector& intersector, const Camera& camera,
                 const Settings& settings, Image& image, Progress* progress) {
  const CameraFrame frame =
      frameWithMedia(scene, settings.effects, intersector, camera, image.width, image.height);
  const Tracer tracer(scene, intersector, settings);
  if (tracer.samplesAdaptively()) {
    return renderAdaptively(tracer, frame, settings, image, progress);
  }
  return forEachRow(image.window, settings.threads, progress, [&](int y, RayCounts& counts) {
    for (int x = image.window.x0; x < image.window.x1; ++x) {
      image.at(x, y) = quantized(settings.options.film, Rgb(tracer.pixel(frame, x, y, counts)));
    }
  });
}

}  // namespace whit::reference
