// Nested dielectrics and absorption (hard cases H45, H46, H50).
#include "reference/media.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

// Returns a scene with the vacuum, and media 1 and so on with these priorities.
Scene sceneWithPriorities(const std::vector<int>& priorities) {
  Scene scene;
  scene.media.resize(1);
  for (const int priority : priorities) scene.media.push_back({1.5f, {0, 0, 0}, priority});
  return scene;
}

TEST(MediaStack, PushAndRemove) {
  EXPECT_EQ(pushMedium(0, 3), 0x3u);
  EXPECT_EQ(pushMedium(0x3, 7), 0x307u);
  EXPECT_EQ(pushMedium(0x01020304, 5), 0x02030405u) << "the oldest falls out";
  EXPECT_EQ(removeMedium(0x01020304, 4), 0x010203u);
  EXPECT_EQ(removeMedium(0x01020304, 3), 0x010204u);
  EXPECT_EQ(removeMedium(0x01020304, 1), 0x020304u);
  EXPECT_EQ(removeMedium(0x05060506, 5), 0x050606u) << "the one entered last";
  EXPECT_EQ(removeMedium(0x0102, 9), 0x0102u) << "absent";
  EXPECT_EQ(removeMedium(0, 1), 0u);
}

TEST(MediaStack, HighestPriorityCounts) {
  const Scene scene = sceneWithPriorities({0, 5, 5, -2});
  EXPECT_EQ(currentMedium(scene, 0), 0u);
  EXPECT_EQ(currentMedium(scene, 0x4), 4u) << "below the vacuum's priority, yet it fills the space";
  EXPECT_EQ(currentMedium(scene, 0x0201), 2u);
  EXPECT_EQ(currentMedium(scene, 0x0102), 2u);
  EXPECT_EQ(currentMedium(scene, 0x0203), 3u) << "a tie goes to the one entered last";
  EXPECT_EQ(currentMedium(scene, 0x03020401), 2u);
}

// Four balls overlap at random. Between two surfaces along any line, the stack holds exactly the
// balls around that stretch.
TEST(MediaStack, KnowsWhatSurroundsEveryStretch) {
  struct Ball {
    Vec3d center;
    double radius;
  };
  const Scene scene = sceneWithPriorities({3, 1, 2, 4});
  test::Numbers numbers(8);
  for (int line = 0; line < 20000; ++line) {
    std::vector<Ball> balls;
    for (int i = 0; i < 4; ++i) {
      balls.push_back({numbers.direction() * numbers.in(0, 1), numbers.in(0.3, 2)});
    }
    const Vec3d d = numbers.direction(), origin = numbers.direction() * 0.5 - d * 10.0;

    struct Event {
      double t;
      std::uint32_t ball;
      bool entering;
    };

    // Intersections of the line with the balls, in their order.
    std::vector<Event> events;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vec3d o = origin - balls[i].center;
      const double b = dot(o, d), square = b * b - dot(o, o) + balls[i].radius * balls[i].radius;
      if (square <= 0) continue;
      events.push_back({-b - std::sqrt(square), i, true});
      events.push_back({-b + std::sqrt(square), i, false});
    }
    std::sort(events.begin(), events.end(), [](auto& a, auto& b) { return a.t < b.t; });

    MediaStack stack = 0;
    for (std::size_t e = 0; e < events.size(); ++e) {
      const std::uint32_t medium = events[e].ball + 1;
      stack = events[e].entering ? pushMedium(stack, medium) : removeMedium(stack, medium);
      const double next = e + 1 < events.size() ? events[e + 1].t : events[e].t + 1;
      const Vec3d middle = origin + d * (0.5 * (events[e].t + next));

      int around = 0, highest = 0;
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (length(middle - balls[i].center) >= balls[i].radius) continue;
        ++around;
        highest = std::max(highest, scene.media[i + 1].priority);
      }

      ASSERT_EQ((std::bit_width(stack) + 7) / 8, around);
      ASSERT_EQ(scene.media[currentMedium(scene, stack)].priority, highest);
    }

    ASSERT_EQ(stack, 0u);
  }
}

TEST(Crossing, OfSurfacesThatBoundNoMedium) {
  test::SceneBuilder builder;
  const auto opaque = builder.add(test::diffuseMaterial(0.5f));
  const auto glass = builder.add(test::glassMaterial(1.5f));
  builder.add(test::floorAt(0, 1, opaque));
  builder.add(test::floorAt(1, 1, glass));
  const Scene scene = builder.build();

  const Crossing plain = crossMedia(scene, EffectSet::all(), opaque, true, 0x1);
  EXPECT_FALSE(plain.dielectric || plain.hidden);

  const Crossing in = crossMedia(scene, EffectSet::all(), glass, true, 0);
  EXPECT_TRUE(in.dielectric && !in.hidden);
  EXPECT_EQ(in.n1, 1);
  EXPECT_EQ(in.n2, 1.5);

  const Crossing out = crossMedia(scene, EffectSet::all(), glass, false, in.stackBehind);
  EXPECT_EQ(out.n1, 1.5);
  EXPECT_EQ(out.n2, 1);
  EXPECT_EQ(out.stackBehind, 0u);

  EXPECT_TRUE(crossMedia(scene, EffectSet::all(), glass, false, 0).hidden)
      << "leaving what was never entered";
  EXPECT_FALSE(
      crossMedia(scene, EffectSet::all().without(Effect::transmission), glass, true, 0).dielectric);
}

TEST(Absorption, FollowsBeer) {
  Scene scene = sceneWithPriorities({0});
  const float infinite = std::numeric_limits<float>::infinity();
  scene.media[1].absorption = {0.5f, 0, infinite};

  const RgbD near = transmittance(scene, 1, 2);
  EXPECT_DOUBLE_EQ(near.x, std::exp(-1.0));
  EXPECT_EQ(near.y, 1);
  EXPECT_EQ(near.z, 0);
  EXPECT_EQ(transmittance(scene, 1, 0), RgbD(1.0))
      << "no distance, no absorption, even if infinite";
  EXPECT_EQ(transmittance(scene, 1, std::numeric_limits<double>::infinity()), RgbD(0, 1, 0));
  EXPECT_EQ(transmittance(scene, 0, 1e30), RgbD(1.0)) << "vacuum";
  EXPECT_EQ(transmittance(scene, 1, 2e4).x, 0) << "exp(-1e4) is nothing";
}

}  // namespace
}  // namespace whit::reference
