// A scene without an effect, and the same scene with it: an absent effect costs nothing.
#include <gtest/gtest.h>

#include "make/leave_out.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

Scene loadWithout(EffectSet effects) {
  static const SceneDescription kAll = described("effects");
  SceneDescription description = kAll;
  description.fog = {Rgb(0.05f), Rgb(0.5f)};
  leaveOut(description, effects);
  return repaired(std::move(description));
}

// Adds the effects that cannot exist without `effect`.
EffectSet withDependents(Effect effect) {
  switch (effect) {
    case Effect::lights:
      return {effect, Effect::shadows, Effect::softShadows, Effect::spotLights,
              Effect::directionalLights};
    case Effect::shadows:
      return {effect, Effect::softShadows};
    case Effect::textures:
    case Effect::emission:
      return {effect, Effect::emissionMaps};
    case Effect::sky:
      return {effect, Effect::skyImage, Effect::blurredSky};
    case Effect::transmission:
      return {effect, Effect::absorption, Effect::coverage};
    case Effect::glossy:
      return {effect, Effect::glossyReflection, Effect::blurredSky};
    case Effect::glossyReflection:
      return {effect, Effect::blurredSky};
    case Effect::ambient:
      return {effect, Effect::ambientOcclusion};
    default:
      return {effect};
  }
}

// The options sample every effect that a scene may have.
RenderOptions glossyOptions() {
  RenderOptions o = smallOptions();
  o.glossy = 2;
  o.lightSamples = 2;
  o.indirect = 2;
  o.ambientSamples = 2;
  return o;
}

class AbsentEffect : public testing::TestWithParam<int> {
 protected:
  const Effect effect_ = static_cast<Effect>(GetParam());
  const EffectSet absent_ = withDependents(effect_);
};

TEST_P(AbsentEffect, IsWhatTheSceneNoLongerCallsFor) {
  EXPECT_EQ(loadWithout(absent_).effects, EffectSet::all().without(absent_));
}

// Fog hides the sky, and samples of lobes stand in place of the blurred sky.
TEST_P(AbsentEffect, LeavesAnotherPicture) {
  const Scene scene = loadWithout(effect_ == Effect::fog ? EffectSet() : EffectSet{Effect::fog});
  RenderOptions o = effect_ == Effect::blurredSky ? smallOptions() : glossyOptions();
  if (effect_ == Effect::depthOfField) {
    o.camera = "lens";
    o.spp = 2;
  }
  const Picture with = render(scene, o);
  o.disable = {effect_};
  EXPECT_NE(firstDifference(render(scene, o), with), "");
}

TEST_P(AbsentEffect, CompiledInAllTheSameGivesTheSameBits) {
  const Scene scene = loadWithout(absent_);
  RenderOptions o = glossyOptions();
  const Picture plain = render(scene, o);
  o.effects = EffectChoice::all;
  EXPECT_EQ(firstDifference(render(scene, o), plain), "");

  o.disable = absent_.without(effect_);
  EXPECT_EQ(firstDifference(render(scene, o), plain), "") << "this one alone";
}

TEST_P(AbsentEffect, OnTopOfTheMatteSceneGivesTheSameBits) {
  const EffectSet matte = kMatteEffects.without(absent_);
  const Scene scene = loadWithout(EffectSet::all().without(matte));
  ASSERT_EQ(scene.effects, matte);

  RenderOptions o = glossyOptions();
  const Picture plain = render(scene, o);
  o.effects = EffectChoice::all;
  o.disable = EffectSet::all().without(matte.with(effect_));
  EXPECT_EQ(firstDifference(render(scene, o), plain), "");
}

TEST_P(AbsentEffect, LeftOutIsGoneAsInTheReference) {
  RenderOptions o = smallOptions();
  o.disable = {effect_};
  EXPECT_LE(differenceFromReference(loadWithout({}), o).pixelsGe2CodesPct, 0.1);
}

// Rays, kernel calls and memory of a frame.
struct Cost {
  FrameStats stats;
  BufferBytes buffers;
  FeatureSet features;
  std::size_t texels = 0, instances = 0, lights = 0;
  bool skyImage = false;

