#include "verify/image_hashes.h"

#include <sstream>
#include <vector>

#include "accuracy/digest.h"
#include "cli/app/parse_options.h"
#include "render/renderer.h"

namespace whit::verify {

namespace {

// tests/measure.py --hashes writes the hashes.
constexpr PublishedHash kPublished[] = {
    {"matte", "480x300", "39fe3dc501f6a0ff9b1746f0f19c13ab"},
    {"matte", "48x30", "ebee9c245b900d56eb91f78c01b3a092"},
    {"whitted", "480x300", "7eae7f8350eb6a8e11ebcaaea2ec0179"},
    {"whitted", "48x30", "42c2c3befd1ad35a1a5cd80de7ee8d8e"},
    {"glass", "480x300", "70eaaa924885378ce9e0a633457cd3e0", "6c2cdc2d4c55d2ca7f0e726da76f6de0"},
    {"glass", "48x30", "fc58cceccfbde3c85ef0d9e53a8744d0"},
    {"mirrors", "480x300", "0115a1f4a6290561f2e53446e3ecd47b"},
    {"mirrors", "48x30", "c85001bbdac7fa51beadfa5c292e5cd0"},
    {"glossy", "480x300", "31ded442edba42e173684fc54094c4be"},
    {"glossy", "48x30", "c519162b0375df3581af3d03d93369bd"},
    {"effects", "480x300", "a281a53d50b105505e3f110ce58e5daf"},
    {"effects", "48x30", "867eaf9751d5a2a621495e7a3dfd77e1"},
    {"cornell --indirect 4", "480x300", "19e07649db4e547e85cbec16b3224d83"},
    {"cornell --indirect 4", "48x30", "9203cdbbe702e49e71f59b406c115e89"},
    {"orrery --time 3", "480x300", "7b583611f2b267d6fdbe2c14a1f7db1e",
     "dcfc08e3d9ea2f3c28c52fe28f233944"},
    {"orrery --time 3", "48x30", "2d18d22b7dd6a2b8cba70e3706c0f8ab"},
    {"atrium", "480x300", "0dae2c8534f8aaa92e0933f4612d6d45"},
    {"atrium", "48x30", "84fd15a8e093c05847287aebbd4f23fd"},
    {"landscape", "480x300", "b8b4e478eaa55017cdc7fabb40adc6c5",
     "03f08a7fda95c1b4a4b9be177d647f5d"},
    {"landscape", "48x30", "ad114bca7bf227ff4fc95b3e19d7190e"},
    {"sponza-mirror", "480x300", "33bf57887a35c7c2b7312ffe786697c4"},
    {"sponza-mirror", "48x30", "8bfacb7d95ec5e43f615cf0815a4e841"},
};

}  // namespace

std::span<const PublishedHash> publishedHashes() { return kPublished; }

std::string_view PublishedHash::hashWith(std::string_view simdTarget) const {
  const bool fused = simdTarget != "sse4" && simdTarget != "sse2" && simdTarget != "scalar";
  return fused || hashWithoutFma.empty() ? hash : hashWithoutFma;
}

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
