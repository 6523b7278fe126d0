// Stacks of media, crossings of surfaces, and absorption (hard cases H45, H50).
#include "reference/media.h"

#include <gtest/gtest.h>

#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

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

TEST(Crossing, OfSurfacesThatBoundNoMedium) {
  SceneBuilder builder = withFloor(diffuseMaterial(0.5f));
  const auto glass = builder.add(glassMaterial(1.5f));
  builder.add(floorAt(1, 1, glass));
  const Scene scene = builder.build();

  const Crossing plain = crossMedia(scene, EffectSet::all(), 0, true, 0x1);
  EXPECT_FALSE(plain.dielectric || plain.hidden);

  const Crossing in = crossMedia(scene, EffectSet::all(), glass, true, 0);
  EXPECT_TRUE(in.dielectric && !in.hidden);
  EXPECT_EQ(std::pair(in.n1, in.n2), std::pair(1.0, 1.5));

  const Crossing out = crossMedia(scene, EffectSet::all(), glass, false, in.stackBehind);
  EXPECT_EQ(std::pair(out.n1, out.n2), std::pair(1.5, 1.0));
  EXPECT_EQ(out.stackBehind, 0u);

  EXPECT_TRUE(crossMedia(scene, EffectSet::all(), glass, false, 0).hidden)
      << "leaving what was never entered";
  EXPECT_FALSE(crossMedia(scene, allBut(Effect::transmission), glass, true, 0).dielectric);
}

TEST(Absorption, FollowsBeer) {
  Scene scene = sceneWithPriorities({0});
  scene.media[1].absorption = {0.5f, 0, static_cast<float>(kInfinity)};
  EXPECT_EQ(transmittance(scene, 1, 2), RgbD(std::exp(-1.0), 1, 0));
  EXPECT_EQ(transmittance(scene, 1, 0), RgbD(1.0))
      << "no distance, no absorption, even if infinite";
  EXPECT_EQ(transmittance(scene, 1, kInfinity), RgbD(0, 1, 0));
  EXPECT_EQ(transmittance(scene, 0, 1e30), RgbD(1.0)) << "vacuum";
  EXPECT_EQ(transmittance(scene, 1, 2e4).x, 0) << "exp(-1e4) is nothing";
}

}  // namespace
}  // namespace whit::reference
