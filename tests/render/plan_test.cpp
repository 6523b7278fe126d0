// The table of kernels, and the plans that are made of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "render/plan.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

using simd::Kernel;
using simd::kKernels;

// The sets are none, all, those that differ from either by one or two effects, and random ones. A
// step depends on one effect or two, and all combinations of effects are too many to try.
std::vector<EffectSet> manySets() {
  constexpr int kRandomOnes = 1000;
  const std::uint32_t all = EffectSet::all().bits();
  std::vector<EffectSet> sets;
  for (std::uint32_t a = 1; a <= all; a <<= 1) {
    for (std::uint32_t b = a; b <= all; b <<= 1) {
      sets.insert(sets.end(), {EffectSet(a | b), EffectSet(all & ~(a | b))});
    }
  }

  std::mt19937 random(1);
  for (int i = 0; i < kRandomOnes; ++i) {
    sets.push_back(EffectSet(static_cast<std::uint32_t>(random()) & all));
  }

  sets.insert(sets.end(), {EffectSet(), EffectSet(all)});
  return sets;
}

RenderOptions withGlossySamples() {
  RenderOptions options;
  options.glossy = 2;
  return options;
}

Plan planOf(EffectSet effects, const RenderOptions& options = withGlossySamples()) {
  Scene scene;
  scene.effects = effects;
  scene.lights.resize(1);
  return makePlan(scene, options);
}

TEST(Kernels, BelongToStagesInOrder) {
  EXPECT_TRUE(std::ranges::is_sorted(kKernels, {}, &Kernel::stage));
  for (const auto s : indices(kStageCount)) {
    EXPECT_NE(std::ranges::find(kKernels, static_cast<Stage>(s), &Kernel::stage), kKernels.end())
        << kStageNames[s];
  }
}

// A plan with a step that reads what none has written is refused when it is made.
TEST(KernelsOfAPlan, RunInTheOrderOfItsStagesAndComeFromTheTable) {
  for (const EffectSet effects : manySets()) {
    SCOPED_TRACE(effects.bits());
    const Plan plan = planOf(effects);
    std::set<Stage> stages;
    const std::vector<KernelUse> uses = kernelsOf(plan);
    for (const KernelUse& use : uses) {
      stages.insert(use.stage);

      // Embree's own calls are not kernels of the table.
      if (use.target == "embree") continue;
      const auto kernel = std::ranges::find(kKernels, use.kernel, &Kernel::name);
      ASSERT_NE(kernel, kKernels.end()) << use.kernel;
      EXPECT_EQ(use.stage, kernel->stage);
    }

    EXPECT_EQ(std::vector<Stage>(stages.begin(), stages.end()), plan.stages());
    EXPECT_TRUE(std::ranges::is_sorted(uses, {}, &KernelUse::stage));
  }
}

TEST(KernelsOfAPlan, AreThoseThatItsEffectsNeed) {
  const Plan plan = planOf({Effect::lights, Effect::textures, Effect::normalMaps, Effect::mirror});

  std::vector<std::string> names;
  for (const KernelUse& use : kernelsOf(plan)) names.push_back(use.kernel);
  EXPECT_EQ(names, (std::vector<std::string>{
                       "generateRays", "packRays", "intersect", "unpackHits", "interpolateSurfels",
                       "writeEmittedAndReflectiveAmbient", "findRadianceAndShadowRays",
                       "addShading", "addReflections", "returnImpulses", "encodeDisplay"}));
}

TEST(KernelsOfAPlan, EmbreesCallsComeOnceAndBetweenPackingAndUnpacking) {
  RenderOptions options;
  options.shading.terminator = true;
  for (const int packet : {1, 16}) {
    options.packet = packet;
    std::vector<std::string> names;
    for (const KernelUse& use : kernelsOf(planOf(EffectSet::all(), options))) {
      const bool traces = use.stage == Stage::findIntersections || use.stage == Stage::checkShadows;
      if (traces) names.push_back(use.kernel);
    }

    const std::vector<std::string> singly{"intersect", "interpolateSurfels", "lookUpCoverage",
                                          "liftShadowOrigins", "occluded"};
    const std::vector<std::string> inPackets{
        "packRays",          "intersect",      "unpackHits", "interpolateSurfels", "lookUpCoverage",
        "liftShadowOrigins", "packShadowRays", "occluded",   "unpackVisibility"};
    EXPECT_EQ(names, packet == 1 ? singly : inPackets);
  }
}

// A step ends its stage as often as the stage runs: once a queue, and once a light.
TEST(Plans, EndEachStageWithItsLastStep) {
  const Plan plan = planOf(EffectSet::all());
  const Step* before = nullptr;
  plan.forEachStep([&](const Step& step) {
    if (before && before->stage != step.stage) {
      EXPECT_TRUE(before->endsStage) << before->name;
    }

    EXPECT_NE(step.run, nullptr) << step.name;
    before = &step;
  });

  for (const char* step : {"findHits", "addReflections", "addRefractions"}) {
    EXPECT_FALSE(plan.find(step)->endsStage) << step;
  }
  for (const char* step : {"limitRays", "updateImage"}) {
    EXPECT_TRUE(plan.find(step)->endsStage) << step;
  }
}

}  // namespace
}  // namespace whit::test
