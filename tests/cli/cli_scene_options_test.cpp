// Options in a scene file and options of the command line, which win.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <map>

#include "command_json.h"
#include "core/option_table.h"
#include "has_text.h"
#include "io/image/image_layers.h"
#include "picture_file.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// Writes the tiny scene with these options, which are written as members of a JSON object.
std::string writeStating(const TemporaryFolder& folder, const std::string& options) {
  std::string text = readFile(writeTinyScene(folder));
  text.replace(text.find('{'), 1, "{\"options\": {" + options + "}, ");
  std::ofstream(folder / "stating.json") << text;
  return folder / "stating.json";
}

Outcome picture(const std::string& scene, const std::string& image, Words words = {}) {
  words.insert(words.begin(), {"render", scene, "-o", image, "--quiet"});
  return runWhit(words);
}

RenderOptions settled(const std::map<std::string, std::string>& stated,
                      const std::map<std::string, std::string>& given) {
  RenderOptions options;
  std::set<std::string> names;
  for (const auto& [name, value] : given) {
    setOption(options, name, value);
    names.insert(name);
  }
  applyQuality(options, names);

  applySceneOptions(stated, names, options);
  return options;
}

TEST(SceneOptions, AreThoseOfThePlainCommand) {
  const TemporaryFolder folder;
  const std::string scene = writeStating(
      folder, R"("spp": 2, "depth": 1, "terminator": true, "exposure": 1.5, "tonemap": "filmic")");
  for (const std::string type : {".exr", ".png"}) {
    const std::string plain = folder / ("a" + type), asked = folder / ("b" + type);
    ASSERT_EQ(picture(scene, plain).status, 0);
    ASSERT_EQ(picture(folder / "tiny.json", asked,
                      {"--spp", "2", "--depth", "1", "--terminator", "on", "--exposure", "1.5",
                       "--tonemap", "filmic"})
                  .status,
              0);
    EXPECT_EQ(storedIn(plain).codes, storedIn(asked).codes);
  }

  const auto stated = metadataOf(folder / "a.exr");
  EXPECT_EQ(stated.at("spp"), "2");
  EXPECT_EQ(stated.at("exposure"), "1.5");
}

TEST(SceneOptions, GiveWayToTheUser) {
  const std::map<std::string, std::string> scene{
      {"spp", "8"}, {"glossy", "16"}, {"indirect", "4"}, {"exposure", "1"}};
  const RenderOptions one = settled(scene, {{"spp", "2"}, {"exposure", "auto"}});
  EXPECT_EQ(one.spp, 2);
  EXPECT_EQ(one.glossy, 16);
  EXPECT_EQ(one.indirect, 4);
  EXPECT_TRUE(one.exposure.automatic);

  // A preset that the user chooses wins over the scene in all options that it sets.
  const RenderOptions preset = settled(scene, {{"quality", "good"}});
  EXPECT_EQ(preset.spp, 16);
  EXPECT_EQ(preset.glossy, 1);
  EXPECT_EQ(preset.indirect, 4) << "no preset says anything about it";

  const RenderOptions both = settled(scene, {{"quality", "good"}, {"glossy", "2"}});
  EXPECT_EQ(both.glossy, 2);
}

TEST(SceneOptions, MayNameAPresetButNotTheReference) {
  const RenderOptions own = settled({{"quality", "reference"}, {"depth", "5"}}, {{"spp", "3"}});
  EXPECT_EQ(own.cutoff, 1e-5f);
  EXPECT_EQ(own.depth, 5);
  EXPECT_EQ(own.spp, 3);
  EXPECT_EQ(own.mode, Mode::packets);

  const RenderOptions given = settled({{"quality", "reference"}}, {{"quality", "good"}});
  EXPECT_EQ(given.quality, Quality::good);
  EXPECT_EQ(given.cutoff, 1e-3f);
}

