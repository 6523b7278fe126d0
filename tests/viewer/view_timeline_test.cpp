// Scenes that move, in the viewer.
#include "viewer/panel.h"

#include "has_text.h"
#include "io/scene_files.h"
#include "render_thread_fixture.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

TEST(Timeline, PlaysByTheClockAndBeginsAgain) {
  Timeline timeline;
  timeline.there = timeline.playing = true;
  timeline.length = 2;
  EXPECT_TRUE(timeline.step(1.5));
  EXPECT_EQ(timeline.time(), 1.5);
  EXPECT_TRUE(timeline.step(1));
  EXPECT_EQ(timeline.time(), 0.5);
  timeline.playing = false;
  EXPECT_FALSE(timeline.step(1));
  EXPECT_EQ(timeline.time(), 0.5);
}

TEST(Timeline, LastsAsLongAsWhatPlays) {
  Scene scene;
  EXPECT_FALSE(timelineOf(scene, {}).there);
  EXPECT_EQ(timelineOf(scene, {}).time(), std::nullopt);

  scene.animations = {{"walk", 3, 1}, {"run", 9, 1}, {kSceneMotion, 2, 1}};
  EXPECT_FALSE(timelineOf(scene, {}).there) << "it was read to stand still";
  scene.motion.given.lights.emplace_back();

  const Timeline first = timelineOf(scene, {});
  EXPECT_EQ(first.length, 3);
  EXPECT_EQ(first.animation, "walk");
  EXPECT_EQ(first.animations, (std::vector<std::string>{"walk", "run"}));
  EXPECT_TRUE(first.playing);

  // A time that is given pauses the animation there.
  const Timeline named = timelineOf(scene, {4.0, "run"});
  EXPECT_EQ(named.length, 9);
  EXPECT_EQ(named.time(), 4);
  EXPECT_FALSE(named.playing);

  // The path of the camera lasts longer than the animation.
  scene.cameraPath = {{0, {}}, {12, {}}};
  scene.motion.given.cameras.emplace_back();
  EXPECT_EQ(timelineOf(scene, {4.0, "run"}).length, 12);
}

// A ball that rises, a lamp that sinks, a camera that moves aside.
std::string movingScene() {
  const auto keys = [](const std::string& to) {
    return "'motion': {'keys': [{'time': 0}, {'time': 2, 'translate': " + to + "}]}";
  };
  return asJson(
      "{'whit': 1, 'size': [48, 32], 'materials': {'red': {'diffuse': [0.5, 0, 0]}}, 'cameras': "
      "{'front': {'eye': [0, 2, 6], 'at': [0, 1, 0], 'fov': 40, " +
      keys("[2, 0, 0]") + "}}, 'lights': [{'position': [3, 6, 4], 'intensity': 60, " +
      keys("[0, -3, 0]") +
      "}], 'scene': [{'shape': 'quad', 'width': 8, 'depth': 8}, {'shape': 'sphere', 'material': "
      "'red', " +
      keys("[0, 2, 0]") + "}]}");
}

class MovingPictures : public RenderThreadTest {
 protected:
  MovingPictures() {
    save("tiny.json", movingScene());
    common_.load.instant.plays = true;
    open(name_);
  }
  // Compares with the scene as it is read at that time.
  void expectPictureAt(double seconds, RenderThread& thread) {
    cli::CommonOptions then = common_;
    then.load.instant.seconds = seconds;
    scene_ = openAndWarn(name_, then, nullptr);
    request_.seconds = seconds;
    expectRightPicture(thread);
  }
};

TEST_F(MovingPictures, AreOfTheirTime) {
  RenderThread thread = begin();
  for (const double seconds : {1.2, 0.0, 2.0}) expectPictureAt(seconds, thread);
}

// The lamp's color is edited, then where it begins; it goes on moving from there.
TEST_F(MovingPictures, KeepWhatWasEdited) {
  RenderThread thread = begin();
  expectPictureAt(1.2, thread);
  for (const char* setting : {"/lights/0/intensity=90", "/lights/0/position=[1, 6, 5]"}) {
    common_.load.settings.emplace_back(setting);
    thread.edit({opened_, common_.load.settings});
    ++request_.edits;
    for (const double seconds : {1.2, 0.4}) expectPictureAt(seconds, thread);
  }
}

TEST_F(Viewer, PlaysUntilItIsPaused) {
  save("tiny.json", movingScene());
  const Words lines =
      commandsOf(4,
                 "bare\nasked\nwait 58 frames\nkey Space\nwait 3 frames\nwait sharp\n"
                 "screenshot shown.png\nkey C\nkey Ctrl+S\n"
                 "key A 0.2\nkey Space\nwait 30 frames\nkey Space\nwait 3 frames\nwait sharp\n"
                 "screenshot moved.png\nkey C\nkey Ctrl+S\n",
                 "240x160");
  // The camera's own place is that of the file at this time.
  EXPECT_TRUE(lines[0].starts_with("whit render tiny.json -o tiny.png --size=240x160 --time 1.0"))
      << lines[0];
  EXPECT_TRUE(hasText(lines[2], "--eye")) << "moved by hand";
  EXPECT_TRUE(hasText(lines[2], "--time 1."));

  // The paused picture is the one that the command renders at this time, also of the saved scene.
  for (const std::size_t i : {0, 1}) expectThatItShows("shown.png", lines[i]);
  for (const std::size_t i : {2, 3}) expectThatItShows("moved.png", lines[i]);
}

// At a time the reader puts a camera that flies the path before the others.
TEST_F(Viewer, ACameraThatDoesNotFlyThePathIsNamed) {
  Json scene = Json::parse(movingScene());
  scene["path"] = {{{"time", 0}, {"eye", {0, 2, 6}}}, {{"time", 1}, {"eye", {6, 2, 0}}}};
  save("tiny.json", scene.dump());
  const Words lines =
      commandsOf(2,
                 "bare\nasked\nwait 30 frames\nkey Space\nwait 3 frames\nwait sharp\n"
                 "screenshot shown.png\nkey C\nkey Ctrl+S\n",
                 "240x160");
  for (const std::string& command : lines) expectThatItShows("shown.png", command);
}

// The bar of the time is there without a panel. A click on its button pauses, and then the picture
// gets sharp. Dear ImGui 1.90 takes a click of a script only where the pointer has rested.
TEST_F(Viewer, TheTimeBarPauses) {
  save("tiny.json", movingScene());
  const Words lines = commandsOf(
      1, "asked\npoint 135 272\nwait 30 frames\nclick 135 272\nwait sharp\nkey C\n", "400x300");
  EXPECT_TRUE(hasText(lines[0], " --time "));
}

TEST_F(Viewer, AScenePausedAtATimeShowsThat) {
  save("tiny.json", movingScene());
  EXPECT_EQ(commandsOf(1, "asked\nwait sharp\nkey C\n", "240x160", {"--time", "1.50390625"}),
            Words{"whit render tiny.json -o tiny.png --size=240x160 --time 1.50390625"});
}

}  // namespace
}  // namespace whit::view
