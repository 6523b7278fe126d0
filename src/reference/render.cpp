#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "core/display.h"
#include "core/film.h"
#include "reference/eye_media.h"
#include "reference/reference.h"

namespace whit::reference {

namespace {

using RowTask = std::function<void(int y, RayCounts& counts)>;

// Every row of the window once, shared among threads.
RayCounts forEachRow(const Crop& window, int threads, Progress* progress, const RowTask& task) {
  std::atomic<int> nextRow{window.y0}, rowsDone{0};
  const auto work = [&](RayCounts& counts) {
    for (int y = nextRow++; y < window.y1; y = nextRow++) {
      task(y, counts);
      const double fraction = static_cast<double>(++rowsDone) / (window.y1 - window.y0);
      reportProgress(progress, "tracing the reference", fraction);
    }
  };
  const auto workers = static_cast<std::size_t>(std::max(1, threads));
  std::vector<RayCounts> counts(workers);
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < workers; ++i) helpers.emplace_back(work, std::ref(counts[i]));
    work(counts[0]);
  }
  RayCounts sum;
  for (const RayCounts& c : counts) sum += c;
  return sum;
}

// One sample everywhere first, then all of them where that picture has edges.
RayCounts renderAdaptively(const Tracer& tracer, const CameraFrame& frame, const Settings& settings,
                           Image& image, Progress* progress) {
  Image first(image.width, image.height, grownByOne(image.window, image.width, image.height));
  std::vector<PixelSurface> surfaces(first.pixels.size());
  RayCounts counts =
      forEachRow(first.window, settings.threads, progress, [&](int y, RayCounts& rowCounts) {
        for (int x = first.window.x0; x < first.window.x1; ++x) {
          first.at(x, y) = keptAs(settings.film, Rgb(tracer.centre(frame, x, y, rowCounts)));
          surfaces[first.index(x, y)] = tracer.surfaceAtCentre(frame, x, y);
        }
      });
  const DisplayImage display =
      toDisplay(first, settings.exposure, settings.toneCurve, settings.srgb);
  std::vector<std::uint8_t> edges(first.pixels.size());
  findEdges(display, surfaces, settings.contrast, 0, first.windowHeight(), edges);
  counts += forEachRow(image.window, settings.threads, progress, [&](int y, RayCounts& rowCounts) {
    for (int x = image.window.x0; x < image.window.x1; ++x) {
      const bool edge = edges[first.index(x, y)] != 0;
      image.at(x, y) =
          edge ? keptAs(settings.film, Rgb(tracer.pixelByContrast(frame, x, y, rowCounts)))
               : first.at(x, y);
    }
  });
  return counts;
}

}  // namespace

RayCounts render(const Scene& scene, const Intersector& intersector, const Camera& camera,
                 const Settings& settings, Image& image, Progress* progress) {
  CameraFrame frame = makeCameraFrame(camera, image.width, image.height);
  frame.media = mediaAround(scene, settings.effects, intersector, frame.eye);
  const Tracer tracer(scene, intersector, settings);
  if (settings.adaptive) return renderAdaptively(tracer, frame, settings, image, progress);
  return forEachRow(image.window, settings.threads, progress, [&](int y, RayCounts& counts) {
    for (int x = image.window.x0; x < image.window.x1; ++x) {
      image.at(x, y) = keptAs(settings.film, Rgb(tracer.pixel(frame, x, y, counts)));
    }
  });
}

}  // namespace whit::reference
