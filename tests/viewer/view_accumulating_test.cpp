// Pictures at rest whose rays are sampled: they get more and more samples, and report the number of
// samples and the error.
#include <gtest/gtest.h>

#include "render_thread_fixture.h"
#include "viewer/panel.h"

namespace whit::view {
namespace {

class Accumulating : public FrameTracerTest {
 protected:
  Accumulating() {
    open("glossy");
    request_.options.glossy = 1;
    request_.options.size = request_.window = ImageSize{90, 60};
    request_.spp = 32;
    calls_.showUnfinished = [this](UnfinishedFrame sight) { sights_.push_back(std::move(sight)); };
  }

  std::vector<UnfinishedFrame> sights_;
};

TEST_F(Accumulating, EndsWithThePictureOfSoManySamplesBitForBit) {
  const TracedFrame frame = traced();
  EXPECT_TRUE(frame.sampled);
  expectSameFilm(frame.film, expected());
}

// Scenes of mirrors and glass bound their rays (--max-rays), which numbers the paths of a sample as
// sampling does. Nothing in them is sampled, so that the viewer must not refine them without end.
TEST_F(Accumulating, OnlyWhereRaysAreSampled) {
  request_.options.glossy = 0;
  request_.spp = 4;
  for (const char* name : {"glossy", "whitted", "glass"}) {
    SCOPED_TRACE(name);
    open(name);
    const TracedFrame frame = traced();
    EXPECT_FALSE(frame.sampled);
    EXPECT_EQ(frame.sampleError, 0);
    EXPECT_TRUE(sights_.empty());
  }
}

// The time of a sample is not known yet, so that each pass has one.
TEST_F(Accumulating, SightsHaveMoreSamplesAndLessError) {
  const TracedFrame frame = traced();
  ASSERT_EQ(sights_.size(), 31u);
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    EXPECT_EQ(sights_[i].samples, static_cast<int>(i) + 1);
    EXPECT_EQ(sights_[i].display.rgba.size(), std::size_t{90 * 60 * 4}) << "all pixels, in each";
  }

  EXPECT_EQ(sights_[0].sampleError, 0) << "nothing is known of it";
  // The estimated error falls with the number of samples.
  EXPECT_LT(sights_[15].sampleError, sights_[3].sampleError);
  EXPECT_LT(frame.sampleError, sights_[15].sampleError);
  EXPECT_GT(frame.sampleError, 0);
}

// The picture that is shown stays until the next one has more samples.
TEST_F(Accumulating, NoSightHasFewerSamplesThanWhatIsShown) {
  FrameTracer tracer(opened_, common_);
  request_.spp = 8;
  traced(tracer);
  sights_.clear();
  request_.spp = 32;
  traced(tracer);
  ASSERT_FALSE(sights_.empty());
  for (const UnfinishedFrame& sight : sights_) EXPECT_GT(sight.samples, 8);
}

TEST_F(Accumulating, IsGivenUpInBetween) { expectIsGivenUpInBetween(); }

TEST(AccumulatingWords, SaySamplesAndError) {
  ViewState state;
  UnfinishedFrame& sight = state.unfinished.emplace();
  sight.request.spp = 256;
  sight.samples = 100;
  EXPECT_EQ(statusText(state), "100 of 256 samples");
  sight.sampleError = 0.0123;
  EXPECT_EQ(statusText(state), "100 of 256 samples, within about 1.2 %");
}

}  // namespace
}  // namespace whit::view
