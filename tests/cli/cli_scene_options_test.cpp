// Options in a scene file and options of the command line, which win.
#include "core/option_table.h"
#include "io/image/image_layers.h"
#include "run_command.h"

namespace whit::cli {
namespace {

class SceneOptions : public TinySceneTest {
 protected:
  // Saves the tiny scene with these options, which are written as members of a JSON object.
  void saveStating(const std::string& options) const {
    saveTiny("stating.json", "{", "{\"options\": {" + options + "}, ");
  }
};

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

TEST_F(SceneOptions, AreThoseOfThePlainCommand) {
  saveStating("'spp': 2, 'depth': 1, 'terminator': true, 'exposure': 1.5, 'tonemap': 'filmic'");
  succeed("render stating.json -o a.exr -o a.png");
  succeed(
      "render tiny.json -o b.exr -o b.png --spp 2 --depth 1 --terminator on --exposure 1.5 "
      "--tonemap filmic");
  EXPECT_EQ(storedIn("a.png").codes, storedIn("b.png").codes);
  EXPECT_EQ(storedIn("a.exr").values, storedIn("b.exr").values);

  auto stated = metadataOf("a.exr");
  EXPECT_EQ(stated["spp"], "2");
  EXPECT_EQ(stated["exposure"], "1.5");
}

TEST(SettledOptions, GiveWayToTheUser) {
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

TEST(SettledOptions, MayNameAPresetButNotTheReference) {
  const RenderOptions own = settled({{"quality", "reference"}, {"depth", "5"}}, {{"spp", "3"}});
  EXPECT_EQ(own.cutoff, 1e-5f);
  EXPECT_EQ(own.depth, 5);
  EXPECT_EQ(own.spp, 3);
  EXPECT_EQ(own.mode, Mode::packets);

  const RenderOptions given = settled({{"quality", "reference"}}, {{"quality", "good"}});
  EXPECT_EQ(given.quality, Quality::good);
  EXPECT_EQ(given.cutoff, 1e-3f);
}

TEST(SettledOptions, OfScenesAreThoseThatDescribeThePicture) {
  const std::vector<std::string> names = sceneOptionNames();
  const auto isOne = [&](const std::string& name) { return std::ranges::count(names, name) == 1; };
  for (const std::string& name :
       split("quality spp adaptive depth glossy indirect cutoff light-samples ambient-samples "
             "fresnel texture-filter terminator disable exposure tonemap background")) {
    EXPECT_TRUE(isOne(name)) << name;
  }

  // Options of the machine and of the view do not belong to a scene.
  for (const std::string& name :
       split("threads packet simd mode batch robust retry bvh sphere-segments effects tile queue "
             "channels strict size camera eye at up fov ortho crop")) {
    EXPECT_FALSE(isOne(name)) << name;
  }
}

TEST_F(SceneOptions, InfoSaysWhereTheyComeFrom) {
  saveStating("'spp': 8, 'indirect': 4, 'glossy': 2");
  EXPECT_TRUE(hasText(succeed("info stating.json").out,
                      "options     spp 8 (scene), glossy 2 (scene), indirect 4 (scene)"));

  const Json rows = jsonOf("info stating.json --quality good --glossy 3")["options"];
  const auto row = [&](const char* name) {
    return rows[name]["value"].get<std::string>() + " " + rows[name]["from"].get<std::string>();
  };

  EXPECT_EQ(row("spp"), "16 --quality");
  EXPECT_EQ(row("glossy"), "3 command line");
  EXPECT_EQ(row("indirect"), "4 scene");
  EXPECT_FALSE(rows.contains("depth"));
  EXPECT_TRUE(jsonOf("info tiny.json")["options"].empty());
}

TEST_F(SceneOptions, AreResumedAndCropped) {
  saveStating("'spp': 2, 'exposure': 1");
  const std::string resuming = "render stating.json -o a.exr --resume";
  succeed(resuming);
  EXPECT_TRUE(keeps("a.exr", resuming));

  // Crops merge to the whole only if both take the scene's options.
  succeed("render stating.json -o l.exr --crop 0,0,20,32");
  succeed("render stating.json -o r.exr --crop 20,0,48,32");
  succeed("merge m.exr l.exr r.exr");
  EXPECT_EQ(storedIn("m.exr").values, storedIn("a.exr").values);

  saveStating("'spp': 3, 'exposure': 1");
  EXPECT_FALSE(keeps("a.exr", resuming));
}

TEST_F(SceneOptions, ABackgroundNeedsAFileWithAlpha) {
  saveStating("'background': 'transparent'");
  expectFailure("render stating.json -o a.jpg", 2, "has no alpha");
  EXPECT_FALSE(exists("a.jpg"));

  succeed("render stating.json -o a.exr");
  EXPECT_FALSE(readLayers(folder_ / "a.exr", ImageLimits()).empty());
  succeed("render stating.json -o a.jpg --background sky");
}

TEST_F(SceneOptions, AreNotMeasured) {
  saveStating("'spp': 4");
  EXPECT_EQ(jsonOf("bench stating.json --frames 1")["runs"][0]["rays"]["primary"], 48 * 32);
}

}  // namespace
}  // namespace whit::cli
