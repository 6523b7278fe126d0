// A tracing thread on a scene of its own, and what its pictures are expected to be.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "cli/run_program.h"
#include "output/open_and_warn.h"
#include "viewer/session/render_thread.h"

namespace whit::view {

class RenderThreadTest : public testing::Test {
 protected:
  RenderThreadTest() {
    common_.quiet = true;
    common_.render.threads = 2;
    name_ = cli::writeTinyScene(folder_);
    opened_ = openAndWarn(name_, common_, nullptr);
    scene_ = opened_;

    request_.camera = scene_->scene.cameras[0];
    request_.options = common_.render;
    request_.options.size = {48, 200};  // high enough for several bands
  }

  // Waits for a minute at most, which is far longer than a frame of a few thousand pixels takes.
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

  // Returns the picture of a renderer that is made for this request.
  Film expected() const {
    RenderOptions options = request_.options;
    options.spp = request_.spp;
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
  std::shared_ptr<OpenScene> opened_;
  std::shared_ptr<const OpenScene> scene_;  // the scene that pictures are expected to show
  FrameRequest request_;
};

}  // namespace whit::view
