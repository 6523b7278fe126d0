#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "reference/eye_media.h"
#include "reference/reference.h"

namespace whit::reference {

RayCounts render(const Scene& scene, const Intersector& intersector, const Camera& camera,
                 const Settings& settings, Image& image, Progress* progress) {
  CameraFrame frame = makeCameraFrame(camera, image.width, image.height);
  frame.media = mediaAround(scene, settings.effects, intersector, frame.eye);
  const Tracer tracer(scene, intersector, settings);
  std::atomic<int> nextRow{image.window.y0}, rowsDone{0};

  const auto renderRows = [&](RayCounts& counts) {
    for (int y = nextRow++; y < image.window.y1; y = nextRow++) {
      for (int x = image.window.x0; x < image.window.x1; ++x) {
        image.at(x, y) = Rgb(tracer.pixel(frame, x, y, counts));
      }
      const double fraction = static_cast<double>(++rowsDone) / image.windowHeight();
      reportProgress(progress, "tracing the reference", fraction);
    }
  };

  const std::size_t workers = static_cast<std::size_t>(std::max(1, settings.threads));
  std::vector<RayCounts> counts(workers);
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < workers; ++i) helpers.emplace_back(renderRows, std::ref(counts[i]));
    renderRows(counts[0]);
  }
  RayCounts sum;
  for (const RayCounts& c : counts) sum += c;
  return sum;
}

}  // namespace whit::reference
