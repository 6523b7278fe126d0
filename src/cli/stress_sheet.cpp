#include "cli/stress_sheet.h"

#include <algorithm>

#include "cli/interrupt.h"
#include "core/display.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/paths.h"
#include "render/renderer.h"

namespace whit::cli {

namespace {

constexpr int kWidth = 320, kHeight = 240, kColumns = 4, kSheetGap = 4;

Image pictureOf(const std::string& scene) {
  Warnings warnings;
  const Scene loaded = Scene::finalize(loadScene(scene, LoadOptions{}, warnings), warnings);
  RenderOptions options;
  options.size = ImageSize{kWidth, kHeight};
  options.depth = 16;
  options.spp = 1;
  Renderer renderer(loaded, options);
  Film film = makeFilm(loaded, options);
  renderer.render(loaded.cameras.front(), film);
  return film.image;
}

}  // namespace

std::vector<std::string> writeStressSheet(const std::string& path, Progress* progress) {
  const std::vector<std::filesystem::path> scenes = hardScenes();
  if (scenes.empty()) throwIo("no scenes of hard cases found; is $WHIT_SCENES set?");
  const int count = static_cast<int>(scenes.size());
  const int columns = std::min(count, kColumns), rows = (count + kColumns - 1) / kColumns;
  Image sheet(columns * (kWidth + kSheetGap) + kSheetGap, rows * (kHeight + kSheetGap) + kSheetGap);
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    const std::filesystem::path& scene = scenes[static_cast<std::size_t>(i)];
    reportProgress(progress, scene.stem().string(), static_cast<double>(i) / count);
    const Image picture = pictureOf(scene.string());
    const int left = kSheetGap + i % kColumns * (kWidth + kSheetGap);
    const int top = kSheetGap + i / kColumns * (kHeight + kSheetGap);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) sheet.at(left + x, top + y) = picture.at(x, y);
    }
    names.push_back(scene.stem().string());
  }
  const WriteScope scope;
  writePng(path, toDisplay(sheet, 0, ToneCurve::none), {});
  return names;
}

}  // namespace whit::cli
