// Embree's calls return whatever the stack below them held before.
#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

#include "accel/accel.h"
#include "set_columns.h"
#include "shipped_scene.h"
#include "stages/columns.h"

namespace whit {
namespace {

// A call that does not return ends the program after so many seconds.
constexpr unsigned kPatience = 60;
constexpr std::size_t kRays = 40;  // not a multiple of the widest packet

// Leaves ones where the functions that are called next keep their variables.
[[gnu::noinline]] void useStack() {
  volatile unsigned char used[1 << 16];
  for (volatile unsigned char& byte : used) byte = 0xff;
}

class UsedStack : public testing::TestWithParam<int> {
 protected:
  // The scene has instances: see EmbreeScene::coherentAnyHitMayHang.
  UsedStack() : scene_(test::load("mirrors")), accel_(scene_, optionsOf(GetParam())) {
    rays_.allocate(kRays, FeatureSet());
    hits_.allocate(kRays, FeatureSet());
    shadows_.allocate(kRays, FeatureSet());
    alarm(kPatience);
  }
  ~UsedStack() override { alarm(0); }

  static RenderOptions optionsOf(int packet) {
    RenderOptions options;
    options.threads = 1;
    options.packet = packet;
    return options;
  }

  // Aims rays from above the scene and away from it, side by side, so that nothing stops them.
  template <typename Columns>
  void aim(const Columns& rays) {
    const Vec3f middle = 0.5f * (scene_.lower + scene_.upper), size = scene_.upper - scene_.lower;
    for (const auto i : indices(kRays)) {
      const float aside = 0.01f * size.x * static_cast<float>(i);
      test::setRay(rays, i, {middle.x + aside, scene_.upper.y + size.y, middle.z}, {0, 1, 0});
    }
  }

  const Scene scene_;
  const Accel accel_;

  // Makes a chunk that has all rays in one segment.
  Chunk chunkOf(bool coherent) {
    constants_.accel = &accel_;
    Chunk chunk;
    chunk.frame = &constants_;
    chunk.meter = &meter_;
    chunk.coherent = coherent;
    chunk.n = chunk.shadowCount = kRays;
    chunk.segments[0] = {RayKind::primary, 0, kRays};
    chunk.segmentCount = 1;
    chunk.rays = *rays_;
    chunk.hits = *hits_;
    chunk.shadows = *shadows_;
    return chunk;
  }

  FrameConstants constants_;
  TraceMeter meter_;
  ColumnStore<RayColumns> rays_;
  ColumnStore<HitColumns> hits_;
  ColumnStore<ShadowColumns> shadows_;
};

TEST_P(UsedStack, OcclusionReturns) {
  aim(*shadows_);
  for (std::uint32_t i = 0; i < kRays; ++i) {
    shadows_->tFar[i] = 10 * (scene_.upper.y - scene_.lower.y);
    shadows_->slot[i] = i;
  }

  for (const bool coherent : {true, false}) {
    std::vector<float> visible(kRays, -1.0f);
    useStack();
    Chunk chunk = chunkOf(coherent);
    chunk.unshadowed.visible = visible.data();
    checkShadows(chunk);
    EXPECT_EQ(visible, std::vector<float>(kRays, 1.0f));
  }
}

TEST_P(UsedStack, IntersectionReturns) {
  aim(*rays_);
  for (const bool coherent : {true, false}) {
    useStack();
    Chunk chunk = chunkOf(coherent);
    findHits(chunk);
    for (const auto i : indices(kRays)) EXPECT_EQ(hits_->triangle[i], kMiss) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Packets, UsedStack, testing::Values(1, 4, 8, 16));

}  // namespace
}  // namespace whit
