// The image is a function of scene and view alone. Threads, tiles, queues, batches, packet widths
// and unused effects that are compiled in change no bit.
#include <gtest/gtest.h>

#include "render/shipped_scene.h"

namespace whit::test {
namespace {

class Invariance : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    scene_ = load(GetParam());
    expected_ = render(scene_, smallOptions());
  }
  void expectSame(const RenderOptions& options, const std::string& what) {
    EXPECT_EQ(firstDifference(render(scene_, options).image, expected_.image), "") << what;
  }
  Scene scene_;
  Picture expected_;
};

TEST_P(Invariance, H60_twoRunsGiveTheSameBits) { expectSame(smallOptions(), "second run"); }

TEST_P(Invariance, H60_anyNumberOfThreadsGivesTheSameBits) {
  for (const int threads : {1, 3, 8}) {
    RenderOptions o = smallOptions();
    o.threads = threads;
    expectSame(o, std::to_string(threads) + " threads");
  }
}

TEST_P(Invariance, H60_anyTileGivesTheSameBits) {
  for (const int tile : {5, 8, 16, 64, 128}) {
    RenderOptions o = smallOptions();
    o.tile = tile;
    expectSame(o, "tiles of " + std::to_string(tile));
  }
}

TEST_P(Invariance, H60_anyQueueGivesTheSameBits) {
  for (const int queue : {16, 48, 1000, 65536}) {
    RenderOptions o = smallOptions();
    o.queue = queue;
    expectSame(o, "queues of " + std::to_string(queue));
  }
}

TEST_P(Invariance, H60_wholeFrameBatchesGiveTheSameBits) {
  for (const int threads : {1, 2, 3}) {
    RenderOptions o = smallOptions();
    o.batch = Batch::frame;
    o.threads = threads;
    expectSame(o, "whole frames with " + std::to_string(threads) + " threads");
  }
}

TEST_P(Invariance, H59_anyPacketWidthGivesTheSameBits) {
  for (const int packet : {1, 4, 8, 16}) {
    RenderOptions o = smallOptions();
    o.packet = packet;
    expectSame(o, "packets of " + std::to_string(packet));
  }
}

TEST_P(Invariance, H59_croppedPixelsHaveTheBitsOfTheWholeImage) {
  RenderOptions o = smallOptions();
  for (const Crop crop : {Crop{13, 7, 14, 8}, Crop{0, 0, 17, 3}, Crop{40, 1, 41, o.size->height}}) {
    o.crop = crop;
    const Image part = render(scene_, o).image;
    for (int y = crop.y0; y < crop.y1; ++y) {
      for (int x = crop.x0; x < crop.x1; ++x) {
        EXPECT_EQ(part.at(x, y), expected_.image.at(x, y)) << x << "," << y;
      }
    }
  }
}

TEST_P(Invariance, H61g_everyEffectCompiledInGivesTheSameBits) {
  RenderOptions o = smallOptions();
  o.effects = EffectChoice::all;
  expectSame(o, "all effects");
}

TEST_P(Invariance, H76_supersamplingIsTheSameForAnyTileAndQueue) {
  RenderOptions o = smallOptions();
  o.spp = 3;
  const Picture several = render(scene_, o);
  o.tile = 8;
  o.queue = 16;
  o.threads = 1;
  EXPECT_EQ(firstDifference(render(scene_, o).image, several.image), "");
}

TEST_P(Invariance, NoPixelIsNonFinite) { EXPECT_EQ(expected_.stats.nonFinitePixels, 0u); }

// The picture is large enough that some of the rays of its long chains hit edges.
TEST(InvarianceAlone, H60_aHallOfMirrorsHasTheSameBitsInEachWay) {
  const Scene scene = load("mirrors");
  RenderOptions o = smallOptions();
  o.size = ImageSize{200, 120};

  for (const int spp : {1, 3}) {
    o.spp = spp;
    const Picture expected = render(scene, o);
    std::vector<RenderOptions> variants(5, o);
    variants[0].packet = 1;
    variants[1].packet = 4;
    variants[2].tile = 8;
    variants[3].queue = 64;
    variants[4].batch = Batch::frame;

    for (const RenderOptions& v : variants) {
      EXPECT_EQ(firstDifference(render(scene, v).image, expected.image), "")
          << "variant " << &v - variants.data() << ", " << spp << " samples";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Invariance, testing::ValuesIn(smallScenes()),
                         [](const auto& info) {
                           return info.param.substr(0, info.param.find('?'));
                         });

}  // namespace
}  // namespace whit::test
