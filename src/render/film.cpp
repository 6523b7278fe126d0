#include "render/film.h"

#include <algorithm>
#include <cmath>

#include "core/display.h"
#include "core/error.h"
#include "core/text.h"

namespace whit {

namespace {

// Linear pixel, display code, and what the encoder needs while it writes.
constexpr std::uint64_t kBytesPerPixel = 32;

}  // namespace

Film makeFilm(const Scene& scene, const RenderOptions& options, std::uint64_t maxBytes) {
  const ImageSize size = options.size.value_or(ImageSize{scene.width, scene.height});
  const Crop window = options.crop.value_or(Crop{0, 0, size.width, size.height});
  if (window.x0 < 0 || window.y0 < 0 || window.x1 > size.width || window.y1 > size.height ||
      window.x0 >= window.x1 || window.y0 >= window.y1) {
    throwUsage(concat("--crop must lie within the image of ", size.width, "x", size.height,
                      " pixels and hold at least one"));
  }

  const std::uint64_t bytes =
      cellsOf(window.x1 - window.x0, window.y1 - window.y0) *
      (kBytesPerPixel + ChannelLayers::bytesPerPixel(keptChannels(options)));
  if (bytes > maxBytes) {
    throwLimit(concat("the image needs ", bytes / 1000000, " MB, more than --max-memory allows"));
  }

  Film film;
  film.image = Image(size.width, size.height, window);
  film.channels.resize(keptChannels(options), film.image.pixels.size());
  return film;
}

void sizeDisplay(Film& film) {
  if (!film.wantDisplay) return;
  film.display.width = film.image.windowWidth();
  film.display.height = film.image.windowHeight();
  film.display.rgba.resize(film.image.pixels.size() * 4);
  film.display.hasAlpha = false;  // an earlier frame may have had a transparent background
}

void poolErrors(Film& film) {
  if (!film.channels.channels().has(Channel::error)) return;
  const std::span<float> errors = film.channels.floats(Channel::error);
  const std::vector<float> own(errors.begin(), errors.end());
  const Crop& w = film.image.window;

  for (int y = w.y0; y < w.y1; ++y) {
    for (int x = w.x0; x < w.x1; ++x) {
      double squares = 0, count = 0;
      for (int j = std::max(y - kPoolReach, w.y0); j <= std::min(y + kPoolReach, w.y1 - 1); ++j) {
        for (int i = std::max(x - kPoolReach, w.x0); i <= std::min(x + kPoolReach, w.x1 - 1); ++i) {
          const double error = double{own[2 * film.image.index(i, j)]};
          squares += error * error;
          ++count;
        }
      }
      errors[2 * film.image.index(x, y)] = static_cast<float>(std::sqrt(squares / count));
    }
  }
}

void showBackground(const RenderOptions& options, Film& film) {
  if (!film.wantDisplay || !options.background.hidesSky()) return;
  film.display = overBackground(film.image, film.channels.floats(Channel::alpha), options);
}

}  // namespace whit
