// Which pixels get every sample, worked out by hand on three pixels in a row.
#include "sampling/adaptive_pixels.h"

#include <gtest/gtest.h>

namespace whit {
namespace {

constexpr int kContrast = 10;  // in codes: 20 within a pixel, 40 across its border

class ProbesInARow : public testing::Test {
 protected:
  void setAll(int x, std::uint32_t code) { probes_.at(x, 5).codes.fill(code); }

  bool differs(int x) const { return probes_.differ(x, 5, kContrast); }

  // Returns the number of the leftmost probe sample. It lies in the left half, because the probe
  // samples are near four rooks, which have a column each.
  std::size_t leftmost() const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < kProbeSamples; ++k) {
      if (pattern_[k].x < pattern_[best].x) best = k;
    }
    return best;
  }

  std::vector<Vec2f> pattern_ = samplePattern(16);
  std::vector<std::uint8_t> edges_{1, 1, 1};
  ProbeSamples probes_{{7, 5, 10, 6}, edges_, pattern_};
};

TEST_F(ProbesInARow, SamplesOfOnePixelMayDifferByTwiceTheContrast) {
  for (const int shift : {0, 8, 16}) {  // any channel
    for (int x = 7; x < 10; ++x) setAll(x, 0x404040);
    probes_.at(8, 5).codes[2] = 0x404040u + (20u << shift);
    EXPECT_FALSE(differs(8)) << shift;
    probes_.at(8, 5).codes[2] = 0x404040u + (21u << shift);
    EXPECT_TRUE(differs(8)) << shift;
  }
}

TEST_F(ProbesInARow, TheNextPixelCountsByItsNearestSample) {
  setAll(7, 0), setAll(8, 0), setAll(9, 0);
  probes_.at(9, 5).codes[leftmost()] = 41;
  EXPECT_TRUE(differs(8));
  EXPECT_FALSE(differs(7)) << "two pixels away";

  probes_.at(9, 5).codes[leftmost()] = 40;
  EXPECT_FALSE(differs(8));

  // Samples further away do not count.
  setAll(9, 255);
  probes_.at(9, 5).codes[leftmost()] = 0;
  EXPECT_FALSE(differs(8));
}

TEST_F(ProbesInARow, PixelsWithoutProbesDoNotCount) {
  setAll(7, 0), setAll(8, 0), setAll(9, 255);
  EXPECT_TRUE(differs(8));
  edges_[2] = 0;
  EXPECT_FALSE(differs(8));
}

}  // namespace
}  // namespace whit
