// The bound on the rays of a sample, against a closed form: a pile of half-covering mirrors, where
// every ray splits in two at every bounce.
#include <gtest/gtest.h>

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
  Material sheet = mirrorMaterial(1);
  sheet.coverage = mirrored;
  SceneBuilder builder = withFloor(sheet, 10);
  for (int i = 1; i < sheets; ++i) builder.add(floorAt(static_cast<float>(i), 10, 0));
  whiteAbove(builder);
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

// Looks up from below the pile, along one ray. Samples differ only in their random numbers.
double lookUp(const Scene& scene, int depth, int maxRays, RayCounts& counts,
              std::size_t sample = 0) {
  reference::Settings settings = uncut(depth);
  settings.options.maxRays = maxRays;
  const Camera camera{.eye = {0, -3, 0}, .up = {0, 0, 1}};

  const BruteForce bruteForce(scene);
  counts = {};
  return reference::Tracer(scene, bruteForce, settings)
      .sampled(makeCameraFrame(camera, 1, 1), 0, 0, {0.5f, 0.5f}, sample, counts)
      .x;
}

std::uint64_t impulsesOf(const RayCounts& counts) {
  return counts[RayKind::reflection] + counts[RayKind::refraction];
}

TEST(RayLimit, LeavesTreesOfAsManyRaysAsItAllows) {
  const Scene scene = pile(4, 0.5f);
  constexpr int kDepth = 11;
  RayCounts counts;
  const double value = lookUp(scene, kDepth, 0, counts);
  EXPECT_NEAR(value, seenBelow(4, 0.5, kDepth), 1e-12);
  const auto size = static_cast<int>(impulsesOf(counts));
  ASSERT_GT(size, 300);

  EXPECT_EQ(lookUp(scene, kDepth, size, counts), value);
  EXPECT_EQ(impulsesOf(counts), static_cast<unsigned>(size));
  EXPECT_EQ(counts.limitedSamples, 0u);
  EXPECT_NE(lookUp(scene, kDepth, size - 1, counts), value);
  EXPECT_EQ(counts.limitedSamples, 1u);
}

TEST(RayLimit, BoundsTheRaysAndKeepsTheMean) {
  // Without the limit, trees of this depth would have far more rays than can be traced.
  constexpr int kDepth = 40, kSamples = 2000;
  for (const float mirrored : {0.5f, 0.2f, 0.8f}) {
    const Scene scene = pile(8, mirrored);
    for (const int maxRays : {1, 200}) {
      RayCounts counts;
      const SampleMean mean = meanOf(kSamples, [&](auto sample) {
        const double seen = lookUp(scene, kDepth, maxRays, counts, sample);
        EXPECT_LE(impulsesOf(counts), static_cast<unsigned>(std::max(maxRays, kDepth)));
        EXPECT_EQ(counts.limitedSamples, 1u);
        return seen;
      });

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
