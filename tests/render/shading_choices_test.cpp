// The options that change a formula: the promise of each, and that kernels and the reference obey
// the same rule.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "pi.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

struct Choice {
  std::string name;
  std::function<void(RenderOptions&)> make;
};

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all{
      {"lightCutoff", [](RenderOptions& o) { o.shading.lightCutoff = 0.02f; }},
      {"schlick", [](RenderOptions& o) { o.shading.fresnel = FresnelModel::schlick; }},
      {"fixedOffset", [](RenderOptions& o) { o.shading.offset = OffsetMethod::fixed; }},
      {"wachterBinder", [](RenderOptions& o) { o.shading.offset = OffsetMethod::wachterBinder; }},
      {"terminator", [](RenderOptions& o) { o.shading.terminator = true; }},
      {"unbent", [](RenderOptions& o) { o.shading.bend = false; }},
      {"nearestTexel", [](RenderOptions& o) { o.shading.textureFilter = TextureFilter::nearest; }},
      {"trilinear", [](RenderOptions& o) { o.shading.textureFilter = TextureFilter::trilinear; }},
  };
  return all;
}

using ShadingChoice = SceneTest;

TEST_P(ShadingChoice, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  for (const Choice& choice : choices()) {
    SCOPED_TRACE(choice.name);
    RenderOptions o = smallOptions({61, 37});  // small, since every choice is rendered
    choice.make(o);

    expectStagesAgreeOnEveryTarget(scene_, o, [&](const StageDifference& row) {
      // On the border between two texels either may be the nearest.
      const bool mapped =
          row.column == "diffuse" || row.column == "specular" || row.column == "shadingNormal";
      if (mapped && choice.name == "nearestTexel") return true;

      // Offsets and cutoffs do not affect the weights; but the rays that they move may come
      // nearer to the critical angle, where Fresnel's root amplifies rounding without bound.
      return row.column == "weight" && choice.name != "schlick";
    });
  }
}

// Pictures agree as those of the defaults do, and the rays are the same but for those whose
// decision lies within rounding.
TEST_P(ShadingChoice, PicturesAgreeWithTheReference) {
  for (const Choice& choice : choices()) {
    RenderOptions o = smallOptions();
    choice.make(o);
    const BothModes both = renderBoth(scene_, o);
    // An offset of 1e-3 moves the start of some rays to the other side of thin parts of a scene;
    // which ones depends on the last bit of the direction.
    EXPECT_LE(differenceOf(both).pixelsGe2CodesPct, choice.name == "fixedOffset" ? 0.5 : 0.1)
        << choice.name;

    for (const auto kind : indices(kRayKindCount)) {
      const auto rays = static_cast<double>(both.reference.stats.meter.tally[kind].rays);
      EXPECT_NEAR(static_cast<double>(both.packets.stats.meter.tally[kind].rays), rays,
                  1e-3 * rays + 1)
          << choice.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, ShadingChoice,
                         testing::Values("whitted", "glass", "mirrors", "matte",
                                         "landscape?triangles=2000"));

// A floor has many lights of unlike strength, the shadow of a small roof on one half, and a mirror
// on the other half.
Scene manyLights(int lights) {
  SceneBuilder builder;
  Material floor = diffuseMaterial(0.5f);
  floor.mirror = floor.mirrorGrazing = Rgb(0.25f);
  builder.add(floorAt(0, 8), floor);
  builder.add(box({-2, 1, -2}, {0, 1.25f, 2}), diffuseMaterial(0.7f));

  Numbers numbers(64);
  for (int i = 0; i < lights; ++i) {
    const Vec3d p(numbers.in(-5, 5), numbers.in(1.5, 4), numbers.in(-5, 5));
    builder.description.lights.push_back(
        lightAt(Vec3f(p), static_cast<float>(std::exp(numbers.in(-6, 1)))));
  }

  builder.lookFrom({0, 6, 6});
  return builder.build();
}

// H64: the light that is left out is at most the cutoff, for each light and surfel.
TEST(LightCutoff, H64_boundsTheErrorAndSavesShadowRays) {
  constexpr int kLights = 40, kSurfelsAPixel = 2;  // a mirror shows no second mirror here
  const Scene scene = manyLights(kLights);
  RenderOptions o = smallOptions();
  const Picture wanted = render(scene, o);
  for (const float cutoff : {1e-4f, 1e-3f, 1e-2f}) {
    SCOPED_TRACE(cutoff);
    o.shading.lightCutoff = cutoff;
    const Picture got = render(scene, o);

    float worst = 0;
    for (const auto i : indices(got.image.pixels)) {
      const Rgb lost = wanted.image.pixels[i] - got.image.pixels[i];
      worst = std::max(worst, maxComponent(lost));
      // There is never more light than without the cutoff, but for the order of rounding.
      EXPECT_GE(std::min({lost.x, lost.y, lost.z}), -1e-6f);
    }

    EXPECT_LE(worst, cutoff * kLights * kSurfelsAPixel);
    EXPECT_GT(worst, 0);
    EXPECT_LT(got.stats.of(RayKind::shadow).rays, wanted.stats.of(RayKind::shadow).rays);
  }
}

// The light straight below is I kd / pi / d^2 = 1 / pi. With a cutoff just below that the light
// counts, with one just above it does not, and behind a mirror of reflectance 1/4 the same holds
// for a quarter.
TEST(LightCutoff, DecidesByTheContributionToThePixel) {
  SceneBuilder builder = withFloor(diffuseMaterial(0.5f), 8);
  builder.add(ceilingAt(4, 8), mirrorMaterial(0.25f));
  builder.description.lights.push_back(lightAt({0, 2, 0}, 8));
  const Scene scene = builder.build();

  const auto seen = [&](double y, bool lookUp, double cutoff) {
    reference::Settings settings = uncut();
    settings.options.shading.lightCutoff = static_cast<float>(cutoff);
    reference::RayCounts counts;
    const RgbD light =
        radianceAlong(scene, {0, y, 0}, {0, lookUp ? 1.0 : -1.0, 0}, settings, &counts);
    EXPECT_EQ(counts[RayKind::shadow], light.x > 0 ? 1u : 0u);
    return light.x;
  };

  const double direct = 1 / kPi;
  EXPECT_NEAR(seen(1, false, direct * 0.999), direct, 1e-6);
  EXPECT_EQ(seen(1, false, direct * 1.001), 0);
  EXPECT_NEAR(seen(1, true, direct / 4 * 0.999), direct / 4, 1e-6);
  EXPECT_EQ(seen(1, true, direct / 4 * 1.001), 0);
}

// All of Embree's builders give the same hits, because the triangles are the same.
TEST(BvhQuality, ChangesNoHit) {
  for (const char* name : {"whitted", "glass"}) {
    const Scene scene = load(name);
    const Image wanted = render(scene, smallOptions()).image;
    for (const BvhQuality quality : {BvhQuality::low, BvhQuality::high}) {
      RenderOptions o = smallOptions();
      o.bvh = quality;
      const ImageDifference d = compareImages(render(scene, o).image, wanted);

      // Rays through an edge may hit either of its triangles first.
      EXPECT_LE(d.pixelsGe2CodesPct, 0.1) << name;
    }
  }
}

}  // namespace
}  // namespace whit::test
