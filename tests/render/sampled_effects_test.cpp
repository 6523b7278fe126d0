// Effects that are sampled by rays: kernels against the reference, what the picture's bits must not
// depend on, and what the effects cost where they are not sampled.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

// An effect, the option that samples it, and how its pictures are rendered besides.
struct Sampled {
  const char* name;
  Effect effect;
  int RenderOptions::*samples;
  RayKind rays;
  const char* step;   // of the plan, if the effect has one of its own
  const char* scene;  // beside `effects`, which has all effects
  std::function<void(RenderOptions&)> set = [](RenderOptions&) {};
};

const std::vector<Sampled>& everySampledEffect() {
  const auto occlusion = &RenderOptions::ambientSamples;
  static const std::vector<Sampled> all{
      {"occlusion", Effect::ambientOcclusion, occlusion, RayKind::occlusion,
       "findAmbientAndOcclusionRays", "cornell"},
      {"occlusionAtTerminators", Effect::ambientOcclusion, occlusion, RayKind::occlusion,
       "findAmbientAndOcclusionRays", "cornell",
       [](RenderOptions& o) { o.shading.terminator = true; }},

      // A lobe that is not sampled shows the blurred sky.
      {"glossy", Effect::glossyReflection, &RenderOptions::glossy, RayKind::reflection,
       "addGlossyReflections", "glossy",
       [](RenderOptions& o) { o.disable = {Effect::blurredSky}; }},

      {"indirect", Effect::indirect, &RenderOptions::indirect, RayKind::indirect, "addIndirect",
       "cornell", [](RenderOptions& o) { o.depth = std::min(o.depth, 5); }},
      {"indirectByRoulette", Effect::indirect, &RenderOptions::indirect, RayKind::indirect,
       "addIndirect", "cornell",
       [](RenderOptions& o) {
         o.depth = std::min(o.depth, 5);
         o.roulette = 0.5f;
         o.glossy = 2;
       }},

      {"softShadows", Effect::softShadows, &RenderOptions::lightSamples, RayKind::shadow, "",
       "whitted"},
      {"softShadowsInLobes", Effect::softShadows, &RenderOptions::lightSamples, RayKind::shadow, "",
       "whitted", [](RenderOptions& o) { o.glossy = 2; }},
  };
  return all;
}

// A shipped scene whose lights have a radius.
Scene withWideLights(const std::string& name) {
  SceneDescription d = described(name);
  for (Light& light : d.lights) light.radius = 0.4f;
  return repaired(std::move(d));
}

// The scenes have walls, rough spheres, a mirror and glass; textures, masks, coverage and
// instances; lights of all kinds.
class SampledEffect : public testing::TestWithParam<std::tuple<std::size_t, bool>> {
 protected:
  const Sampled& effect_ = everySampledEffect()[std::get<0>(GetParam())];
  const Scene scene_ = withWideLights(std::get<1>(GetParam()) ? "effects" : effect_.scene);

  RenderOptions options(int samples = 3) const {
    RenderOptions o = smallOptions();
    o.*effect_.samples = samples;
    effect_.set(o);
    return o;
  }
  RenderOptions without() const { return options(RenderOptions().*effect_.samples); }
};

TEST_P(SampledEffect, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  RenderOptions o = options();
  o.spp = 2;
  o.depth = 3;
  expectStagesAgreeOnEveryTarget(scene_, o);
}

TEST_P(SampledEffect, PictureAgreesWithTheReference) {
  RenderOptions o = options();
  o.spp = 2;
  const BothModes both = renderBoth(scene_, o);
  expectSampledPictureAgrees(both);

  // One ray in a thousand passes an edge on the other side.
  const auto rays = static_cast<double>(both.reference.stats.of(effect_.rays).rays);
  EXPECT_NEAR(static_cast<double>(both.packets.stats.of(effect_.rays).rays), rays, 1e-3 * rays);
}

TEST_P(SampledEffect, BitsDependOnTheSceneAlone) { expectBitsWhateverTheQueues(scene_, options()); }

