// A scene without an effect, and the same scene with it: an absent effect costs nothing.
#include <gtest/gtest.h>

#include "make/leave_out.h"
#include "render/shipped_scene.h"

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
  const EffectSet set = EffectSet().with(effect);

  switch (effect) {
    case Effect::lights:
      return set.with(Effect::shadows)
          .with(Effect::softShadows)
          .with(Effect::spotLights)
          .with(Effect::directionalLights);
    case Effect::shadows:
      return set.with(Effect::softShadows);
    case Effect::textures:
    case Effect::emission:
      return set.with(Effect::emissionMaps);
    case Effect::sky:
      return set.with(Effect::skyImage).with(Effect::blurredSky);
    case Effect::transmission:
      return set.with(Effect::absorption).with(Effect::coverage);
    case Effect::glossy:
      return set.with(Effect::glossyReflection).with(Effect::blurredSky);
    case Effect::glossyReflection:
      return set.with(Effect::blurredSky);
    case Effect::ambient:
      return set.with(Effect::ambientOcclusion);
    default:
      return set;
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
  Effect effect() const { return static_cast<Effect>(GetParam()); }
};

TEST_P(AbsentEffect, IsWhatTheSceneNoLongerCallsFor) {
  static const EffectSet kOfAll = loadWithout(EffectSet()).effects;
  EXPECT_EQ(kOfAll, EffectSet::all());
  EXPECT_EQ(loadWithout(withDependents(effect())).effects,
            EffectSet::all().without(withDependents(effect())));
}

TEST_P(AbsentEffect, CompiledInAllTheSameGivesTheSameBits) {
  const Scene scene = loadWithout(withDependents(effect()));
  RenderOptions o = glossyOptions();
  const Image plain = render(scene, o).image;
  o.effects = EffectChoice::all;
  EXPECT_EQ(firstDifference(render(scene, o).image, plain), "");

  o.disable = withDependents(effect()).without(EffectSet().with(effect()));
  EXPECT_EQ(firstDifference(render(scene, o).image, plain), "") << "this one alone";
}

TEST_P(AbsentEffect, OnTopOfTheMatteSceneGivesTheSameBits) {
  const EffectSet matte = kMatteEffects.without(withDependents(effect()));
  const Scene scene = loadWithout(EffectSet::all().without(matte));
  ASSERT_EQ(scene.effects, matte);

  RenderOptions o = glossyOptions();
  const Image plain = render(scene, o).image;
  o.effects = EffectChoice::all;
  o.disable = EffectSet::all().without(matte.with(effect()));
  EXPECT_EQ(firstDifference(render(scene, o).image, plain), "");
}

// Rays, kernel calls and memory of a frame.
struct Cost {
  FrameStats stats;
  BufferBytes buffers;
  std::size_t capacity = 0, texels = 0, instances = 0, lights = 0;
  bool skyImage = false, coplanar = false, coverage = false;
  bool mirrorMaps = false, transmissionMaps = false, occlusionMaps = false;
};

Cost costWithout(EffectSet effects) {
  const Scene scene = loadWithout(effects);
  RenderOptions o = glossyOptions();
  o.threads = 1;
  o.depth = 1;
  Renderer renderer(scene, o);
  Film film = makeFilm(scene, o);

  Cost cost;
  cost.stats = renderer.render(chooseCamera(scene, o), film);
  cost.buffers = renderer.scheduler().tracers().at(0)->bufferBytes();
  cost.capacity = static_cast<std::size_t>(2 * o.tile * o.tile);
  // A texture of one texel stands for one that is left out.
  for (const TextureRecord& t : renderer.tables().textures) {
    cost.texels += static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height) - 1;
  }

  cost.instances = renderer.tables().instances.size();
  cost.lights = renderer.tables().lights.size();
  cost.skyImage = renderer.tables().sky.r != nullptr;
  cost.coplanar = !scene.coplanar.empty();
  cost.coverage = scene.effects.has(Effect::coverage);
  cost.mirrorMaps = renderer.plan().features.has(Feature::mirrorMaps);
  cost.transmissionMaps = renderer.plan().features.has(Feature::transmissionMaps);
  cost.occlusionMaps = renderer.plan().features.has(Feature::occlusionMaps);
  return cost;
}

std::uint64_t callsOf(const Cost& cost, Stage stage) { return cost.stats.callsOf(stage); }

