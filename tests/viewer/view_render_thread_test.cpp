// The tracing thread: its pictures are those of a renderer made for them, whatever came before.
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include "cli/run_program.h"
#include "viewer/render_thread.h"

namespace whit::view {
namespace {

class RenderThreadTest : public testing::Test {
 protected:
  RenderThreadTest() {
    common_.quiet = true;
    common_.render.threads = 2;
    name_ = cli::writeTinyScene(folder_);
    scene_ = cli::openScene(name_, common_, nullptr);
    request_.camera = scene_->scene.cameras[0];
    request_.size = {48, 200};  // several bands
  }

  // A minute at most: far longer than a frame of a few thousand pixels takes.
  static bool waitFor(const RenderThread& thread) {
    for (int i = 0; i < 60'000 && thread.busy(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return !thread.busy();
  }

  TracedFrame traced(RenderThread& thread) {
    thread.ask(request_);
    TracedFrame frame;
    EXPECT_TRUE(waitFor(thread));
    EXPECT_TRUE(thread.take(frame)) << thread.takeError();
    return frame;
  }

  // The picture of a renderer made for this request.
  Film expected() const {
    RenderOptions options = common_.render;
    options.size = request_.size;
    options.spp = request_.spp;
    options.exposure = request_.exposure;
    options.disable = request_.disable;
    Renderer renderer(scene_->scene, options);
    Film film = makeFilm(scene_->scene, options);
    renderer.render(request_.camera, film);
    return film;
  }

  void expectRightPicture(RenderThread& thread) {
    const TracedFrame frame = traced(thread);
    const Film film = expected();
    ASSERT_EQ(frame.film.image.pixels.size(), film.image.pixels.size());
    EXPECT_EQ(std::memcmp(frame.film.image.pixels.data(), film.image.pixels.data(),
                          film.image.pixels.size() * sizeof(Rgb)),
              0);
    EXPECT_EQ(frame.film.display.rgba, film.display.rgba);
  }

  cli::TemporaryFolder folder_;
  cli::CommonOptions common_;
  std::string name_;
  std::shared_ptr<const cli::OpenScene> scene_;
  FrameRequest request_;
};

TEST_F(RenderThreadTest, OptionsChangeBetweenFrames) {
  RenderThread thread(scene_, common_, [] {});
  expectRightPicture(thread);
  request_.disable = request_.disable.with(Effect::mirror);
  expectRightPicture(thread);
  request_.disable = EffectSet().with(Effect::lights);
  expectRightPicture(thread);
  request_.disable = EffectSet();
  request_.exposure = 1.5f;
  expectRightPicture(thread);
  request_.spp = 4;
  request_.size = {31, 17};
  request_.camera = scene_->scene.cameras[1];
  expectRightPicture(thread);
}

TEST_F(RenderThreadTest, BandsMakeTheSamePicture) {
  RenderThread thread(scene_, common_, [] {});
  traced(thread);  // from which it learns how long bands take
  request_.interruptible = true;
  request_.spp = 256;  // long enough for more than one band on any machine of today
  request_.size = {480, 200};
  expectRightPicture(thread);
}

TEST_F(RenderThreadTest, TheNewestRequestWins) {
  RenderThread thread(scene_, common_, [] {});
  for (int i = 1; i <= 50; ++i) {
    request_.exposure = static_cast<float>(i) / 8;
    thread.ask(request_);
  }
  ASSERT_TRUE(waitFor(thread));
  TracedFrame frame;
  ASSERT_TRUE(thread.take(frame));
  EXPECT_TRUE(samePicture(frame.request, request_));
  EXPECT_FALSE(thread.take(frame));
}

TEST_F(RenderThreadTest, ReloadsTheScene) {
  RenderThread thread(scene_, common_, [] {});
  EXPECT_EQ(traced(thread).scene, scene_);
  std::string text = cli::readFile(name_);
  text.replace(text.find("\"diffuse\": 0.5"), 14, "\"diffuse\": 0.9");
  std::ofstream(name_) << text;
  thread.reload(name_);
  const TracedFrame frame = traced(thread);
  EXPECT_NE(frame.scene, scene_);
  scene_ = frame.scene;
  expectRightPicture(thread);
}

TEST_F(RenderThreadTest, ABrokenSceneLeavesTheOldOne) {
  RenderThread thread(scene_, common_, [] {});
  std::ofstream(name_) << "{ \"whit\": 1, ";
  thread.reload(name_);
  ASSERT_TRUE(waitFor(thread));
  EXPECT_NE(thread.takeError().find("tiny.json:1"), std::string::npos);
  EXPECT_EQ(thread.takeError(), "");
  expectRightPicture(thread);
}

}  // namespace
}  // namespace whit::view
