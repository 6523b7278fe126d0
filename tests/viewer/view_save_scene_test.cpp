// Scenes saved with their edits: read by whit render they give the picture that was on screen.
#include <gtest/gtest.h>

#include "has_text.h"
#include "io/load_scene.h"
#include "io/scene_files.h"
#include "viewer/session/view_files.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

namespace fs = std::filesystem;

class SavedScenes : public Viewer {
 protected:
  void SetUp() override {
    Viewer::SetUp();
    writeSky(folder_ / "sky.exr");
  }
  // The members keep their order.
  Json read(const std::string& file) const { return Json::parse(bytesOf(file)); }
  void expectThatItShows(const std::string& picture, const Words& commands) {
    for (const std::string& command : commands) Viewer::expectThatItShows(picture, command);
  }
};

TEST_F(SavedScenes, KeepWhatWasNotEdited) {
  const Words lines =
      commandsOf(2,
                 "asked\nkey W 0.3\nwait 10 frames\npanel scene\nwait 10 frames\n"
                 "click 30 139\nwait 5 frames\nclick 100 208\nbare\nwait 20 frames\nwait sharp\n"
                 "screenshot shown.png\nkey Ctrl+S\nkey Ctrl+S\n",
                 "800x480");
  EXPECT_EQ(lines[0], "whit render tiny-edited.json -o tiny-edited.png --size=800x480");
  EXPECT_TRUE(hasText(lines[1], "tiny-edited-2.json")) << "it was overwritten";
  expectThatItShows("shown.png", {lines[0]});

  // Only what was edited and the camera differ from the original file.
  const Json before = read("tiny.json"), after = read("tiny-edited.json");
  EXPECT_NE(after["lights"][0]["intensity"], before["lights"][0]["intensity"]);
  for (const char* section : {"size", "materials", "scene"}) {
    EXPECT_EQ(after[section], before[section]) << section;
  }
  EXPECT_EQ(after["cameras"].items().begin().key(), "saved");
  EXPECT_EQ(after["cameras"]["side"], before["cameras"]["side"]);
  EXPECT_EQ(after["path"][1], before["path"][1]);
}

// A path that begins at the first camera keeps its beginning although that camera is saved
// elsewhere.
TEST_F(SavedScenes, KeepTheirPath) {
  Json scene = read("tiny.json");
  scene["path"][0] = Json{{"time", 0}};
  save("tiny.json", scene.dump());
  play("key W 0.3\nwait sharp\nkey Ctrl+S\n");

  LoadOptions options;
  Warnings warnings;
  const auto before = loadScene(folder_ / "tiny.json", options, warnings);
  const auto after = loadScene(folder_ / "tiny-edited.json", options, warnings);

  EXPECT_FALSE(sameView(before.cameras[0], after.cameras[0]));
  for (const float time : {0.0f, 0.5f, 1.0f}) {
    EXPECT_TRUE(sameView(cameraAt(before.cameraPath, time), cameraAt(after.cameraPath, time)));
  }
}

TEST_F(SavedScenes, FindTheirFilesFromElsewhere) {
  fs::create_directories(folder_ / "sub/maps");
  writePng(folder_ / "sub/maps/t.png", DisplayImage{1, 1, {200, 90, 30, 255}}, {});
  fs::copy(folder_ / "sky.exr", folder_ / "sub/sky.exr");
  save("sub/m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  save("sub/s.json",
       "{'whit': 1, 'parameters': {'fov': 40}, "
       "'cameras': {'c': {'eye': [0, 1, 4], 'at': [0, 0.5, 0], 'fov': '$fov'}}, "
       "'sky': {'image': 'sky.exr'}, 'ambient': {'fromSky': 0.5}, "
       "'textures': {'t': {'image': 'maps/t.png'}}, 'materials': {'m': {'diffuseMap': 't'}}, "
       "'objects': {'o': [{'group': [{'model': 'm.obj'}]}]}, "
       "'scene': [{'shape': 'quad', 'material': 'm'}, {'use': 'o'}]}");

  const Words lines =
      commandsOf(1,
                 "drop sub/s.json?fov=55\nwait sharp\nkey D 0.2\nwait 20 frames\nwait sharp\nbare\n"
                 "wait 2 frames\nscreenshot shown.png\nkey Ctrl+S\n");
  EXPECT_FALSE(hasText(lines[0], "--allow-outside"));
  expectThatItShows("shown.png", {lines[0]});
  // Paths are relative to the folder of the new file.
  EXPECT_EQ(read("s-edited.json")["textures"]["t"]["image"], "sub/maps/t.png");
  EXPECT_EQ(read("s-edited.json")["parameters"]["fov"], 55);
}

