// --adaptive: one sample a pixel, and all samples where neighbors differ.
#include <gtest/gtest.h>

#include "core/display.h"
#include "render/pipeline_laws.h"
#include "sampling/sample_pattern.h"

namespace whit::test {
namespace {

RenderOptions withSamples(int spp, bool adaptive) {
  RenderOptions o = smallOptions();
  o.spp = spp;
  o.adaptive = adaptive;
  return o;
}

bool sameBits(const Rgb& a, const Rgb& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

using Adaptive = SceneTest;

// With no more samples than probes, each pixel has the bits of a picture of one sample or of all.
TEST_P(Adaptive, PixelsAreThoseOfOneSampleOrOfAll) {
  const Picture one = render(scene_, withSamples(1, false));
  const Picture all = render(scene_, withSamples(kProbeSamples, false));
  const Picture adaptive = render(scene_, withSamples(kProbeSamples, true));

  const std::size_t pixels = one.image.pixels.size();
  std::size_t changed = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const Rgb got = adaptive.image.pixels[i];
    const bool keptOne = sameBits(got, one.image.pixels[i]);
    EXPECT_TRUE(keptOne || sameBits(got, all.image.pixels[i])) << i;
    changed += !keptOne;
  }

  // Every pixel has a ray of the first pass; refined pixels have those of the probes besides.
  const std::uint64_t rays = adaptive.stats.of(RayKind::primary).rays;
  const std::uint64_t refined = (rays - pixels) / kProbeSamples;
  EXPECT_EQ(rays, pixels + kProbeSamples * refined);
  EXPECT_GE(refined, changed);
  EXPECT_GT(changed, 0u);
  EXPECT_LT(refined, pixels);
}

// With more samples than probes, the pixels that get all have the bits of uniform sampling: at
// least those whose probe samples differ, and they alone cost more than the probes.
TEST_P(Adaptive, ContrastingPixelsGetEverySample) {
  constexpr int kSamples = 11;
  const Picture all = render(scene_, withSamples(kSamples, false));
  const Picture probes = render(scene_, withSamples(kProbeSamples, true));
  const Picture adaptive = render(scene_, withSamples(kSamples, true));

  // The samples beyond the probes tell how many pixels get all of them.
  const std::uint64_t extra =
      adaptive.stats.of(RayKind::primary).rays - probes.stats.of(RayKind::primary).rays;
  const std::uint64_t contrasting = extra / (kSamples - kProbeSamples);
  EXPECT_EQ(extra, contrasting * (kSamples - kProbeSamples));

  std::uint64_t whole = 0;
  for (std::size_t i = 0; i < all.image.pixels.size(); ++i) {
    whole += sameBits(adaptive.image.pixels[i], all.image.pixels[i]);
  }

  EXPECT_GT(contrasting, 0u);
  EXPECT_GE(whole, contrasting);
  EXPECT_LT(contrasting, all.image.pixels.size());
}

TEST_P(Adaptive, H60_anyTilesThreadsQueuesAndPacketsGiveTheSameBits) {
  expectBitsWhateverTheQueues(scene_, withSamples(9, true));
}

// A crop reads one pixel beyond its border.
TEST_P(Adaptive, H59_croppedPixelsHaveTheBitsOfTheWholeImage) {
  RenderOptions o = withSamples(9, true);
  o.size = kSmallSize;
  expectBitsOfTheWhole(scene_, o, {31, 20, 62, 45});
}

TEST_P(Adaptive, AgreesWithTheReference) {
  const RenderOptions o = withSamples(9, true);
  const BothModes both = renderBoth(scene_, o);
  // The bound is twice that of pictures without decisions between neighbors, because pixels within
  // rounding of the threshold may be refined by one of the two alone.
  EXPECT_LE(differenceOf(both).pixelsGe2CodesPct, 0.2);

  const auto primary = static_cast<double>(both.reference.stats.of(RayKind::primary).rays);
  EXPECT_NEAR(static_cast<double>(both.packets.stats.of(RayKind::primary).rays), primary,
              2e-3 * primary);
}

INSTANTIATE_TEST_SUITE_P(Shipped, Adaptive, testing::Values("whitted", "glass", "matte"));

// The display codes are those of the picture, for kept pixels and for refined ones.
TEST(AdaptiveDisplay, EncodesEveryPixel) {
  const Picture film = render(load("whitted"), withSamples(9, true));
  EXPECT_EQ(film.display.rgba, toDisplay(film.image, 0, ToneCurve::none).rgba);
}

// Pixels whose first samples agree because none of them hits the light must not end there. Where
// light is sampled, all pixels get all samples, in packets and in the reference.
TEST(AdaptiveError, SampledLightIsNotEndedEarly) {
  struct Case {
    const char* scene;
    int RenderOptions::*samples;
    int number;
  };
  for (const Case& c : {Case{"glossy", &RenderOptions::glossy, 1},
                        {"cornell", &RenderOptions::indirect, 1},
                        {"cornell", &RenderOptions::ambientSamples, 1},
                        {"matte", &RenderOptions::lightSamples, 2}}) {
    const Scene scene = load(c.scene);
    RenderOptions all = withSamples(kProbeSamples + 2, false);
    all.size = ImageSize{24, 18};
    all.*c.samples = c.number;

    RenderOptions adaptive = all;
    adaptive.adaptive = true;
    for (const bool packets : {true, false}) {
      EXPECT_EQ(firstDifference(render(scene, adaptive, packets), render(scene, all, packets)), "")
          << c.scene;
    }
  }
}

// Adaptive sampling reaches most of what 9 samples everywhere reach, for a third of the rays: the
// error is far below that of as many rays spread evenly.
TEST(AdaptiveError, ComesNearThatOfAllSamplesForAThirdOfTheRays) {
  const Scene scene = load("matte");
  const auto picture = [&](int spp, bool adaptive) {
    RenderOptions o = withSamples(spp, adaptive);
    o.size = ImageSize{320, 200};
    return render(scene, o);
  };
  const Image wanted = picture(64, false).image;
  const auto errorOf = [&](const Picture& p) { return compareImages(p.image, wanted).rmse; };

  const Picture all = picture(9, false), adaptive = picture(9, true);
  const double errorThree = errorOf(picture(3, false)), errorAll = errorOf(all);
  const double error = errorOf(adaptive);
  const double rays =
      static_cast<double>(adaptive.stats.allRays()) / static_cast<double>(all.stats.allRays());

  EXPECT_LE(error, 1.6 * errorAll);
  EXPECT_LE(error, errorThree / 1.4);
  EXPECT_LE(rays, 1.0 / 3);
}

}  // namespace
}  // namespace whit::test
