// --set: every command that reads a scene takes it, and images state it in their metadata.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <map>

#include "command_json.h"
#include "has_text.h"
#include "picture_file.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// Turns the mirror off, so that the reports on the scene change.
constexpr char kMatte[] = "/materials/mirror/mirror=0";

class Set : public TinySceneTest {};

TEST_F(Set, RendersWhatTheEditedFileRenders) {
  std::string text = readFile(tiny_);
  text.replace(text.find("[60, 60, 60]"), 12, "[1, 2.5, 60]");
  text.replace(text.find("\"diffuse\": 0.5"), 14, "\"diffuse\": [0.1, 0.2, 0.3]");
  std::ofstream(folder_ / "edited.json") << text;

  succeed({"render", tiny_, "-o", folder_ / "a.png", "--quiet", "--set",
           "/lights/0/intensity=[1, 2.5, 60]", "--set=/materials/floor/diffuse=[0.1, 0.2, 0.3]"});
  succeed({"render", folder_ / "edited.json", "-o", folder_ / "b.png", "--quiet"});

  EXPECT_EQ(storedIn(folder_ / "a.png").codes, storedIn(folder_ / "b.png").codes);
}

TEST_F(Set, ImagesTellOfItAndResumingKnows) {
  const std::string image = folder_ / "a.exr";
  const auto number = [&] {
    struct stat facts {};
    EXPECT_EQ(stat(image.c_str(), &facts), 0);
    return facts.st_ino;
  };

  const auto render = [&](const char* size) {
    succeed({"render", tiny_, "-o", image, "--quiet", "--resume", "--set", kMatte, "--set", size});
    return number();
  };

  const auto first = render("/size=[40, 20]");
  EXPECT_EQ(metadataOf(image).at("set"), std::string(kMatte) + "\n/size=[40, 20]");

  EXPECT_EQ(render("/size=[40, 20]"), first) << "traced again";
  std::ofstream(folder_ / "keep") << "so that the number of the replaced file is not given again";
  EXPECT_NE(render("/size=[20, 40]"), first) << "not traced again";
}

TEST_F(Set, EveryCommandTakesIt) {
  const auto matte = [](const Words& words) {
    return jsonOf(joined(words, {"--quiet", "--set", kMatte}));
  };

  EXPECT_FALSE(matte({"info", tiny_})["effects"]["mirror"]["on"].get<bool>());
  EXPECT_EQ(matte({"bench", tiny_, "--frames", "1"})["runs"][0]["rays"]["reflection"], 0);
  EXPECT_EQ(matte({"compare", tiny_})["nonfinite"], 0);

  succeed(
      {"effects", tiny_, "--out", folder_ / "made", "--frames", "1", "--set", kMatte, "--quiet"});
  EXPECT_FALSE(hasText(readFile(folder_ / "made/effects.csv"), "\nmirror,"));
}

}  // namespace
}  // namespace whit::cli
