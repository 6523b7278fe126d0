// The reference beside the frame: what is where, and that it is the reference.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "cli/run_program.h"
#include "viewer/frame_tracer.h"

namespace whit::view {
namespace {

DisplayImage filled(int width, int height, std::uint8_t code) {
  const std::size_t bytes = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {width, height, std::vector<std::uint8_t>(bytes, code)};
}

int codeAt(const DisplayImage& image, int x, int y) {
  return image.rgba[4 * static_cast<std::size_t>(y * image.width + x)];
}

TEST(SplitPicture, FrameOnTheLeftReferenceOnTheRight) {
  const DisplayImage frame = filled(10, 4, 1);
  Comparison comparison;
  comparison.reference.display = filled(10, 4, 2);
  comparison.rows = 3;  // the last is still to come
  const DisplayImage split = splitPicture(frame, comparison, 6);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 10; ++x) EXPECT_EQ(codeAt(split, x, y), x < 6 || y == 3 ? 1 : 2);
  }
  comparison.rows = 4;
  EXPECT_EQ(splitPicture(frame, comparison, 99).rgba, frame.rgba);
  EXPECT_EQ(splitPicture(frame, comparison, -5).rgba, comparison.reference.display.rgba);
}

TEST(SplitPicture, AnotherSizeIsLeftOut) {
  const DisplayImage frame = filled(10, 4, 1);
  Comparison comparison;
  comparison.reference.display = filled(8, 4, 2);
  comparison.rows = 4;
  EXPECT_EQ(splitPicture(frame, comparison, 0).rgba, frame.rgba);
}

class ComparisonTest : public testing::Test {
 protected:
  ComparisonTest() {
    common_.quiet = true;
    common_.render.threads = 2;
    scene_ = cli::openScene(cli::writeTinyScene(folder_), common_, nullptr);
    request_.camera = scene_->scene.cameras[0];
    request_.options = common_.render;
    request_.options.size = ImageSize{96, 70};
    request_.withReference = request_.interruptible = true;
  }

  cli::TemporaryFolder folder_;
  cli::CommonOptions common_;
  std::shared_ptr<cli::OpenScene> scene_;
  FrameRequest request_;
};

// Nobody wants anything else.
TraceCalls heedless() {
  TraceCalls calls;
  calls.superseded = calls.stopped = [] { return false; };
  calls.answer = [] {};
  calls.publish = [](const TracedFrame&) {};
  calls.showUnfinished = [](const UnfinishedFrame&) {};
  return calls;
}

TEST_F(ComparisonTest, GrowsUntilItIsTheReference) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  int rows = 0;
  TraceCalls calls = heedless();
  calls.publish = [&](const TracedFrame& sofar) {
    ASSERT_TRUE(sofar.comparison);
    EXPECT_GT(sofar.comparison->rows, rows);
    EXPECT_FALSE(sofar.comparison->complete());
    rows = sofar.comparison->rows;
    EXPECT_DOUBLE_EQ(sofar.comparison->progress(), rows / 70.0);
  };
  ASSERT_TRUE(tracer.trace(request_, frame, calls));
  EXPECT_EQ(rows, 70);
  ASSERT_TRUE(frame.comparison && frame.comparison->complete());

  Renderer renderer(scene_->scene, request_.options);
  Film film = makeFilm(scene_->scene, request_.options);
  renderer.renderReference(request_.camera, film);
  const Comparison& comparison = *frame.comparison;
  EXPECT_EQ(std::memcmp(comparison.reference.image.pixels.data(), film.image.pixels.data(),
                        film.image.pixels.size() * sizeof(Rgb)),
            0);
  EXPECT_EQ(comparison.reference.display.rgba, film.display.rgba);
  EXPECT_EQ(comparison.difference->rmse, compareImages(frame.film.image, film.image).rmse);
  EXPECT_EQ(comparison.heatMap.rgba, heatMap(frame.film.image, film.image).rgba);
}

TEST_F(ComparisonTest, GivesUpForSomethingElse) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  int published = 0;
  request_.spp = 64;  // for more than one band
  TraceCalls calls = heedless();
  calls.superseded = [&] { return published > 0; };
  calls.publish = [&](const TracedFrame&) { ++published; };
  EXPECT_FALSE(tracer.trace(request_, frame, calls));
  EXPECT_EQ(published, 1);
}

// Hours of work, were it not given up between two tiles.
TEST_F(ComparisonTest, FramesInMotionEndWhenNobodyLooks) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  request_.withReference = request_.interruptible = false;
  request_.options.size = {4000, 4000};
  request_.spp = 64;
  std::atomic<int> asked{0};
  TraceCalls calls = heedless();
  calls.stopped = [&] { return ++asked > 2; };
  EXPECT_FALSE(tracer.trace(request_, frame, calls));
  EXPECT_LT(asked, 20);
}

}  // namespace
}  // namespace whit::view
