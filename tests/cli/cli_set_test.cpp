// --set: every command that reads a scene takes it, and images state it in their metadata.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <map>
#include <nlohmann/json.hpp>

#include "io/image/image_file.h"
#include "run_program.h"

namespace whit::cli {
namespace {

// Turns the mirror off, so that the reports on the scene change.
constexpr char kMatte[] = "/materials/mirror/mirror=0";

TEST(Set, RendersWhatTheEditedFileRenders) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  std::string text = readFile(tiny);
  text.replace(text.find("[60, 60, 60]"), 12, "[1, 2.5, 60]");
  text.replace(text.find("\"diffuse\": 0.5"), 14, "\"diffuse\": [0.1, 0.2, 0.3]");
  std::ofstream(folder / "edited.json") << text;

  ASSERT_EQ(runWhit({"render", tiny, "-o", folder / "a.png", "--quiet", "--set",
                     "/lights/0/intensity=[1, 2.5, 60]",
                     "--set=/materials/floor/diffuse=[0.1, 0.2, 0.3]"})
                .status,
            0);
  ASSERT_EQ(runWhit({"render", folder / "edited.json", "-o", folder / "b.png", "--quiet"}).status,
            0);

  Warnings warnings;
  EXPECT_EQ(readRawImage(folder / "a.png", ImageLimits(), warnings).codes,
            readRawImage(folder / "b.png", ImageLimits(), warnings).codes);
}

TEST(Set, ImagesTellOfItAndResumingKnows) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder), image = folder / "a.exr";
  const auto number = [&] {
    struct stat facts {};
    EXPECT_EQ(stat(image.c_str(), &facts), 0);
    return facts.st_ino;
  };

  const auto render = [&](const char* size) {
    EXPECT_EQ(runWhit({"render", tiny, "-o", image, "--quiet", "--resume", "--set", kMatte, "--set",
                       size})
                  .status,
              0);
    return number();
  };

  const auto first = render("/size=[40, 20]");
  std::map<std::string, std::string> said;
  for (const auto& [name, text] : readExrMetadata(image)) said[name] = text;
  EXPECT_EQ(said["set"], std::string(kMatte) + "\n/size=[40, 20]");

  EXPECT_EQ(render("/size=[40, 20]"), first) << "traced again";
  std::ofstream(folder / "keep") << "so that the number of the replaced file is not given again";
  EXPECT_NE(render("/size=[20, 40]"), first) << "not traced again";
}

TEST(Set, EveryCommandTakesIt) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  const auto jsonOf = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--quiet", "--json", "-", "--set", kMatte});
    const Outcome outcome = runWhit(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };

  EXPECT_FALSE(jsonOf({"info", tiny})["effects"]["mirror"]["on"].get<bool>());
  EXPECT_EQ(jsonOf({"bench", tiny, "--frames", "1"})["runs"][0]["rays"]["reflection"], 0);
  EXPECT_EQ(jsonOf({"compare", tiny})["nonfinite"], 0);

  ASSERT_EQ(runWhit({"effects", tiny, "--out", folder / "made", "--frames", "1", "--set", kMatte,
                     "--quiet"})
                .status,
            0);
  EXPECT_EQ(readFile(folder / "made/effects.csv").find("\nmirror,"), std::string::npos);
}

TEST(Set, WrongOnesSayWhere) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  const auto expectFailure = [&](const std::string& setting, int status, const std::string& text) {
    const Outcome outcome = runWhit({"info", tiny, "--set", setting});
    EXPECT_EQ(outcome.status, status) << setting;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  };

  expectFailure("/lights/0/intensity", 2, "POINTER=VALUE");
  expectFailure("/lights/3/intensity=1", 3, "tiny.json#/lights/3");
  expectFailure("/lights/0/intensitty=1", 3, "tiny.json#/lights/0/intensitty");
  expectFailure("/lights/0/intensity=true", 3, "tiny.json#/lights/0/intensity");

  const Outcome images = runWhit({"compare", "a.exr", "b.exr", "--set", kMatte});
  EXPECT_EQ(images.status, 2);
  EXPECT_NE(images.err.find("--set"), std::string::npos) << images.err;
}

}  // namespace
}  // namespace whit::cli
