// A tracing thread on a scene of its own, and what its pictures are expected to be.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "cli/run_command.h"
#include "output/open_and_warn.h"
#include "viewer/session/render_thread.h"

namespace whit::view {

// Waits for a minute at most, which is far longer than a frame of a few thousand pixels takes.
template <typename Condition>
bool waitUntil(const Condition& happened) {
  for (int i = 0; i < 60'000; ++i) {
    if (happened()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

inline void expectSameFilm(const Film& a, const Film& b) {
  ASSERT_EQ(a.image.pixels.size(), b.image.pixels.size());
  EXPECT_EQ(std::memcmp(a.image.pixels.data(), b.image.pixels.data(),
                        a.image.pixels.size() * sizeof(Rgb)),
            0);
  EXPECT_EQ(a.display.rgba, b.display.rgba);
}

class RenderThreadTest : public cli::TinySceneTest {
 protected:
  RenderThreadTest() {
    common_.quiet = true;
    common_.render.threads = 2;
    request_.options = common_.render;
    request_.options.size = {48, 200};  // high enough for several bands
    open(tiny_);
  }

  void open(const std::string& name) {
    name_ = name;
    opened_ = openAndWarn(name_, common_, nullptr);
    scene_ = opened_;
    request_.camera = scene_->scene.cameras[0];
  }

  RenderThread begin() {
    return RenderThread(opened_, common_, [] {});
  }

  static bool waitFor(const RenderThread& thread) {
    return waitUntil([&] { return !thread.busy(); });
  }

  // Returns the picture that the thread makes next.
  static TracedFrame taken(RenderThread& thread) {
    TracedFrame frame;
    EXPECT_TRUE(waitFor(thread));
    EXPECT_TRUE(thread.take(frame)) << thread.takeError();
    return frame;
  }
  TracedFrame traced(RenderThread& thread) {
    EXPECT_TRUE(thread.ask(request_));
    return taken(thread);
  }

  // Returns the picture that a renderer that is made for this request makes in this way.
  template <typename Render>
  Film filmBy(const Render& render) const {
    RenderOptions options = request_.options;
    options.spp = request_.spp;
    Renderer renderer(scene_->scene, options);
    Film film = makeFilm(scene_->scene, options);
    render(renderer, film);
    return film;
  }
  Film expected() const {
    return filmBy([&](Renderer& renderer, Film& film) { renderer.render(request_.camera, film); });
  }

  void expectRightPicture(RenderThread& thread) { expectSameFilm(traced(thread).film, expected()); }

  cli::CommonOptions common_;
  std::string name_;
  std::shared_ptr<OpenScene> opened_;
  std::shared_ptr<const OpenScene> scene_;  // the scene that pictures are expected to show
  FrameRequest request_;
};

// Traces pictures at rest without a thread of its own.
class FrameTracerTest : public RenderThreadTest {
 protected:
  FrameTracerTest() {
    request_.interruptible = true;
    calls_.superseded = calls_.stopped = [this] { return ++pieces_ > most_; };
    calls_.answer = [] {};
    calls_.publish = [](const TracedFrame&) {};
    calls_.showUnfinished = [](const UnfinishedFrame&) {};
  }

  TracedFrame traced(FrameTracer& tracer) {
    TracedFrame frame;
    EXPECT_TRUE(tracer.trace(request_, frame, calls_));
    return frame;
  }
  // Returns the picture of a tracer of its own.
  TracedFrame traced() {
    FrameTracer tracer(opened_, common_);
    return traced(tracer);
  }

  void expectIsGivenUpInBetween() {
    FrameTracer tracer(opened_, common_);
    TracedFrame frame;
    most_ = 3;
    EXPECT_FALSE(tracer.trace(request_, frame, calls_));
    EXPECT_GE(pieces_, 4);
    EXPECT_LT(pieces_, 20) << "workers go on";
  }

  TraceCalls calls_;
  std::atomic<int> pieces_{0};  // several workers count
  int most_ = 1'000'000;
};

}  // namespace whit::view
