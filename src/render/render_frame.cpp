#include "render/render_frame.h"

#include <algorithm>
#include <atomic>

namespace whit {

FrameStats renderFrame(Renderer& renderer, Mode mode, const Camera& camera, Film& film,
                       Progress* progress) {
  if (mode == Mode::reference) return renderer.renderReference(camera, film, progress);
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
  return renderer.render(camera, film, {}, &hooks);
}

}  // namespace whit