  // The bytes of columns with these features for as many slots as a queue has.
  template <typename Columns>
  std::size_t bytesOf() const {
    const int tile = RenderOptions().tile;
    return ColumnStore<Columns>(2 * cellsOf(tile, tile), features).bytes();
  }
};

Cost costWithout(EffectSet effects) {
  const Scene scene = loadWithout(effects);
  RenderOptions o = glossyOptions();
  o.threads = 1;
  o.depth = 1;
  Renderer renderer(scene, o);

  Cost cost;
  cost.stats = render(renderer).stats;
  cost.buffers = renderer.scheduler().tracers().at(0)->bufferBytes();
  cost.features = renderer.plan().features;
  // A texture of one texel stands for one that is left out.
  for (const TextureRecord& t : renderer.tables().textures) {
    cost.texels += cellsOf(t.width, t.height) - 1;
  }

  cost.instances = renderer.tables().instances.size();
  cost.lights = renderer.tables().lights.size();
  cost.skyImage = renderer.tables().sky.r != nullptr;
  return cost;
}

// Names the rays, stages, kernels and buffers, in this order, that a frame no longer has.
std::string goneWith(const Cost& all, const Cost& cost) {
  std::string gone;
  const auto compare = [&](std::string_view name, std::uint64_t before, std::uint64_t now) {
    if (before > 0 && now == 0) gone += std::string(name) + " ";
  };

  for (const RayKindRow& row : kRayKinds) {
    compare(row.name, all.stats.of(row.kind).rays, cost.stats.of(row.kind).rays);
  }
  gone += "| ";
  for (const std::size_t i : indices(kStageCount)) {
    compare(kStageNames[i], all.stats.stageCalls[i], cost.stats.stageCalls[i]);
  }
  gone += "| ";
  for (const simd::Kernel& kernel : simd::kKernels) {
    compare(kernel.name, all.stats.callsOf(kernel), cost.stats.callsOf(kernel));
  }
  gone += "| ";
  compare("unshadowed", all.buffers.unshadowed, cost.buffers.unshadowed);
  compare("shadows", all.buffers.shadows, cost.buffers.shadows);
  return gone;
}

TEST(AbsentEffects, WithAllOfThemEveryRayStageAndBufferIsThere) {
  const Cost cost = costWithout({});
  for (const RayTally& tally : cost.stats.meter.tally) EXPECT_GT(tally.rays, 0u);
  for (const std::uint64_t calls : cost.stats.stageCalls) EXPECT_GT(calls, 0u);

  EXPECT_EQ(cost.buffers.unshadowed, cost.bytesOf<UnshadowedColumns>());
  EXPECT_EQ(cost.buffers.shadows, cost.bytesOf<ShadowColumns>());
  // Options ask for these, and no effect does.
  for (const Feature feature : {Feature::ended, Feature::alpha, Feature::shadowOffset}) {
    EXPECT_FALSE(cost.features.has(feature));
  }
  EXPECT_GT(cost.texels, 1000u);
  EXPECT_GT(cost.instances, 1u);
  EXPECT_TRUE(cost.skyImage);
}

struct Absence {
  EffectSet effects;
  std::string gone;     // rays, stages, kernels and buffers
  FeatureSet features;  // whose columns are gone
};