TEST(SceneOptions, AreThoseThatDescribeThePicture) {
  const std::vector<std::string> names = sceneOptionNames();
  const std::set<std::string> all(names.begin(), names.end());
  for (const char* name : {"quality", "spp", "adaptive", "depth", "glossy", "indirect", "cutoff",
                           "light-samples", "ambient-samples", "fresnel", "texture-filter",
                           "terminator", "disable", "exposure", "tonemap", "background"}) {
    EXPECT_TRUE(all.contains(name)) << name;
  }

  // Options of the machine and of the view do not belong to a scene.
  for (const char* name :
       {"threads", "packet",          "simd",    "mode", "batch", "robust",   "retry",
        "bvh",     "sphere-segments", "effects", "tile", "queue", "channels", "strict",
        "size",    "camera",          "eye",     "at",   "up",    "fov",      "ortho",
        "crop"}) {
    EXPECT_FALSE(all.contains(name)) << name;
  }
}

TEST(SceneOptions, InfoSaysWhereTheyComeFrom) {
  const TemporaryFolder folder;
  const std::string scene = writeStating(folder, R"("spp": 8, "indirect": 4, "glossy": 2)");
  const auto info = [&](Words words) {
    words.insert(words.begin(), {"info", scene});
    return runWhit(words).out;
  };
  EXPECT_TRUE(hasText(info({}), "options     spp 8 (scene), glossy 2 (scene), indirect 4 (scene)"));

  const auto rows =
      Json::parse(info({"--quality", "good", "--glossy", "3", "--json", "-"}))["options"];
  const auto row = [&](const char* name) {
    return rows[name]["value"].get<std::string>() + " " + rows[name]["from"].get<std::string>();
  };

  EXPECT_EQ(row("spp"), "16 --quality");
  EXPECT_EQ(row("glossy"), "3 command line");
  EXPECT_EQ(row("indirect"), "4 scene");
  EXPECT_FALSE(rows.contains("depth"));
  EXPECT_EQ(jsonOf({"info", folder / "tiny.json"})["options"].size(), 0u);
}

TEST(SceneOptions, AreResumedAndCropped) {
  const TemporaryFolder folder;
  const std::string scene = writeStating(folder, R"("spp": 2, "exposure": 1)");
  const std::string image = folder / "a.exr";
  const auto file = [&] {
    struct stat about {};
    stat(image.c_str(), &about);
    return about.st_ino;
  };

  ASSERT_EQ(picture(scene, image, {"--resume"}).status, 0);
  const auto first = file();
  ASSERT_EQ(picture(scene, image, {"--resume"}).status, 0);
  EXPECT_EQ(file(), first) << "traced again";

  // Crops merge to the whole only if both take the scene's options.
  ASSERT_EQ(picture(scene, folder / "l.exr", {"--crop", "0,0,20,32"}).status, 0);
  ASSERT_EQ(picture(scene, folder / "r.exr", {"--crop", "20,0,48,32"}).status, 0);
  succeed({"merge", folder / "m.exr", folder / "l.exr", folder / "r.exr"});
  EXPECT_EQ(storedIn(folder / "m.exr").codes, storedIn(image).codes);

  writeStating(folder, R"("spp": 3, "exposure": 1)");
  ASSERT_EQ(picture(scene, image, {"--resume"}).status, 0);
  EXPECT_NE(file(), first);
}

TEST(SceneOptions, ABackgroundNeedsAFileWithAlpha) {
  const TemporaryFolder folder;
  const std::string scene = writeStating(folder, R"("background": "transparent")");
  const Outcome refused = picture(scene, folder / "a.jpg");
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(hasText(refused.err, "has no alpha"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.jpg"));

  ASSERT_EQ(picture(scene, folder / "a.exr").status, 0);
  EXPECT_FALSE(readLayers(folder / "a.exr", ImageLimits()).empty());
  EXPECT_EQ(picture(scene, folder / "a.jpg", {"--background", "sky"}).status, 0);
}

TEST(SceneOptions, AreNotMeasured) {
  const TemporaryFolder folder;
  const std::string scene = writeStating(folder, R"("spp": 4)");
  const auto run = jsonOf({"bench", scene, "--frames", "1", "--quiet"})["runs"][0];
  EXPECT_EQ(run["rays"]["primary"], 48 * 32) << run.dump();
}

}  // namespace
}  // namespace whit::cli
