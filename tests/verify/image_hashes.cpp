#include "verify/image_hashes.h"

#include <sstream>
#include <vector>

#include "command_line/parse_options.h"
#include "output/digest.h"
#include "output/open_and_warn.h"
#include "verify/probe.h"

namespace whit::verify {

namespace {

// tests/measure.py --hashes writes the hashes.
constexpr PublishedHash kPublished[] = {
    {"matte", "480x300", "39fe3dc501f6a0ff9b1746f0f19c13ab"},
    {"matte", "48x30", "ebee9c245b900d56eb91f78c01b3a092"},
    {"whitted", "480x300", "f06f9bbaa222fbed79f9981ee27f0d08"},
    {"whitted", "48x30", "e452828e3985cecc5c863d14be532d9f"},
    {"glass", "480x300", "4ffcec378acba60a346738bb240f2312"},
    {"glass", "48x30", "8805e35732896a606ed45cd182ae3a6c"},
    {"mirrors", "480x300", "991582be4283f9b442b3a7792be3fdb2"},
    {"mirrors", "48x30", "ea2fef10c1da02155e67997841f15629"},
    {"glossy", "480x300", "d43724b50c896c0aa989cd4724b4b9d8"},
    {"glossy", "48x30", "02f366f05f772c3d87eda18cebff2be0"},
    {"effects", "480x300", "2525f53b64d5a025f1beba500563849a"},
    {"effects", "48x30", "eef36e09a957b39225ae7ca1232c77cd"},
    {"cornell", "480x300", "da2abfcf9a96fb78b03dfb1de75ee493"},
    {"cornell", "48x30", "16c3d2ffbda22ea09cf00664ced5a05e"},
    {"orrery --time 3", "480x300", "aefa6f700301a3c085a05b29a4618b3b",
     "cb0928fa80a363311821d3cddcdae566"},
    {"orrery --time 3", "48x30", "b780d8405f9153d3eb1f3a06c463cf31"},
    {"atrium", "480x300", "e1dd1ce9c9a9fa0273aace32f1d6aa3f", "a5d48280f42ab2ee1c0037d9ee68872d"},
    {"atrium", "48x30", "43168a346043091afd152bc4feed0d5b"},
    {"landscape", "480x300", "efd52e2ba891aaab3a30a86770f1176f",
     "5668fbca001cad070d9d0d0882d78d3a"},
    {"landscape", "48x30", "c5a07f99d928e5a4433927806a5d243d"},
    {"sponza-mirror", "480x300", "28e3692e66a3ba345d4055a05393ee60"},
    {"sponza-mirror", "48x30", "563b84128dd0c5faf0948a6fc6a4170e"},
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
  open_ = openAndWarn(names[0], common, nullptr);
  options_ = cli::optionsFor(open_->scene, common);
}

std::string HashedScene::hash(const RenderOptions& options) const {
  const Scene& scene = open_->scene;
  return digestOf(pictureOf(scene, chooseCamera(scene, options), options));
}

}  // namespace whit::verify
