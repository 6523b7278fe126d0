// Pictures at rest whose rays are sampled: they get more and more samples, and report the number of
// samples and the error.
#include <gtest/gtest.h>

#include <atomic>

#include "cli/run_program.h"
#include "has_text.h"
#include "output/open_and_warn.h"
#include "viewer/panel.h"
#include "viewer/session/frame_tracer.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

class Accumulating : public testing::Test {
 protected:
  Accumulating() {
    common_.quiet = true;
    common_.render.threads = 2;
    scene_ = openAndWarn("glossy", common_, nullptr);

    request_.camera = scene_->scene.cameras[0];
    request_.options = common_.render;
    request_.options.glossy = 1;
    request_.options.size = request_.window = ImageSize{90, 60};
    request_.interruptible = true;
    request_.spp = 32;

    calls_.superseded = calls_.stopped = [this] { return ++pieces_ > most_; };
    calls_.answer = [] {};
    calls_.publish = [](const TracedFrame&) {};
    calls_.showUnfinished = [this](UnfinishedFrame sight) { sights_.push_back(std::move(sight)); };
  }

  Film rendered(int spp) const {
    RenderOptions options = request_.options;
    options.spp = spp;
    Renderer renderer(scene_->scene, options);
    Film film = makeFilm(scene_->scene, options);
    renderer.render(request_.camera, film);
    return film;
  }

  cli::CommonOptions common_;
  std::shared_ptr<OpenScene> scene_;
  FrameRequest request_;
  TraceCalls calls_;
  std::vector<UnfinishedFrame> sights_;
  std::atomic<int> pieces_{0};  // several workers count
  int most_ = 1'000'000;
};

TEST_F(Accumulating, EndsWithThePictureOfSoManySamplesBitForBit) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  ASSERT_TRUE(tracer.trace(request_, frame, calls_));
  EXPECT_TRUE(frame.sampled);

  const Film film = rendered(32);
  EXPECT_EQ(frame.film.image.pixels, film.image.pixels);
  EXPECT_EQ(frame.film.display.rgba, film.display.rgba);
}

// Scenes of mirrors and glass bound their rays (--max-rays), which numbers the paths of a sample as
// sampling does. Nothing in them is sampled, so that the viewer must not refine them without end.
TEST_F(Accumulating, BoundedRaysAreNotSampled) {
  request_.options.glossy = 0;
  request_.spp = 1;
  for (const char* name : {"whitted", "glass"}) {
    const std::shared_ptr<OpenScene> scene = openAndWarn(name, common_, nullptr);
    request_.camera = scene->scene.cameras[0];
    FrameTracer tracer(scene, common_);
    TracedFrame frame;
    ASSERT_TRUE(tracer.trace(request_, frame, calls_));
    EXPECT_FALSE(frame.sampled) << name;
  }
}

// The time of a sample is not known yet, so that each pass has one.
TEST_F(Accumulating, SightsHaveMoreSamplesAndLessError) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  ASSERT_TRUE(tracer.trace(request_, frame, calls_));

  ASSERT_EQ(sights_.size(), 31u);
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    const UnfinishedFrame& sight = sights_[i];
    EXPECT_EQ(sight.samples, static_cast<int>(i) + 1);
    EXPECT_EQ(sight.display.rgba.size(), std::size_t{90 * 60 * 4}) << "all pixels, in each";
  }

  EXPECT_EQ(sights_[0].sampleError, 0) << "nothing is known of it";
  // The estimated error falls with the number of samples.
  EXPECT_LT(sights_[15].sampleError, sights_[3].sampleError);
  EXPECT_LT(frame.sampleError, sights_[15].sampleError);
  EXPECT_GT(frame.sampleError, 0);
}

// The picture that is shown stays until the next one has more samples.
TEST_F(Accumulating, NoSightHasFewerSamplesThanWhatIsShown) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  request_.spp = 8;
  ASSERT_TRUE(tracer.trace(request_, frame, calls_));
  sights_.clear();
  request_.spp = 32;
  ASSERT_TRUE(tracer.trace(request_, frame, calls_));
  ASSERT_FALSE(sights_.empty());
  for (const UnfinishedFrame& sight : sights_) EXPECT_GT(sight.samples, 8);
}

TEST_F(Accumulating, IsGivenUpInBetween) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  most_ = 3;
  EXPECT_FALSE(tracer.trace(request_, frame, calls_));
  EXPECT_GE(pieces_, 4);
  EXPECT_LT(pieces_, 20) << "workers go on";
}

TEST_F(Accumulating, OnlyWhereRaysAreSampled) {
  FrameTracer tracer(scene_, common_);
  TracedFrame frame;
  request_.options.glossy = 0;
  ASSERT_TRUE(tracer.trace(request_, frame, calls_));
  EXPECT_FALSE(frame.sampled);
  EXPECT_EQ(frame.sampleError, 0);
  EXPECT_TRUE(sights_.empty());
  EXPECT_EQ(frame.film.image.pixels, rendered(32).image.pixels);
}

TEST(AccumulatingWords, SaySamplesAndError) {
  ViewState state;
  UnfinishedFrame& sight = state.unfinished.emplace();
  sight.request.spp = 256;
  sight.samples = 100;
  EXPECT_EQ(statusText(state), "100 of 256 samples");
  sight.sampleError = 0.0123;
  EXPECT_EQ(statusText(state), "100 of 256 samples, within about 1.2 %");
}

// The picture in the window is what the printed command renders, with many samples.
TEST_F(Viewer, AccumulatesAtRest) {
  std::ofstream(folder_ / "rough.json") << R"({
    "whit": 1, "size": [48, 32],
    "cameras": {"front": {"eye": [0, 2, 6], "at": [0, 1, 0], "fov": 40}},
    "lights": [{"name": "lamp", "position": [3, 6, 4], "intensity": [60, 60, 60]}],
    "materials": {"floor": {"diffuse": 0.5},
                  "rough": {"diffuse": 0.1, "specular": 0.8, "roughness": 0.4,
                            "glossyReflection": true}},
    "scene": [{"shape": "quad", "width": 8, "depth": 8, "material": "floor"},
              {"shape": "sphere", "radius": 1, "material": "rough",
               "transform": {"translate": [0, 1, 0]}}]
  })";

  std::ofstream(folder_ / "script.txt") << "bare\nwait sharp\nscreenshot shown.png\nkey C\n";
  const cli::Outcome outcome = runOn(display_.name(), folder_.path().string(),
                                     {WHIT_VIEW_SCRIPT_PROGRAM, "rough.json", "--quiet", "--glossy",
                                      "1", "--size", "320x240", "--script", "script.txt"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  EXPECT_TRUE(hasText(lines[0], "--spp=256"));
  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
}

}  // namespace
}  // namespace whit::view
