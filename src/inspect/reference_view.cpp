#include "inspect/reference_view.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "inspect/metrics.h"
#include "inspect/reference_frame.h"

namespace whit {

namespace {

// Thrown by a report of progress to end the reference.
struct Stopped {};

class StoppableProgress : public Progress {
 public:
  StoppableProgress(const FrameHooks& hooks, Progress* progress)
      : hooks_(hooks), progress_(progress) {}

  void report(const std::string& phase, double fraction) override {
    if (hooks_.stop && hooks_.stop()) throw Stopped();
    reportProgress(progress_, phase, fraction);
  }

 private:
  const FrameHooks& hooks_;
  Progress* progress_;
};

void showDifference(const Film& reference, Film& film, DebugPicture& picture) {
  const std::vector<std::uint8_t> codes = codeDifferences(film.display, reference.display);
  picture.pixels.resize(codes.size());
  double sum = 0;
  for (const auto i : indices(codes)) {
    const int code = codes[i];
    picture.largest = std::max<double>(picture.largest, code);
    sum += code;

    const Rgb linear = film.image.pixels[i] - reference.image.pixels[i];
    const float most = std::max({std::abs(linear.x), std::abs(linear.y), std::abs(linear.z)});
    picture.pixels[i] = {{static_cast<float>(code), most, 0}, 1};
    std::ranges::copy(heatOfCodes(code), &film.display.rgba[4 * i]);
  }
  picture.mean = sum / static_cast<double>(codes.size());
}

}  // namespace

FrameStats watchReference(Renderer& renderer, const Camera& camera, Film& film, DebugView view,
                          std::optional<Film>& reference, DebugPicture& picture,
                          const FrameHooks& hooks, Progress* progress) {
  const FrameStats stats = renderer.render({.camera = camera, .film = film, .hooks = &hooks});

  if (!reference) {
    StoppableProgress stoppable(hooks, progress);
    Film traced = film;
    try {
      renderReference(renderer, camera, traced, &stoppable);
    } catch (const Stopped&) {
      return stats;
    }
    reference = std::move(traced);
  }

  picture.view = view;
  showDifference(*reference, film, picture);
  if (view == DebugView::reference) film = *reference;
  return stats;
}

}  // namespace whit
