#include "render/frame.h"

#include <algorithm>
#include <cmath>

#include "core/display.h"
#include "core/error.h"
#include "core/text.h"
#include "scene/members.h"

namespace whit {

namespace {

// Linear pixel, display code, and what the encoder needs while it writes.
constexpr std::uint64_t kBytesPerPixel = 32;

}  // namespace

Camera aimed(Camera camera, const Vec3d& origin, const RenderOptions& options) {
  const bool hasFov = isPerspective(camera) && camera.k.empty();
  if (!hasFov && (options.fov || options.ortho.value_or(0) > 0)) {
    throwUsage("--fov and --ortho: camera '" + camera.name +
               "' has a matrix k or another projection than \"perspective\"");
  }
  forEachCameraOption([&](auto option, auto member) {
    if (options.*option) camera.*member = memberOf(*(options.*option), origin);
  });
  if (options.fov || options.ortho) camera.aspect = 0;

  const bool isMoved = options.eye || options.at;
  if (isMoved && camera.eye == camera.at) {
    throwUsage("--eye and --at are the same point, so that the camera looks nowhere");
  }
  return camera;
}

Camera chooseCamera(const Scene& scene, const RenderOptions& options) {
  if (options.camera.empty()) return aimed(scene.cameras.front(), scene.origin, options);
  const auto& cameras = scene.cameras;
  const auto found = std::find_if(cameras.rbegin(), cameras.rend(),
                                  [&](const Camera& c) { return c.name == options.camera; });
  if (found == cameras.rend()) {
    throwUsage("scene '" + scene.name + "' has no camera '" + options.camera + "'" +
               didYouMean(options.camera, namesIn(cameras), "camera"));
  }
  return aimed(*found, scene.origin, options);
}

Camera cameraOnPath(const Scene& scene, const RenderOptions& options, double seconds) {
  if (scene.cameraPath.empty()) throwUsage("scene '" + scene.name + "' has no camera path");
  return aimed(cameraAt(scene.cameraPath, seconds), scene.origin, options);
}

Film makeFilm(const Scene& scene, const RenderOptions& options, std::uint64_t maxBytes) {
  const ImageSize size = options.size.value_or(ImageSize{scene.width, scene.height});
  const Crop window = options.crop.value_or(Crop{0, 0, size.width, size.height});
  if (window.x0 < 0 || window.y0 < 0 || window.x1 > size.width || window.y1 > size.height ||
      window.x0 >= window.x1 || window.y0 >= window.y1) {
    throwUsage("--crop must lie within the image of " + std::to_string(size.width) + "x" +
               std::to_string(size.height) + " pixels and hold at least one");
  }
  const std::uint64_t bytes =
      static_cast<std::uint64_t>(window.x1 - window.x0) *
      static_cast<std::uint64_t>(window.y1 - window.y0) *
      (kBytesPerPixel + ChannelLayers::bytesPerPixel(keptChannels(options)));
  if (bytes > maxBytes) {
    throwLimit("the image needs " + std::to_string(bytes / 1000000) +
               " MB, more than --max-memory allows");
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
          squares += error * error, ++count;
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

void refuseNonFinite(const Scene& scene, const RenderOptions& options, const FrameStats& frame) {
  if (!options.strict || frame.nonFinitePixels == 0) return;
  throw Error(ExitStatus::badScene, scene.name + ": the image has " +
                                        std::to_string(frame.nonFinitePixels) +
                                        " pixels that are not finite (refused by --strict)");
}

void FrameStats::add(const FrameStats& worker) {
  for (std::size_t i = 0; i < kStageCount; ++i) {
    stageWorkerMs[i] += worker.stageWorkerMs[i];
    stageCalls[i] += worker.stageCalls[i];
  }
  for (std::size_t i = 0; i < stepCalls.size(); ++i) stepCalls[i] += worker.stepCalls[i];
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    meter.tally[i].rays += worker.meter.tally[i].rays;
    meter.tally[i].lanes += worker.meter.tally[i].lanes;
  }
  meter.embreeMs += worker.meter.embreeMs;
  nonFinitePixels += worker.nonFinitePixels;
  limitedPixels += worker.limitedPixels;
}

double SampleSum::standardError(int samples) const {
  if (samples < 2) return std::numeric_limits<double>::infinity();
  const double n = samples, mean = (total.x + total.y + total.z) / (3 * n);
  return std::sqrt(std::max(squares / n - mean * mean, 0.0) / (n - 1));
}

double SampleSums::relativeError(int samples) const {
  double errors = 0, radiance = 0;
  for (const SampleSum& sum : sums_) {
    errors += sum.standardError(samples);
    radiance += (sum.total.x + sum.total.y + sum.total.z) / (3.0 * samples);
  }
  return radiance > 0 ? errors / radiance : 0;
}

}  // namespace whit