// The copied command states the eye in coordinates of the model's file; the saved scene brings the
// model to the origin.
TEST_F(SavedScenes, KeepTheViewOfAFarModel) {
  save("far.obj",
       "v 4000000.1 500000 10\nv 4000001.1 500000 10\n"
       "v 4000000.1 500001 10\nf 1 2 3\n");
  const Words lines =
      commandsOf(2,
                 "drop far.obj\nwait sharp\nkey D 0.2\nwait 20 frames\nwait sharp\nbare\n"
                 "wait 2 frames\nscreenshot shown.png\nkey C\nkey Ctrl+S\n");
  EXPECT_TRUE(hasText(lines[0], "--eye=400000"));
  expectThatItShows("shown.png", lines);
}

TEST_F(SavedScenes, StateTheOptionsThatWereChosen) {
  Json scene = read("tiny.json");
  scene["options"] = {{"depth", 2}, {"spp", 4}, {"background", "ff8000"}};
  save("tiny.json", scene.dump());

  const Words lines =
      commandsOf(3,
                 "bare\nasked\nwait sharp\nkey C\nkey ]\nwait 20 frames\nwait sharp\n"
                 "screenshot shown.png\nkey C\nkey Ctrl+S\n",
                 "48x32", {"--spp", "2", "--fresnel", "schlick"});
  EXPECT_EQ(lines[0], "whit render tiny.json -o tiny.png --size=48x32 --spp=2 --fresnel=schlick");
  EXPECT_EQ(lines[1], lines[0] + " --exposure=0.25");
  EXPECT_EQ(lines[2], "whit render tiny-edited.json -o tiny-edited.png --size=48x32");
  expectThatItShows("shown.png", {lines[1], lines[2]});

  EXPECT_EQ(read("tiny-edited.json")["options"], (Json{{"depth", 2},
                                                       {"spp", 2},
                                                       {"background", "ff8000"},
                                                       {"fresnel", "schlick"},
                                                       {"exposure", 0.25}}));
}

// A dropped file opens. An exposure that the user chose for one scene does not hold for the next
// one, which has a camera of its own.
TEST_F(SavedScenes, OptionsOfAnotherSceneAreTaken) {
  Json scene = read("tiny.json");
  scene["options"] = {{"depth", 1}, {"exposure", 1}, {"spp", 4}};
  scene["cameras"]["front"]["eye"] = {1, 3, 7};
  save("other.json", scene.dump());

  const Words lines =
      commandsOf(3,
                 "bare\nasked\nkey ]\nwait sharp\nkey C\ndrop other.json\nwait sharp\n"
                 "screenshot shown.png\nkey C\ndrop tiny.json\nwait sharp\nkey C\n",
                 "48x32", {"--spp", "2"});
  EXPECT_EQ(lines[0], "whit render tiny.json -o tiny.png --size=48x32 --spp=2 --exposure=0.25");
  EXPECT_EQ(lines[1], "whit render other.json -o other.png --size=48x32 --spp=2");
  EXPECT_EQ(lines[2], "whit render tiny.json -o tiny.png --size=48x32 --spp=2");
  expectThatItShows("shown.png", {lines[1]});
}

TEST_F(SavedScenes, SayWhenTheirFilesLieOutside) {
  const cli::TemporaryFolder elsewhere;
  fs::copy(folder_ / "sky.exr", elsewhere / "sky.exr");
  std::ofstream(elsewhere / "far.json") << asJson(
      "{'whit': 1, 'sky': {'image': 'sky.exr'}, "
      "'scene': [{'shape': 'sphere'}]}");

  const Words lines = commandsOf(1, "drop " + (elsewhere / "far.json") +
                                        "\nwait sharp\nbare\nwait 2 frames\nscreenshot shown.png\n"
                                        "key Ctrl+S\n");
  EXPECT_TRUE(hasText(lines[0], " --allow-outside"));
  expectThatItShows("shown.png", {lines[0]});
}