TEST_P(SampledEffect, ACropShowsTheSameNoise) {
  RenderOptions o = options();
  o.size = kSmallSize;
  expectBitsOfTheWhole(scene_, o, {40, 30, 60, 41});
}

TEST_P(SampledEffect, CostsNothingWhereItIsNotSampled) {
  const Picture plain = render(scene_, without()), sampled = render(scene_, options());
  EXPECT_EQ(Renderer(scene_, without()).plan().find(effect_.step), nullptr);
  EXPECT_NE(firstDifference(sampled, plain), "");
  EXPECT_GT(sampled.stats.of(effect_.rays).rays, plain.stats.of(effect_.rays).rays);

  RenderOptions o = options();
  o.disable = o.disable.with(effect_.effect);
  const Picture disabled = render(scene_, o);
  EXPECT_EQ(Renderer(scene_, o).plan().find(effect_.step), nullptr);
  EXPECT_EQ(firstDifference(disabled, plain), "");
  EXPECT_EQ(disabled.stats.allRays(), plain.stats.allRays());
}

INSTANTIATE_TEST_SUITE_P(
    Shipped, SampledEffect,
    testing::Combine(testing::Range(std::size_t{0}, everySampledEffect().size()), testing::Bool()),
    [](const auto& info) {
      const char* const place = std::get<1>(info.param) ? "AmongAll" : "Alone";
      return std::string(everySampledEffect()[std::get<0>(info.param)].name) + place;
    });

// Surfaces that sample indirect light get no ambient light, so there is no occlusion to sample.
TEST(AmbientOcclusion, GoesWithAmbientLight) {
  for (const char* name : {"cornell", "effects"}) {
    const Scene scene = load(name);
    RenderOptions o = smallOptions();
    o.ambientSamples = 3;
    o.depth = 0;
    const std::uint64_t alone = render(scene, o).stats.of(RayKind::occlusion).rays;

    o.indirect = 1;
    const std::uint64_t left = render(scene, o).stats.of(RayKind::occlusion).rays;
    EXPECT_LT(left, alone / 4);

    // The leaf of the other scene samples no indirect light (diffuseReflection), so it keeps
    // ambient light.
    EXPECT_EQ(left == 0, name == std::string("cornell"));
  }
}

// Roulette draws its chances from the numbers of paths, also where no lobe is sampled.
TEST(Roulette, NeedsTheNumbersOfPaths) {
  RenderOptions o = smallOptions();
  for (const float roulette : {0.0f, 0.5f}) {
    o.roulette = roulette;
    EXPECT_EQ(Renderer(load("cornell"), o).plan().features.has(Feature::streams), roulette > 0);
  }
}

// More samples come nearer to the picture of very many samples. Random points fall as the root of
// their number, and points of a lattice do no worse.
TEST(Noise, FallsAsTheRootOfTheNumberOfSamples) {
  for (const Sampled& effect : everySampledEffect()) {
    if (effect.rays == RayKind::shadow) continue;  // edges differ more than their noise
    const Scene scene = withWideLights(effect.scene);
    const auto picture = [&](int samples) {
      RenderOptions o;
      o.size = ImageSize{48, 32};
      o.spp = 4;
      effect.set(o);
      // The highlights of lights are rare and bright, and would dominate the error.
      if (effect.effect == Effect::glossyReflection) o.disable = o.disable.with(Effect::lights);
      o.*effect.samples = samples;
      return render(scene, o).image;
    };

    const Image settled = picture(64);
    double previous = 1e9;
    for (const int samples : {1, 4, 16}) {
      const double error = compareImages(picture(samples), settled).rmse;
      // If the error fell as the power of -0.45, that of 4 and 16 samples and of the settled
      // picture would have this ratio.
      EXPECT_LT(error, 0.585 * previous) << effect.name << " " << samples;
      previous = error;
    }
  }
}

}  // namespace
}  // namespace whit::test
