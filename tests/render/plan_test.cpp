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

Plan planOf(EffectSet effects) {
  Scene scene;
  scene.effects = effects;
  scene.lights.resize(1);
  RenderOptions options;
  options.glossy = 2;
  return makePlan(scene, options);
}

TEST(Kernels, BelongToStagesInOrder) {
  EXPECT_TRUE(std::is_sorted(kKernels.begin(), kKernels.end(),
                             [](const Kernel& a, const Kernel& b) { return a.stage < b.stage; }));

  for (std::size_t s = 0; s < kStageCount; ++s) {
    const auto stage = static_cast<Stage>(s);
    const bool has = std::any_of(kKernels.begin(), kKernels.end(),
                                 [&](const Kernel& k) { return k.stage == stage; });
    EXPECT_TRUE(has) << kStageNames[s];
  }
}

TEST(KernelsOfAPlan, RunInTheOrderOfItsStagesAndComeFromTheTable) {
  for (const EffectSet effects : manySets()) {
    const Plan plan = planOf(effects);
    std::set<Stage> stages;
    const std::vector<KernelUse> uses = kernelsOf(plan);
    for (const KernelUse& use : uses) {
      stages.insert(use.stage);

      // Embree's own calls are not kernels of the table.
      if (use.target == "embree") continue;
      const auto kernel = std::find_if(kKernels.begin(), kKernels.end(),
                                       [&](const Kernel& k) { return k.name == use.kernel; });
      ASSERT_NE(kernel, kKernels.end()) << use.kernel;
      EXPECT_EQ(use.stage, kernel->stage);
    }

    EXPECT_EQ(std::vector<Stage>(stages.begin(), stages.end()), plan.stages());
    EXPECT_TRUE(
        std::is_sorted(uses.begin(), uses.end(),
                       [](const KernelUse& a, const KernelUse& b) { return a.stage < b.stage; }));
  }
}

TEST(KernelsOfAPlan, AreThoseThatItsEffectsNeed) {
  const Plan plan = planOf(EffectSet()
                               .with(Effect::lights)
                               .with(Effect::textures)
                               .with(Effect::normalMaps)
                               .with(Effect::mirror));

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
    Scene scene;
    scene.effects = EffectSet::all();
    scene.lights.resize(1);
    std::vector<std::string> names;
    for (const KernelUse& use : kernelsOf(makePlan(scene, options))) {
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

TEST(Plans, HaveNoStepThatReadsWhatNoneHasWritten) {
  for (const EffectSet effects : manySets()) {
    EXPECT_NO_THROW(planOf(effects)) << effects.bits();
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

  EXPECT_FALSE(plan.find("findHits")->endsStage);
  EXPECT_FALSE(plan.find("addReflections")->endsStage);
  EXPECT_FALSE(plan.find("addRefractions")->endsStage);
  EXPECT_TRUE(plan.find("limitRays")->endsStage);
  EXPECT_TRUE(plan.find("updateImage")->endsStage);
}

}  // namespace
}  // namespace whit::test
