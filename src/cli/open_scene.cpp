#include "cli/open_scene.h"

#include <chrono>
#include <cstdio>

#include "core/error.h"
#include "io/load_scene.h"

namespace whit::cli {

namespace {

// Linear pixel, display code, and what the encoder needs while it writes.
constexpr std::uint64_t kBytesPerPixel = 32;

}  // namespace

std::unique_ptr<OpenScene> openScene(const std::string& name, const CommonOptions& common,
                                     Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  auto open = std::make_unique<OpenScene>(common.render.strict);
  open->scene = Scene::finalize(loadScene(name, common.load, open->warnings, progress),
                                open->warnings, progress);
  open->loadMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (!common.quiet) tellWarnings(open->warnings);
  return open;
}

void tellWarnings(const Warnings& warnings) {
  for (const auto& [kind, entry] : warnings.entries()) {
    std::fprintf(stderr, "whit: warning: %s (%llu times, first: %s)\n", kind.c_str(),
                 static_cast<unsigned long long>(entry.count), entry.first.c_str());
  }
}

Film openFilm(const Scene& scene, const CommonOptions& common) {
  const ImageSize size = common.render.size.value_or(ImageSize{scene.width, scene.height});
  const Crop window = common.render.crop.value_or(Crop{0, 0, size.width, size.height});
  const std::uint64_t bytes = static_cast<std::uint64_t>(window.x1 - window.x0) *
                              static_cast<std::uint64_t>(window.y1 - window.y0) * kBytesPerPixel;
  if (bytes > common.load.maxMemoryBytes) {
    throwLimit("the image needs " + std::to_string(bytes / 1000000) +
               " MB, more than --max-memory allows");
  }
  return makeFilm(scene, common.render);
}

FrameStats renderFrame(Renderer& renderer, Mode mode, const Camera& camera, Film& film,
                       Progress* progress) {
  return mode == Mode::reference ? renderer.renderReference(camera, film, progress)
                                 : renderer.render(camera, film);
}

}  // namespace whit::cli
