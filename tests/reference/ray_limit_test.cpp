// The bound on the rays of a sample, against a closed form: a pile of half-covering mirrors, where
// every ray splits in two at every bounce.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "reference/sample_mean.h"
#include "reference/small_scenes.h"
#include "sampling/ray_limit.h"

namespace whit::test {
namespace {

using reference::RayCounts;

// Returns `sheets` horizontal sheets that mirror a share of the light and transmit the rest,
// between a sky of radiance 1 above and a black one below.
Scene pile(int sheets, float mirrored) {
  SceneBuilder builder;
  Material sheet = mirrorMaterial(1);
  sheet.coverage = mirrored;
  const std::uint32_t material = builder.add(sheet);

  for (int i = 0; i < sheets; ++i) builder.add(floorAt(static_cast<float>(i), 10, material));
  builder.description.sky.kind = Sky::Kind::gradient;
  builder.description.sky.zenith = Rgb(1.0f);
  return builder.build();
}

// Returns the radiance below the pile: the chance that a random walk of at most `depth` steps ends
// above it. The gaps between the sheets are numbered from below.
double seenBelow(int sheets, double mirrored, int depth) {
  const auto gaps = static_cast<std::size_t>(sheets) + 1;

  // Radiance along rays that look up from each gap, and down. The loop begins with rays of the last
  // depth.
  std::vector<double> up(gaps), down(gaps);
  up.back() = 1;

  for (int step = 0; step < depth; ++step) {
    std::vector<double> nextUp(gaps), nextDown(gaps);
    nextUp.back() = 1;
    for (std::size_t g = 0; g + 1 < gaps; ++g) {
      nextUp[g] = mirrored * down[g] + (1 - mirrored) * up[g + 1];
      nextDown[g + 1] = mirrored * up[g + 1] + (1 - mirrored) * down[g];
    }

    up = nextUp;
    down = nextDown;
  }

  return up[0];
}

// Looks up from below the pile, along one ray.
class BelowPile {
 public:
  BelowPile(const Scene& scene, int depth, int maxRays)
      : bruteForce_(scene), tracer_(scene, bruteForce_, settingsFor(depth, maxRays)) {
    Camera camera;
    camera.eye = {0.3f, -3, 0.2f};
    camera.at = {0.3f, 0, 0.2f};
    camera.up = {0, 0, 1};
    camera.orthographicHeight = 1;
    frame_ = makeCameraFrame(camera, 1, 1);
  }

  // Traces one of many samples, which differ only in their random numbers.
  double look(std::size_t sample) {
    counts = {};
    return tracer_.sampled(frame_, 0, 0, {0.5f, 0.5f}, sample, counts).x;
  }

  std::uint64_t impulses() const {
    return counts[RayKind::reflection] + counts[RayKind::refraction];
  }

  RayCounts counts;

 private:
  static reference::Settings settingsFor(int depth, int maxRays) {
    reference::Settings settings = uncut(depth);
    settings.options.maxRays = maxRays;
    return settings;
  }

  reference::BruteForce bruteForce_;
  reference::Tracer tracer_;
  CameraFrame frame_;
};

TEST(RayLimit, LeavesTreesOfAsManyRaysAsItAllows) {
  const Scene scene = pile(4, 0.5f);
  constexpr int kDepth = 11;
  BelowPile whole(scene, kDepth, 0);
  const double value = whole.look(0);
  EXPECT_NEAR(value, seenBelow(4, 0.5, kDepth), 1e-12);
  const auto size = static_cast<int>(whole.impulses());
  ASSERT_GT(size, 300);

  BelowPile just(scene, kDepth, size), less(scene, kDepth, size - 1);
  EXPECT_EQ(just.look(0), value);
  EXPECT_EQ(just.impulses(), whole.impulses());
  EXPECT_EQ(just.counts.limitedSamples, 0u);
  EXPECT_NE(less.look(0), value);
  EXPECT_EQ(less.counts.limitedSamples, 1u);
}

TEST(RayLimit, BoundsTheRaysAndKeepsTheMean) {
  // Without the limit, trees of this depth would have far more rays than can be traced.
  constexpr int kDepth = 40, kSamples = 2000;
  for (const float mirrored : {0.5f, 0.2f, 0.8f}) {
    const Scene scene = pile(8, mirrored);
    for (const int maxRays : {1, 200}) {
      BelowPile pixel(scene, kDepth, maxRays);
      SampleMean mean;
      for (std::size_t sample = 0; sample < kSamples; ++sample) {
        mean.add(pixel.look(sample));
        ASSERT_LE(pixel.impulses(), static_cast<unsigned>(std::max(maxRays, kDepth)));
        ASSERT_EQ(pixel.counts.limitedSamples, 1u);
      }

      // 4.5 standard errors: one comparison in 150,000 would fail by chance.
      EXPECT_NEAR(mean.value(), seenBelow(8, double{mirrored}, kDepth), 4.5 * mean.error())
          << mirrored << " mirrored, at most " << maxRays << " rays";
    }
  }
}

TEST(RayLimit, WidthsAndDrawsAreInTheirRanges) {
  EXPECT_EQ(widestTree(10000, 64), 156u);
  EXPECT_EQ(widestTree(3, 64), 1u);
  EXPECT_EQ(widestTree(3, 0), 3u);

  std::set<int> tenths;
  for (std::uint32_t path = 0; path < 1000; ++path) {
    const double draw = choiceDraw(path);
    ASSERT_GE(draw, 0);
    ASSERT_LT(draw, 1);
    tenths.insert(static_cast<int>(draw * 10));
  }
  EXPECT_EQ(tenths.size(), 10u);
}

}  // namespace
}  // namespace whit::test
