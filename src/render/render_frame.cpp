#include "render/render_frame.h"

#include <algorithm>
#include <atomic>
#include <string>

namespace whit {

namespace {

// How far a frame has come, by the lists of pixels that workers take on.
class TileProgress {
 public:
  TileProgress(Renderer& renderer, Progress& progress) : renderer_(renderer), progress_(progress) {}

  // Nobody looks on at the list.
  StageObserver* begun(std::size_t list) {
    if (list == 0) ++passes_;
    const std::size_t lists = renderer_.scheduler().allPixels().tiles.size();
    const int passes = passes_;
    progress_.report(passes < 2 ? "tracing" : "tracing, pass " + std::to_string(passes),
                     std::min(1.0, static_cast<double>(list) / static_cast<double>(lists)));
    return nullptr;
  }

 private:
  Renderer& renderer_;
  Progress& progress_;
  std::atomic<int> passes_{0};  // of adaptive sampling, each of which begins with list 0
};

}  // namespace

FrameStats renderFrame(Renderer& renderer, Mode mode, const Camera& camera, Film& film,
                       Progress* progress) {
  if (mode == Mode::reference) return renderer.renderReference(camera, film, progress);
  // Whoever looks on at a frame's batches has it traced tile by tile.
  if (!progress || renderer.options().batch == Batch::frame) return renderer.render(camera, film);
  TileProgress tiles(renderer, *progress);
  return renderer.render(camera, film, [&](std::size_t list) { return tiles.begun(list); });
}

}  // namespace whit
