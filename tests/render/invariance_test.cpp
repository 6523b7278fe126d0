// The image is a function of scene and view alone. Threads, tiles, queues, batches, packet widths
// and unused effects that are compiled in change no bit.
#include <gtest/gtest.h>

#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

using Invariance = SceneTest;

TEST_P(Invariance, H60_anyDivisionOfTheWorkGivesTheSameBits) {
  std::vector<Division> divisions = usualDivisions();
  divisions.push_back({"the same again", [](RenderOptions&) {}});
  for (const int n : {5, 8}) {
    divisions.push_back({"threads", [n](RenderOptions& o) { o.threads = n; }});
  }
  for (const int n : {5, 16, 64, 128}) {
    divisions.push_back({"tiles", [n](RenderOptions& o) { o.tile = n; }});
  }
  for (const int n : {16, 64, 128, 1000, 65536}) {
    divisions.push_back({"queues", [n](RenderOptions& o) { o.queue = n; }});
  }
  expectBitsWhateverTheQueues(scene_, smallOptions(), divisions);

  // Whole frames, by several numbers of threads.
  RenderOptions o = smallOptions();
  o.batch = Batch::frame;
  expectBitsWhateverTheQueues(scene_, o);
}

TEST_P(Invariance, H59_anyPacketWidthGivesTheSameBits) {
  std::vector<Division> widths;
  for (const int packet : {1, 4, 8, 16}) {
    widths.push_back({"packets", [packet](RenderOptions& o) { o.packet = packet; }});
  }
  expectBitsWhateverTheQueues(scene_, smallOptions(), widths);
}

TEST_P(Invariance, H59_croppedPixelsHaveTheBitsOfTheWholeImage) {
  const RenderOptions o = smallOptions();
  for (const Crop crop : {Crop{13, 7, 14, 8}, Crop{0, 0, 17, 3}, Crop{40, 1, 41, o.size->height}}) {
    expectBitsOfTheWhole(scene_, o, crop);
  }
}

// The picture is large enough that some of the rays of its long chains hit edges.
TEST(InvarianceAlone, H60_aHallOfMirrorsHasTheSameBitsInEachWay) {
  RenderOptions o = smallOptions({200, 120});
  std::vector<Division> divisions = usualDivisions();
  divisions.push_back({"rays alone", [](RenderOptions& o) { o.packet = 1; }});

  for (const int spp : {1, 3}) {
    o.spp = spp;
    expectBitsWhateverTheQueues(load("mirrors"), o, divisions);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Invariance, testing::ValuesIn(smallScenes()), sceneName);

}  // namespace
}  // namespace whit::test
