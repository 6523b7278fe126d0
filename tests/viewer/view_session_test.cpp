// A session without a window: undoing, edits that fail, scenes that are read again, errors.
#include "viewer/session/session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "cli/run_command.h"
#include "io/gltf_files.h"
#include "output/open_and_warn.h"
#include "virtual_display.h"

namespace whit::view {
namespace {

class Sessions : public cli::TinySceneTest {
 protected:
  Sessions() {
    options_.common.quiet = true;
    options_.common.render.threads = 2;
    options_.scene = tiny_;
    beginWithScene();
  }

  // Begins another session, without a scene where there is none.
  void begin(std::shared_ptr<OpenScene> scene) {
    session_ = std::make_unique<Session>(options_, std::move(scene), [] {});
    session_->setWindow({48, 32}, 32, 1);
    session_->endSupersampling();
  }

  std::shared_ptr<OpenScene> opened() const {
    return openAndWarn(options_.scene, options_.common, nullptr);
  }
  void beginWithScene() {
    begin(opened());
    settle();
  }

  const ViewState& state() const { return session_->state(); }

  // Goes on until the picture is sharp, and for longer than a pause between edits.
  void settle() {
    constexpr int kMostSteps = 10'000;
    bool sharp = false;
    for (int step = 0; step < kMostSteps && !sharp; ++step) {
      session_->fetchFrame();
      session_->advance(step == 0 ? 1 : 0.1);
      sharp = state().sharp;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(sharp);
  }

  template <typename Condition>
  void settleUntil(const Condition& happened) {
    constexpr int kMostPictures = 1000;
    for (int picture = 0; picture < kMostPictures && !happened(); ++picture) settle();
  }

  void edit(const std::string& setting) {
    session_->edit({setting}, state().edited);
    settle();
  }
  void act(const std::string& line) {
    session_->act(line);
    settle();
  }
  void open(const std::string& scene) {
    session_->open(scene);
    settle();
  }
  std::string command() const { return session_->command(); }
  void expectNothingToUndo() {
    session_->act("undo");
    EXPECT_EQ(state().message, "there is nothing to undo");
  }
  std::vector<std::string> settings() const { return state().shown.edited->settings; }

  ViewOptions options_;
  std::unique_ptr<Session> session_;
  const std::vector<std::string> none_, lamp_{"/lights/0/intensity=90"};
};

TEST_F(Sessions, OptionsAndEditsAreUndone) {
  act("set depth 3");
  edit(lamp_[0]);
  act("effect shadows 0");
  EXPECT_EQ(settings(), lamp_);

  act("undo");
  EXPECT_TRUE(state().options.disable == EffectSet());
  EXPECT_EQ(settings(), lamp_);
  act("undo");
  EXPECT_EQ(settings(), none_);
  EXPECT_EQ(state().options.depth, 3);
  act("undo");
  EXPECT_EQ(state().options.depth, kDepthLimit);

  expectNothingToUndo();

  // What is edited at once after undoing is another edit.
  act("set depth 3");
  for (const char* line : {"set depth 4", "undo", "set depth 5"}) session_->act(line);
  settle();
  act("undo");
  EXPECT_EQ(state().options.depth, 3);
}

// Exact spheres are part of the acceleration structure, which the next picture builds anew. The
// rays of the pixel are asked for again before and after that.
TEST_F(Sessions, BuiltInEffectsAreChosenWithAPixelPicked) {
  open("glass");
  act("click 24 16");
  for (const bool on : {false, true}) {
    act(on ? "effect spheres 1" : "effect spheres 0");
    EXPECT_EQ(state().error, "");
    EXPECT_EQ(state().options.disable.has(Effect::spheres), !on);
    EXPECT_EQ(state().shown.effects.has(Effect::spheres), on);
    EXPECT_TRUE(state().rays.query.picture.options == state().shown.request.options);
  }
}

TEST_F(Sessions, AnEditThatFailsIsNoStateToReturnTo) {
  edit("/sky={\"image\": \"missing.exr\"}");
  EXPECT_EQ(state().errors, 1);
  EXPECT_EQ(settings(), none_);
  EXPECT_EQ(state().edited.settings, none_);

  expectNothingToUndo();
}

TEST_F(Sessions, EditsOutliveAReload) {
  for (const bool isReadMeanwhile : {false, true}) {
    const auto before = state().scene;
    if (isReadMeanwhile) session_->act("reload");
    edit(lamp_[0]);
    if (!isReadMeanwhile) act("reload");
    EXPECT_NE(state().scene, before);
    EXPECT_EQ(settings(), lamp_);
    EXPECT_EQ(state().edited.settings, lamp_);

    act("undo");
    EXPECT_EQ(settings(), none_);
  }
}

// The scene is read again, and before its picture is fetched another scene is to be opened.
TEST_F(Sessions, ASceneReadAgainIsNotTakenForAnother) {
  const std::string other = folder_ / "other.json";
  save("other.json", bytesOf("tiny.json"));

  session_->act("reload");
  session_->advance(0.01);
  while (session_->isBusy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  session_->open(other);
  session_->fetchFrame();
  EXPECT_EQ(state().sceneName, options_.scene);

  settle();
  EXPECT_EQ(state().sceneName, other);
}

// A camera that is gone or was moved is not the one that is shown any more.
TEST_F(Sessions, ACameraThatIsReadAgainElsewhereIsNotFollowed) {
  const Json before = jsonIn("tiny.json");
  for (const bool isGone : {false, true}) {
    save("tiny.json", before.dump());
    act("reload");
    act("camera 1");
    EXPECT_EQ(state().followed, 1u);

    Json after = before;
    after["cameras"]["side"]["eye"] = {6, 3, 0};
    if (isGone) after["cameras"].erase("side");
    save("tiny.json", after.dump());
    act("reload");
    EXPECT_EQ(state().error, "");
    EXPECT_EQ(state().followed, std::nullopt);
  }
}

TEST_F(Sessions, FlightsFollowNoCamera) {
  EXPECT_EQ(state().followed, 0u);
  session_->act("play");
  session_->advance(0.1);
  EXPECT_EQ(state().followed, std::nullopt);
}

// A model that was exported at another size is fitted as it is now.
TEST_F(Sessions, WhatHasGrownIsFitted) {
  saveTiny("tiny.json", R"("radius": 1)", R"("radius": 3)");
  act("reload");
  act("fit");
  const std::string fitted = command();
  act("fit");
  EXPECT_EQ(command(), fitted);
}

// No option of the command takes a lens from a camera.
TEST_F(Sessions, TheViewFromAsideOfALensHasACommand) {
  Json scene = jsonIn("tiny.json");
  for (Json& camera : scene["cameras"]) camera["aperture"] = 0.5;
  save("tiny.json", scene.dump());
  beginWithScene();
  act("click 24 16");
  settleUntil([&] { return state().rays.scene != nullptr; });
  act("aside");
  EXPECT_TRUE(hasText(command(), "--camera=view"));
  save("shown.png", encodePng(state().shown.film.display));

  paste(command() + " --quiet -o again.png", folder_.path().string());
  EXPECT_EQ(storedIn("again.png").codes, storedIn("shown.png").codes);
}

TEST_F(Sessions, AFileThatChangesWhileItIsReadIsReadAgain) {
  const std::shared_ptr<OpenScene> scene = opened();
  const std::filesystem::file_time_type before = std::filesystem::last_write_time(tiny_);
  std::filesystem::last_write_time(tiny_, before + std::chrono::seconds(1));

  begin(scene);
  settleUntil([&] { return state().scene != scene; });
  EXPECT_NE(state().scene, scene);
}

TEST_F(Sessions, ErrorsStayUntilTheyAreDismissed) {
  session_->act("set depth 1000");
  EXPECT_TRUE(hasText(state().error, "depth"));
  EXPECT_EQ(state().options.depth, kDepthLimit);

  act("left 3 0\nfit\nset depth 2");
  EXPECT_NE(state().error, "");
  act("dismiss");
  EXPECT_EQ(state().error, "");
}

// A session that begins without a scene and one that is given the scene show the same.
TEST_F(Sessions, TheFirstSceneIsOpenedWithTheCommandLine) {
  options_.common.load.settings = lamp_;
  options_.common.render.camera = options_.common.load.camera = "side";
  options_.common.render.fov = 30.0;
  options_.common.given = {"camera", "fov"};
  beginWithScene();
  const std::string given = command();
  EXPECT_TRUE(hasText(given, "--fov=30 "));
  EXPECT_TRUE(hasText(given, lamp_[0]));

  begin(nullptr);
  settle();
  EXPECT_TRUE(session_->choosesScene());
  EXPECT_EQ(command(), "") << "the empty scene has a command";
  open(options_.scene);
  EXPECT_EQ(command(), given);
  EXPECT_FALSE(session_->hasUnsavedEdits());
  act("reload");
  EXPECT_EQ(command(), given);

  // Neither holds for another scene, which has no such camera, nor anything that moves.
  options_.common.load.instant.seconds = 1;
  open("whitted");
  act("reload");
  EXPECT_EQ(state().error, "");
  EXPECT_TRUE(command().starts_with("whit render whitted -o whitted.png --size"));
  EXPECT_FALSE(hasText(command(), "--fov"));
  EXPECT_EQ(settings(), none_);
}

TEST_F(Sessions, AFirstSceneThatCannotBeReadLeavesTheChoice) {
  begin(nullptr);
  open("missing.json");
  EXPECT_TRUE(hasText(state().error, "missing.json"));
  EXPECT_EQ(state().status, ExitStatus::io);
  EXPECT_TRUE(session_->choosesScene());
}

// The page of a browser has no other way to end a long reading.
TEST_F(Sessions, CloseDismissesAnErrorAndThenGivesUpReading) {
  session_->open("landscape?triangles=2000000");
  ASSERT_TRUE(session_->isReading());
  session_->act("set depth 1000");
  ASSERT_NE(state().error, "");

  session_->act("close");
  EXPECT_EQ(state().error, "");
  EXPECT_TRUE(session_->isReading());
  session_->act("close");
  EXPECT_FALSE(session_->isReading());
  EXPECT_EQ(state().sceneName, options_.scene);
}

// A triangle that two animations move.
std::string twoAnimations() {
  GltfBuilder b;
  const std::string moves = b.animation("translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  return asJson(b.json(oneMesh(primitive(b.positions(kTriangleXyz))) +
                       b.played(b.named("walk", moves) + "," + b.named("run", moves))));
}

TEST_F(Sessions, TheTimeBarNamesTheAnimationThatPlays) {
  options_.common.load.instant.plays = true;
  options_.scene = folder_ / "m.gltf";
  save("m.gltf", twoAnimations());
  begin(opened());
  session_->act("play");
  settle();
  ASSERT_EQ(state().timeline.animation, "walk");

  // Reading that is given up leaves the bar as it was.
  session_->act("animation run");
  session_->act("close");
  settle();
  EXPECT_EQ(state().timeline.animation, "walk");

  act("animation run");
  EXPECT_EQ(state().error, "");
  EXPECT_EQ(state().timeline.animation, "run");
  EXPECT_EQ(state().timeline.seconds, 0);
}

}  // namespace
}  // namespace whit::view