// Each absence takes away what is listed and nothing else.
TEST(AbsentEffects, TakeTheirRaysKernelsAndColumnsAlong) {
  const Cost all = costWithout({});
  for (const Absence& absence : {
           Absence{{Effect::lights, Effect::ambientOcclusion},
                   "shadow occlusion | findRadianceAndShadowRays checkShadows addShading | "
                   "findRadianceAndShadowRays findAmbientAndOcclusionRays packShadowRays "
                   "addShading | unshadowed shadows ",
                   {Feature::spotLights, Feature::shadows}},
           {{Effect::shadows, Effect::ambientOcclusion},
            "shadow occlusion | checkShadows | findAmbientAndOcclusionRays packShadowRays | "
            "shadows ",
            {Feature::shadows}},
           {{Effect::mirror, Effect::glossyReflection},
            "reflection | | addReflections addGlossyReflections | ",
            {}},
           {{Effect::glossyReflection}, "| | addGlossyReflections | ", {}},
           {{Effect::glossy}, "| | addGlossyReflections | ", {Feature::glossy, Feature::lobes}},
           {{Effect::indirect}, "indirect | | addIndirect | ", {}},
           {{Effect::ambientOcclusion}, "occlusion | | findAmbientAndOcclusionRays | ", {}},
           {{Effect::transmission},
            "refraction | | lookUpCoverage lookUpTransmission addRefractions | ",
            {Feature::transmissionMaps, Feature::coverage, Feature::transmission,
             Feature::absorption}},
           {{Effect::coverage}, "| | lookUpCoverage | ", {Feature::coverage}},
           {{Effect::instances}, "| | | ", {Feature::instances}},
           // Fog returns each ray to its eye in the stage of impulses.
           {{Effect::fog, Effect::transmission, Effect::mirror, Effect::glossyReflection,
             Effect::indirect},
            "reflection refraction indirect | addImpulses | lookUpCoverage "
            "lookUpTransmission addFog addReflections addGlossyReflections addRefractions "
            "addIndirect returnImpulses returnToEye | ",
            {Feature::transmissionMaps, Feature::coverage, Feature::transmission,
             Feature::absorption, Feature::fog}},
       }) {
    SCOPED_TRACE(absence.gone);
    const Cost cost = costWithout(absence.effects);

    EXPECT_EQ(goneWith(all, cost), absence.gone);
    EXPECT_TRUE(all.features.without(cost.features) == absence.features);
    EXPECT_EQ(cost.buffers.hits, cost.bytesOf<HitColumns>());
    EXPECT_EQ(cost.buffers.surfels, cost.bytesOf<SurfelColumns>());
  }
}

TEST(AbsentEffects, WithoutGlossyReflectionNoSamplesAndNoPaths) {
  const Cost all = costWithout({}), cost = costWithout({Effect::glossyReflection});
  EXPECT_LT(cost.stats.of(RayKind::reflection).rays, all.stats.of(RayKind::reflection).rays);
  EXPECT_LT(cost.buffers.rays, all.buffers.rays);
}

TEST(AbsentEffects, WithoutImpulsesNothingBelowTheFirstDepth) {
  const Cost cost = costWithout({Effect::fog, Effect::transmission, Effect::mirror,
                                 Effect::glossyReflection, Effect::indirect});
  EXPECT_EQ(cost.buffers.rays, cost.bytesOf<RayColumns>());
  EXPECT_EQ(cost.buffers.radiance, cost.bytesOf<RadianceColumns>());
}

// The lobes of whitted are the highlights of its mirrors and glass, and take nothing from others.
TEST(AbsentEffects, WithoutLobesThatCoverNoColumnsOfTheirShare) {
  const FeatureSet features = makePlan(load("whitted"), smallOptions()).features;
  EXPECT_TRUE(features.has(Feature::glossy));
  EXPECT_FALSE(features.has(Feature::lobes));
}

TEST(AbsentEffects, TakeTheirTablesAlong) {
  EXPECT_EQ(costWithout({Effect::lights}).lights, 0u);
  EXPECT_FALSE(costWithout({Effect::skyImage}).skyImage);
  EXPECT_FALSE(loadWithout({}).normals.empty());
  EXPECT_TRUE(loadWithout({Effect::smoothNormals}).normals.empty());
  // Masked lanes need one transform to read.
  EXPECT_EQ(costWithout({Effect::instances}).instances, 1u);
}

TEST(AbsentEffects, WithoutTexturesNoTexels) {
  EXPECT_EQ(costWithout({Effect::textures, Effect::normalMaps}).texels, 0u);
  const std::size_t all = costWithout({}).texels;
  for (const Effect effect : {Effect::textures, Effect::normalMaps}) {
    const std::size_t one = costWithout({effect}).texels;
    EXPECT_GT(one, 0u) << nameOf(effect);
    EXPECT_LT(one, all) << nameOf(effect);
  }
}

INSTANTIATE_TEST_SUITE_P(All, AbsentEffect, testing::Range(0, kEffectCount), [](const auto& info) {
  return std::string(nameOf(static_cast<Effect>(info.param)));
});

}  // namespace
}  // namespace whit::test