template <typename Columns>
std::size_t columnBytes(const Cost& cost, bool glossy, bool transmission, bool instances) {
  const FeatureSet features = FeatureSet()
                                  .with(Feature::emissionFactors)
                                  .with(Feature::cones)
                                  .with(Feature::streams)
                                  .with(Feature::coplanar, cost.coplanar)
                                  .with(Feature::glossy, glossy)
                                  .with(Feature::lobes, glossy)
                                  .with(Feature::transmission, transmission)
                                  .with(Feature::coverage, cost.coverage)
                                  .with(Feature::mirrorMaps, cost.mirrorMaps)
                                  .with(Feature::transmissionMaps, cost.transmissionMaps)
                                  .with(Feature::occlusionMaps, cost.occlusionMaps)
                                  .with(Feature::instances, instances);
  return ColumnStore<Columns>(cost.capacity, features).bytes();
}

TEST(AbsentEffects, WithAllOfThemEveryRayKernelAndBufferIsThere) {
  const Cost cost = costWithout(EffectSet());
  for (const RayTally& tally : cost.stats.meter.tally) EXPECT_GT(tally.rays, 0u);
  for (const std::uint64_t calls : cost.stats.stageCalls) EXPECT_GT(calls, 0u);

  EXPECT_GT(cost.stats.callsOf(simd::kAddReflections), 0u);
  EXPECT_GT(cost.stats.callsOf(simd::kAddGlossyReflections), 0u);
  EXPECT_GT(cost.stats.callsOf(simd::kAddRefractions), 0u);
  EXPECT_GT(cost.stats.callsOf(simd::kAddIndirect), 0u);

  EXPECT_EQ(cost.buffers.hits, columnBytes<HitColumns>(cost, true, true, true));
  EXPECT_EQ(cost.buffers.surfels, columnBytes<SurfelColumns>(cost, true, true, true));
  EXPECT_EQ(cost.buffers.unshadowed, columnBytes<UnshadowedColumns>(cost, true, true, true));
  EXPECT_EQ(cost.buffers.shadows, columnBytes<ShadowColumns>(cost, true, true, true));
  EXPECT_GT(cost.texels, 1000u);
  EXPECT_GT(cost.instances, 1u);
  EXPECT_TRUE(cost.skyImage);
}

TEST(AbsentEffects, WithoutLightsNoLightKernelsNoShadowRaysNoBuffers) {
  const Cost cost = costWithout(EffectSet().with(Effect::lights).with(Effect::ambientOcclusion));
  EXPECT_EQ(cost.stats.of(RayKind::shadow).rays, 0u);
  for (const Stage s : {Stage::findRadianceAndShadowRays, Stage::checkShadows, Stage::addShading}) {
    EXPECT_EQ(callsOf(cost, s), 0u) << kStageNames[static_cast<std::size_t>(s)];
  }
  EXPECT_EQ(cost.buffers.unshadowed + cost.buffers.shadows, 0u);
  EXPECT_EQ(cost.lights, 0u);
}

TEST(AbsentEffects, WithoutShadowsNoShadowRaysAndNoBufferForThem) {
  const Cost cost = costWithout(EffectSet().with(Effect::shadows).with(Effect::ambientOcclusion));
  EXPECT_EQ(cost.stats.of(RayKind::shadow).rays, 0u);
  EXPECT_EQ(callsOf(cost, Stage::checkShadows), 0u);
  EXPECT_GT(callsOf(cost, Stage::addShading), 0u);
  EXPECT_EQ(cost.buffers.shadows, 0u);
  EXPECT_GT(cost.buffers.unshadowed, 0u);
}

TEST(AbsentEffects, WithoutMirrorsNoReflections) {
  const Cost cost = costWithout(EffectSet().with(Effect::mirror).with(Effect::glossyReflection));
  EXPECT_EQ(cost.stats.of(RayKind::reflection).rays, 0u);
  EXPECT_EQ(cost.stats.callsOf(simd::kAddReflections), 0u);
  EXPECT_GT(cost.stats.of(RayKind::refraction).rays, 0u);
}

TEST(AbsentEffects, WithoutGlossyReflectionNoSamplesAndNoPaths) {
  const Cost all = costWithout(EffectSet());
  const Cost cost = costWithout(EffectSet().with(Effect::glossyReflection));
  EXPECT_EQ(cost.stats.callsOf(simd::kAddGlossyReflections), 0u);
  EXPECT_GT(cost.stats.callsOf(simd::kAddReflections), 0u);
  EXPECT_LT(cost.stats.of(RayKind::reflection).rays, all.stats.of(RayKind::reflection).rays);
  EXPECT_LT(cost.buffers.rays, all.buffers.rays);
}

TEST(AbsentEffects, WithoutIndirectNoSamples) {
  const Cost cost = costWithout(EffectSet().with(Effect::indirect));
  EXPECT_EQ(cost.stats.of(RayKind::indirect).rays, 0u);
  EXPECT_EQ(cost.stats.callsOf(simd::kAddIndirect), 0u);
  EXPECT_GT(cost.stats.of(RayKind::occlusion).rays, 0u);
}

