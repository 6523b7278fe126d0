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
    {"glass", "480x300", "18d2c111c2cf5b96f47b3dd949c79405", "ad07c7e690c2a1a5f00a206007d23773"},
    {"glass", "48x30", "9964facb5814d489fd9bb03aff5008e8"},
    {"mirrors", "480x300", "a18f31a055461f66f922ed7e5e0adf35"},
    {"mirrors", "48x30", "7757b6334cc2c316866aff3a041bcdc0"},
    {"glossy", "480x300", "e8e6fb603a3a57c3f8540df3cea18c72"},
    {"glossy", "48x30", "89b0db8aee0784533a2e44dc4e2500e0"},
    {"effects", "480x300", "42b59f4a76a047d8128f66e4a9728164"},
    {"effects", "48x30", "348ebac0d495ee87b5e3148fc569cebd"},
    {"cornell", "480x300", "da2abfcf9a96fb78b03dfb1de75ee493"},
    {"cornell", "48x30", "16c3d2ffbda22ea09cf00664ced5a05e"},
    {"orrery --time 3", "480x300", "ab134025cb85fb817034ffc8d095442d",
     "0061437dcaaebbd148c2f061cdf7e69e"},
    {"orrery --time 3", "48x30", "b5764e38e911552a5dd9bd65bb0562d1"},
    {"atrium", "480x300", "1eec5c0673f7f52327837967b093622d"},
    {"atrium", "48x30", "aa8b6aefe14e121331ca35d74efae184"},
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
