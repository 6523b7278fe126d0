// The tracing thread's debug views are the same as a renderer's that is made for them.
#include <gtest/gtest.h>

#include <atomic>

#include "cli/run_program.h"
#include "output/open_and_warn.h"
#include "render/debug_frame.h"
#include "viewer/session/frame_tracer.h"

namespace whit::view {
namespace {

class ViewPieces : public testing::TestWithParam<std::size_t> {
 protected:
  ViewPieces() {
    common_.quiet = true;
    common_.render.threads = 2;
    scene_ = openAndWarn(cli::writeTinyScene(folder_), common_, nullptr);

    request_.camera = scene_->scene.cameras[0];
    request_.options = common_.render;
    request_.options.size = ImageSize{100, 70};
    request_.view = static_cast<DebugView>(GetParam());
    request_.interruptible = true;

    calls_.superseded = calls_.stopped = [this] { return ++pieces_ > most_; };
    calls_.answer = [] {};
    calls_.publish = [](const TracedFrame&) {};
    calls_.showUnfinished = [](const UnfinishedFrame&) {};
  }

  void expectAsWhole() {
    FrameTracer tracer(scene_, common_);
    TracedFrame frame;
    ASSERT_TRUE(tracer.trace(request_, frame, calls_));
    EXPECT_GT(pieces_, 5);

    RenderOptions options = request_.options;
    options.spp = request_.spp;
    Renderer renderer(scene_->scene, options);
    Film film = makeFilm(scene_->scene, options);
    const test::DebugFrame whole =
        test::renderDebugView(renderer, request_.camera, film, request_.view);

    EXPECT_EQ(frame.film.image.pixels, film.image.pixels);
    ASSERT_TRUE(frame.debug);
    ASSERT_EQ(frame.debug->pixels.size(), whole.picture.pixels.size());

    // Times differ from run to run.
    if (request_.view == DebugView::cost) return;
    EXPECT_EQ(frame.film.display.rgba, film.display.rgba);
    EXPECT_EQ(frame.debug->legend(), whole.legend);
    for (std::size_t i = 0; i < whole.picture.pixels.size(); ++i) {
      ASSERT_EQ(frame.debug->textOf(i), whole.picture.textOf(i)) << i;
    }
  }

  cli::TemporaryFolder folder_;
  cli::CommonOptions common_;
  std::shared_ptr<OpenScene> scene_;
  FrameRequest request_;
  TraceCalls calls_;
  std::atomic<int> pieces_{0};  // several workers count
  int most_ = 1'000'000;
};

TEST_P(ViewPieces, AreThoseOfAWholePicture) { expectAsWhole(); }

TEST_P(ViewPieces, OfSeveralSamples) {
  request_.spp = 4;
  expectAsWhole();
}

TEST_P(ViewPieces, AreGivenUpInBetween) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  most_ = 3;
  EXPECT_FALSE(tracer.trace(request_, frame, calls_));
  EXPECT_LT(pieces_, 20) << "workers go on";
}

INSTANTIATE_TEST_SUITE_P(All, ViewPieces, testing::Range<std::size_t>(1, kDebugViewNames.size()),
                         [](const auto& view) { return std::string(kDebugViewNames[view.param]); });

}  // namespace
}  // namespace whit::view
