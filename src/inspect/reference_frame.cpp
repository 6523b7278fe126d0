#include "inspect/reference_frame.h"

#include <algorithm>
#include <atomic>
#include <span>

#include "core/display.h"
#include "core/index.h"
#include "core/stopwatch.h"
#include "render/embree_intersector.h"

namespace whit {

reference::Settings referenceSettings(const Renderer& renderer) {
  return {renderer.options(), renderer.plan().effects, renderer.machine().threads,
          renderer.earlier()};
}

FrameStats renderReference(Renderer& renderer, const Camera& camera, Film& film,
                           Progress* progress) {
  const Stopwatch stopwatch;
  renderer.prepareView(camera, film);

  const Scene& scene = renderer.scene();
  const RenderOptions& options = renderer.options();
  const reference::Settings settings = referenceSettings(renderer);
  const EmbreeIntersector intersector(renderer.accel());
  const reference::RayCounts counts =
      reference::render(scene, intersector, camera, settings, film.image, progress);

  film.channels.resize(renderer.plan().channels, film.image.pixels.size());
  if (!renderer.plan().channels.empty()) {
    reference::keepChannels(scene, intersector, camera, settings, film.image, film.channels,
                            progress);
    poolErrors(film);
  }

  if (film.wantDisplay) {
    film.display = toDisplay(film.image, options.exposure.ev, options.toneCurve);
  }
  showBackground(options, film);

  FrameStats stats;
  stats.frameMs = stopwatch.ms();
  stats.workers = settings.threads;
  for (const auto k : indices(kRayKindCount)) {
    const std::uint64_t rays = counts[static_cast<RayKind>(k)];
    stats.meter.tally[k] = {rays, rays};
  }

  for (const Rgb& pixel : film.image.pixels) stats.nonFinitePixels += !isFinite(pixel);
  stats.limitedPixels = counts.limitedPixels;
  return stats;
}

FrameStats renderFrame(Renderer& renderer, Mode mode, const Camera& camera, Film& film,
                       Progress* progress) {
  if (mode == Mode::reference) return renderReference(renderer, camera, film, progress);
  if (!progress) return renderer.render(camera, film);
  std::atomic<std::size_t> finished{0};
  FrameHooks hooks;
  hooks.finished = [&](std::span<const std::uint32_t> pixels) {
    // Adaptive sampling traces all pixels once, then some of them again.
    const auto all = static_cast<double>(film.image.pixels.size());
    const double done = static_cast<double>(finished += pixels.size()) / all;
    progress->report(done <= 1 ? "tracing" : "tracing edges",
                     done <= 1 ? done : std::min(done - 1, 1.0));
  };
  return renderer.render({.camera = camera, .film = film, .hooks = &hooks});
}

}  // namespace whit
