// Packets go to Embree nearly full at every depth, because rays are compacted into queues.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/files.h"
#include "render/shipped_scene.h"
#include "sanitized.h"

namespace whit::test {
namespace {

// Share of a packet's lanes that carry a ray. Each tile ends its queues with a packet that is half
// full on average, and has a thousand rays of each kind.
constexpr double kLanesFilled = 0.97;

double laneShare(const RayTally& tally) {
  return static_cast<double>(tally.rays) / static_cast<double>(tally.lanes);
}

void expectFullPackets(const std::string& name) {
  if (kSanitized) GTEST_SKIP() << "other tests watch the same kernels";
  RenderOptions options;
  options.size = ImageSize{480, 300};
  options.depth = 8;

  const Scene scene = load(name);

  for (const int packet : {8, 16}) {
    options.packet = packet;
    const FrameStats stats = render(scene, options).stats;
    for (const RayKind kind : {RayKind::shadow, RayKind::reflection}) {
      ASSERT_GT(stats.of(kind).rays, 10000u);
      EXPECT_GE(laneShare(stats.of(kind)), kLanesFilled)
          << name << " packet " << packet << " " << rowOf(kind).name;
    }
  }
}

TEST(LanesFilled, InAtrium) { expectFullPackets("atrium"); }
TEST(LanesFilled, InLandscape) { expectFullPackets("landscape"); }
TEST(LanesFilled, InSponza) {
  if (!std::filesystem::exists(dataFolder() / "crytek_sponza/sponza.obj")) {
    GTEST_SKIP() << "NOT TESTED: no crytek_sponza in '" << dataFolder() << "'; set WHIT_DATA";
  }
  expectFullPackets("sponza-mirror");
}

}  // namespace
}  // namespace whit::test
