// A session without a window: undoing, edits that fail, scenes that are read again, errors.
#include "viewer/session/session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "cli/run_program.h"
#include "output/open_and_warn.h"

namespace whit::view {
namespace {

class Sessions : public testing::Test {
 protected:
  Sessions() {
    options_.common.quiet = true;
    options_.common.render.threads = 2;
    options_.scene = cli::writeTinyScene(folder_);
    session_ = std::make_unique<Session>(
        options_, openAndWarn(options_.scene, options_.common, nullptr), [] {});
    session_->setWindow({48, 32}, 32, 1);
    session_->endSupersampling();
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

  void edit(const std::string& setting) {
    session_->edit({setting}, state().edited);
    settle();
  }
  void act(const std::string& line) {
    session_->act(line);
    settle();
  }
  std::vector<std::string> settings() const { return state().shown.edited->settings; }

  cli::TemporaryFolder folder_;
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

  session_->act("undo");
  EXPECT_EQ(state().message, "there is nothing to undo");
}

TEST_F(Sessions, AnEditThatFailsIsNoStateToReturnTo) {
  edit("/sky={\"image\": \"missing.exr\"}");
  EXPECT_EQ(state().errors, 1);
  EXPECT_EQ(settings(), none_);
  EXPECT_EQ(state().edited.settings, none_);

  session_->act("undo");
  EXPECT_EQ(state().message, "there is nothing to undo");
}

TEST_F(Sessions, EditsOutliveAReload) {
  edit(lamp_[0]);
  const auto before = state().scene;
  act("reload");
  EXPECT_NE(state().scene, before);
  EXPECT_EQ(settings(), lamp_);

  act("undo");
  EXPECT_EQ(settings(), none_);
}

TEST_F(Sessions, EditsMadeWhileTheSceneIsReadAgainStay) {
  session_->act("reload");
  edit(lamp_[0]);
  EXPECT_EQ(settings(), lamp_);
  EXPECT_EQ(state().edited.settings, lamp_);

  act("undo");
  EXPECT_EQ(settings(), none_);
}

// The scene is read again, and before its picture is fetched another scene is to be opened.
TEST_F(Sessions, ASceneReadAgainIsNotTakenForAnother) {
  const std::string other = folder_ / "other.json";
  std::ofstream(other) << cli::readFile(options_.scene);

  session_->act("reload");
  session_->advance(0.01);
  while (session_->isBusy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  session_->open(other);
  session_->fetchFrame();
  EXPECT_EQ(state().sceneName, options_.scene);

  settle();
  EXPECT_EQ(state().sceneName, other);
}

TEST_F(Sessions, ErrorsStayUntilTheyAreDismissed) {
  session_->act("set depth 1000");
  EXPECT_NE(state().error.find("depth"), std::string::npos);
  EXPECT_EQ(state().options.depth, kDepthLimit);

  act("left 3 0\nfit\nset depth 2");
  EXPECT_NE(state().error, "");
  act("dismiss");
  EXPECT_EQ(state().error, "");
}

// The views of a debug view have another command, because whit render does not make them.
TEST_F(Sessions, TheCommandMakesWhatIsShown) {
  EXPECT_EQ(session_->command().rfind("whit render ", 0), 0u);
  act("view depth");
  EXPECT_EQ(session_->command().rfind("whit-view ", 0), 0u);
  EXPECT_NE(session_->command().find(" --view=depth"), std::string::npos);
}

}  // namespace
}  // namespace whit::view
