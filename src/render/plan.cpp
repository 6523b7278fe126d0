#include "render/plan.h"

#include "simd/kernels.h"

namespace whit {

namespace {

// Effects that mean nothing without another one go with it.
EffectSet consistent(EffectSet e) {
  if (!e.has(Effect::lights)) e = e.without(Effect::shadows).without(Effect::glossy);
  if (!e.has(Effect::transmission)) e = e.without(Effect::absorption);
  if (!e.has(Effect::sky)) e = e.without(Effect::skyImage);
  return e;
}

// The effects of `mask` that are on, joined by '+'.
std::string variantName(EffectSet effects, std::initializer_list<Effect> mask) {
  std::string name;
  for (const Effect e : mask) {
    if (!effects.has(e)) continue;
    if (!name.empty()) name += '+';
    name += kEffectNames[static_cast<std::size_t>(e)].name;
  }
  return name.empty() ? "plain" : name;
}

}  // namespace

Plan makePlan(const Scene& scene, const RenderOptions& options) {
  Plan plan;
  const bool all = options.effects == EffectChoice::all;
  plan.effects = consistent((all ? EffectSet::all() : scene.effects).without(options.disable));
  plan.traceShadows = plan.effects.has(Effect::shadows);
  plan.traceReflections = plan.effects.has(Effect::mirror);
  plan.traceRefractions = plan.effects.has(Effect::transmission);
  plan.depth = plan.traceReflections || plan.traceRefractions ? options.depth : 0;
  plan.groups.glossy = plan.effects.has(Effect::glossy);
  plan.groups.transmission = plan.traceRefractions;
  plan.groups.instances = plan.effects.has(Effect::instances);
  plan.stages = {Stage::generateRays, Stage::findIntersections,
                 Stage::writeEmittedAndReflectiveAmbient};
  if (plan.effects.has(Effect::lights)) {
    plan.stages.push_back(Stage::findRadianceAndShadowRays);
    if (plan.traceShadows) plan.stages.push_back(Stage::checkShadows);
    plan.stages.push_back(Stage::addShading);
  }
  if (plan.depth > 0) plan.stages.push_back(Stage::addImpulses);
  plan.stages.push_back(Stage::updateImage);
  return plan;
}

std::vector<KernelUse> kernelsOf(const Plan& plan) {
  const std::string target = simd::chosenTarget();
  std::vector<KernelUse> uses;
  for (const Stage stage : plan.stages) {
    std::string variant = "plain";
    if (stage == Stage::findIntersections) {
      variant =
          variantName(plan.effects, {Effect::smoothNormals, Effect::textures, Effect::normalMaps});
    } else if (stage == Stage::findRadianceAndShadowRays) {
      variant = variantName(plan.effects, {Effect::glossy});
    }
    uses.push_back({stage, variant, stage == Stage::checkShadows ? "embree" : target});
  }
  return uses;
}

}  // namespace whit