TEST_F(SavedScenes, OfAModelHoldIt) {
  fs::create_directories(folder_ / "models");
  save("models/m.mtl", "newmtl a/b~c\nKd 1 0.5 0\nillum 1\n");
  save("models/m.obj",
       "mtllib m.mtl\nusemtl a/b~c\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 0 0 1\nf 1 3 4\n");

  const Words lines =
      commandsOf(3,
                 "drop models/m.obj\nwait sharp\nkey D 0.2\nbare\nwait 20 frames\nwait sharp\n"
                 "screenshot shown.png\nkey C\nkey Ctrl+S\ndrop sky.exr\nwait sharp\n"
                 "screenshot sky.png\nkey Ctrl+S\n",
                 "120x80");
  expectThatItShows("shown.png", {lines[0], lines[1]});
  expectThatItShows("sky.png", {lines[2]});

  // A model is named by the scene and not copied into it.
  const Json scene = read("m-edited.json");
  EXPECT_EQ(scene["scene"][0]["model"], "models/m.obj");
  EXPECT_EQ(scene["sky"]["preset"], "studio");
  EXPECT_EQ(read("m-edited-2.json")["sky"]["image"], "sky.exr");
}

// The reader turns a model alone upright, but not an item of a scene.
TEST_F(SavedScenes, OfATurnedModelHoldItUpright) {
  save("tall.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  scene_ = {"tall.obj"};
  for (const Words& options : {Words{}, {"--up", "y"}, {"--up", "x"}}) {
    const Words lines = commandsOf(1, "bare\nasked\nwait sharp\nscreenshot shown.png\nkey Ctrl+S\n",
                                   "120x75", options);
    expectThatItShows("shown.png", lines);
  }
}

// The reader puts the camera that such a scene asks for before the others.
TEST_F(SavedScenes, WithASuppliedViewNameTheirCamera) {
  save("view.json",
       "{'whit': 1, 'view': 'model', 'azimuth': 30, 'scene': [{'shape': 'box', "
       "'size': [3, 1, 1]}]}");
  scene_ = {"view.json"};
  const Words lines = commandsOf(
      2,
      "bare\nasked\nresize 90 150\nwait 20 frames\nwait sharp\nscreenshot shown.png\nkey Ctrl+S\n"
      "key D 0.2\nwait 20 frames\nwait sharp\nscreenshot moved.png\n"
      "key Ctrl+S\n",
      "");
  expectThatItShows("shown.png", {lines[0]});
  expectThatItShows("moved.png", {lines[1]});
}

TEST_F(SavedScenes, HaveTheSkyThatWasChosen) {
  for (const Words& options : {Words{}, {"--sky", "studio"}, {"--sky", "none"}}) {
    const Words lines =
        commandsOf(3,
                   "bare\nwait sharp\nscreenshot own.png\nkey Ctrl+S\ndrop sky.exr\nwait sharp\n"
                   "screenshot sky.png\nkey C\nkey Ctrl+S\n",
                   "120x80", options);
    expectOtherCodes("own.png", "sky.png");
    expectThatItShows("own.png", {lines[0]});
    EXPECT_FALSE(hasText(lines[1], "--sky"));
    expectThatItShows("sky.png", {lines[1], lines[2]});
  }
}

// The clicks change the sky's brightness and rotation in the panel, and turn on ambient light from
// the sky.
TEST_F(SavedScenes, HaveTheSurroundingsOfThePanel) {
  const Words lines =
      commandsOf(2,
                 "drop sky.exr\nasked\npanel scene\nwait 30 frames\nwait sharp\n"
                 "click 93 256 120 256\nclick 60 280 150 280\nclick 30 304\nwait 5 frames\n"
                 "bare\nwait 30 frames\nwait sharp\nscreenshot shown.png\nkey C\n"
                 "key Ctrl+S\n",
                 "800x560");

  const Json sky = read("tiny-edited.json")["sky"];
  EXPECT_NE(sky["scale"], 1);
  EXPECT_NE(sky["rotation"], 0);
  EXPECT_TRUE(read("tiny-edited.json")["ambient"].contains("fromSky"));
  expectThatItShows("shown.png", lines);
}

TEST_F(SavedScenes, ASkyThatCannotBeReadLeavesTheOneThatIsThere) {
  save("bad.hdr", "#?RADIANCE\n\n-Y 1 +X 1000000\n");
  const Words lines =
      commandsOf(2,
                 "errors show\nbare\nasked\nwait sharp\nscreenshot before.png\ndrop bad.hdr\n"
                 "wait 30 frames\nwait sharp\nscreenshot error.png\nkey Ctrl+S\nkey C\n",
                 "320x200");
  expectOtherCodes("before.png", "error.png");  // an error is shown without the other words, too
  EXPECT_EQ(lines[1], "whit render tiny.json -o tiny.png --size=320x200");
  EXPECT_FALSE(read("tiny-edited.json").contains("sky"));
}

}  // namespace
}  // namespace whit::view