TEST(AbsentEffects, WithoutAmbientOcclusionNoRays) {
  const Cost cost = costWithout(EffectSet().with(Effect::ambientOcclusion));
  EXPECT_EQ(cost.stats.of(RayKind::occlusion).rays, 0u);
  EXPECT_EQ(cost.stats.callsOf(simd::kFindAmbientAndOcclusionRays), 0u);
  EXPECT_GT(cost.stats.of(RayKind::shadow).rays, 0u);
}

TEST(AbsentEffects, WithoutTransmissionNoRefractionsAndNoMedia) {
  const Cost cost = costWithout(EffectSet().with(Effect::transmission));
  EXPECT_EQ(cost.stats.of(RayKind::refraction).rays, 0u);
  EXPECT_EQ(cost.stats.callsOf(simd::kAddRefractions), 0u);
  EXPECT_GT(cost.stats.of(RayKind::reflection).rays, 0u);
  EXPECT_EQ(cost.buffers.surfels, columnBytes<SurfelColumns>(cost, true, false, true));
}

TEST(AbsentEffects, WithoutImpulsesNothingBelowTheFirstDepth) {
  // Fog returns each ray to its eye in the stage that is counted here.
  const Cost cost = costWithout(EffectSet()
                                    .with(Effect::fog)
                                    .with(Effect::transmission)
                                    .with(Effect::mirror)
                                    .with(Effect::glossyReflection)
                                    .with(Effect::indirect));
  EXPECT_EQ(callsOf(cost, Stage::addImpulses), 0u);
  EXPECT_EQ(cost.buffers.rays, columnBytes<RayColumns>(cost, true, false, true));
  EXPECT_EQ(cost.buffers.radiance, columnBytes<RadianceColumns>(cost, true, true, true));
}

TEST(AbsentEffects, WithoutGlossyNoSpecularColumns) {
  const Cost cost = costWithout(EffectSet().with(Effect::glossy));
  EXPECT_EQ(cost.buffers.surfels, columnBytes<SurfelColumns>(cost, false, true, true));
}

// The lobes of whitted are the highlights of its mirrors and glass, and take nothing from others.
TEST(AbsentEffects, WithoutLobesThatCoverNoColumnsOfTheirShare) {
  const FeatureSet features = makePlan(load("whitted"), smallOptions()).features;
  EXPECT_TRUE(features.has(Feature::glossy));
  EXPECT_FALSE(features.has(Feature::lobes));
}

TEST(AbsentEffects, WithoutInstancesNoColumnAndNoTransforms) {
  const Cost cost = costWithout(EffectSet().with(Effect::instances));
  EXPECT_EQ(cost.buffers.hits, columnBytes<HitColumns>(cost, true, true, false));
  // Masked lanes need one transform to read.
  EXPECT_EQ(cost.instances, 1u);
}

TEST(AbsentEffects, WithoutCoverageNoKernelAndNoColumn) {
  const Cost whole = costWithout(EffectSet().with(Effect::coverage)),
             part = costWithout(EffectSet());
  EXPECT_EQ(whole.stats.callsOf(simd::kLookUpCoverage), 0u);
  EXPECT_GT(part.stats.callsOf(simd::kLookUpCoverage), 0u);
  EXPECT_EQ(whole.buffers.surfels, columnBytes<SurfelColumns>(whole, true, true, true));
  EXPECT_LT(whole.buffers.surfels, part.buffers.surfels);
}

TEST(AbsentEffects, WithoutTexturesNoTexels) {
  const EffectSet maps = EffectSet().with(Effect::textures).with(Effect::normalMaps);
  const Cost all = costWithout(EffectSet()), none = costWithout(maps);
  EXPECT_EQ(none.texels, 0u);
  for (const Effect effect : {Effect::textures, Effect::normalMaps}) {
    const Cost one = costWithout(EffectSet().with(effect));
    EXPECT_GT(one.texels, none.texels) << nameOf(effect);
    EXPECT_LT(one.texels, all.texels) << nameOf(effect);
  }
}

TEST(AbsentEffects, WithoutVertexNormalsNoneAreKept) {
  EXPECT_TRUE(loadWithout(EffectSet().with(Effect::smoothNormals)).normals.empty());
  EXPECT_FALSE(loadWithout(EffectSet()).normals.empty());
}

TEST(AbsentEffects, WithoutASkyImageNoPlanes) {
  EXPECT_FALSE(costWithout(EffectSet().with(Effect::skyImage)).skyImage);
}

INSTANTIATE_TEST_SUITE_P(All, AbsentEffect, testing::Range(0, kEffectCount), [](const auto& info) {
  return std::string(nameOf(static_cast<Effect>(info.param)));
});

}  // namespace
}  // namespace whit::test
