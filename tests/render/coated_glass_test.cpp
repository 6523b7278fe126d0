// Mirror coats on dielectrics: the vector pipeline against the reference.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// The blocks of glass have coats and tints of all kinds; some have ior 1 and one has no coat.
Scene blocks() {
  SceneBuilder builder;
  builder.sky(1);
  return rowOfTiles(builder, [&](int i) {
    Material m = glassMaterial(i % 2 ? 1.5f : 1.0f);
    m.transmission = i % 3 ? Rgb{0.9f, 0.5f, 0.25f} : Rgb(1.0f);
    if (i > 0) m.mirror = Rgb{0.6f, 0.2f, 0.05f} * (0.2f * static_cast<float>(i));
    if (i > 0) m.mirrorGrazing = i == 4 ? m.mirror : Rgb(1.0f);
    return box({0, 0, -1}, {1, 0.25f, 0}, builder.add(m));
  });
}

TEST(CoatedGlass, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  expectStagesAgreeOnEveryTarget(blocks(), smallOptions());
}

// No pixel is brighter than the sky, which is 1: nothing emits, and nothing scatters the lamp's
// light. Beside the blocks all pixels show it, and the blocks show some of it.
TEST(CoatedGlass, IsNoBrighterThanTheRoom) {
  constexpr float kRoundingsOfAPath = 1e-5f;
  int pixels = 0, asTheSky = 0;
  for (const Rgb& pixel : render(blocks(), smallOptions()).image.pixels) {
    ASSERT_LE(maxComponent(pixel), 1 + kRoundingsOfAPath);
    ASSERT_GT(maxComponent(pixel), 0.05f);
    asTheSky += pixel == Rgb(1.0f);
    ++pixels;
  }
  EXPECT_GT(asTheSky, pixels / 10);
  EXPECT_LT(asTheSky, pixels);
}

TEST(CoatedGlass, HasTheSameBitsWhateverTheQueues) {
  expectBitsWhateverTheQueues(blocks(), smallOptions());
}

// Without the effect there is no coat that would reflect light.
TEST(CoatedGlass, LetsAllLightThroughWithoutMirrors) {
  RenderOptions o = smallOptions();
  o.disable = EffectSet().with(Effect::mirror);
  expectThePictureOfTheReference(blocks(), o, "without mirrors");
}

}  // namespace
}  // namespace whit::test
