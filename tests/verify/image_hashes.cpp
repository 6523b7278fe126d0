#include "verify/image_hashes.h"

#include <sstream>
#include <vector>

#include "accuracy/digest.h"
#include "cli/app/parse_options.h"
#include "render/renderer.h"

namespace whit::verify {

namespace {

// tests/measure.py --hashes writes the third column.
constexpr PublishedHash kPublished[] = {
    {"matte", "480x300", ""},
    {"matte", "48x30", ""},
    {"whitted", "480x300", ""},
    {"whitted", "48x30", ""},
    {"glass", "480x300", ""},
    {"glass", "48x30", ""},
    {"mirrors", "480x300", ""},
    {"mirrors", "48x30", ""},
    {"glossy", "480x300", ""},
    {"glossy", "48x30", ""},
    {"effects", "480x300", ""},
    {"effects", "48x30", ""},
    {"cornell --indirect 4", "480x300", ""},
    {"cornell --indirect 4", "48x30", ""},
    {"orrery --time 3", "480x300", ""},
    {"orrery --time 3", "48x30", ""},
    {"atrium", "480x300", ""},
    {"atrium", "48x30", ""},
    {"landscape", "480x300", ""},
    {"landscape", "48x30", ""},
    {"sponza-mirror", "480x300", ""},
    {"sponza-mirror", "48x30", ""},
};

}  // namespace

std::span<const PublishedHash> publishedHashes() { return kPublished; }

HashedScene::HashedScene(const PublishedHash& picture) {
  std::vector<std::string> words{"--size", std::string(picture.size), "--quiet"}, names;
  std::istringstream given{std::string(picture.scene)};
  for (std::string word; given >> word;) words.push_back(word);
  cli::CommonOptions common;
  cli::OptionList list;
  cli::listCommonOptions(list, common);
  list.operands("SCENE", "", 1, 1, names);
  cli::parseOptions("", "", list, words);
  cli::settleOptions(common);
  open_ = cli::openScene(names[0], common, nullptr);
  options_ = cli::optionsFor(open_->scene, common);
}

std::string HashedScene::hash(const RenderOptions& options) const {
  const Scene& scene = open_->scene;
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  renderer.render(chooseCamera(scene, options), film);
  return accuracy::digestOf(film.image);
}

}  // namespace whit::verify
