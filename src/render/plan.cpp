#include "render/plan.h"

#include <algorithm>

#include "simd/kernel_variants.h"
#include "simd/kernels.h"

namespace whit {

namespace {

// Effects that mean nothing without another one go with it.
EffectSet consistent(EffectSet e, int glossySamples) {
  if (!e.has(Effect::glossy) || glossySamples == 0) e = e.without(Effect::glossyReflection);
  if (!e.has(Effect::lights)) {
    e = e.without(Effect::shadows);
    e = e.without(Effect::spotLights).without(Effect::directionalLights);
    if (!e.has(Effect::glossyReflection)) e = e.without(Effect::glossy);
  }
  if (!e.has(Effect::textures) || !e.has(Effect::emission)) e = e.without(Effect::emissionMaps);
  if (!e.has(Effect::transmission)) e = e.without(Effect::absorption);
  if (!e.has(Effect::sky)) e = e.without(Effect::skyImage);
  return e;
}

bool runs(const Plan& plan, const simd::Kernel& kernel) {
  if (std::find(plan.stages.begin(), plan.stages.end(), kernel.stage) == plan.stages.end()) {
    return false;
  }
  if (kernel.name.starts_with("pack") || kernel.name.starts_with("unpack")) return plan.packets;
  if (kernel.name == "liftShadowOrigins") return plan.groups.lift;
  if (kernel.name == "addReflections") return plan.traceReflections;
  if (kernel.name == "addGlossyReflections") return plan.glossySamples > 0;
  if (kernel.name == "addRefractions") return plan.traceRefractions;
  return true;
}

}  // namespace

Plan makePlan(const Scene& scene, const RenderOptions& options) {
  Plan plan;
  const bool all = options.effects == EffectChoice::all;
  plan.effects =
      consistent((all ? EffectSet::all() : scene.effects).without(options.disable), options.glossy);
  plan.traceShadows = plan.effects.has(Effect::shadows);
  plan.traceReflections = plan.effects.has(Effect::mirror);
  plan.traceRefractions = plan.effects.has(Effect::transmission);
  plan.packets = options.packet != 1;
  plan.glossySamples = plan.effects.has(Effect::glossyReflection) ? options.glossy : 0;
  const bool impulses = plan.traceReflections || plan.traceRefractions || plan.glossySamples > 0;
  plan.depth = impulses ? options.depth : 0;
  plan.groups.glossy = plan.effects.has(Effect::glossy);
  plan.groups.emission =
      plan.effects.has(Effect::emissionMaps) ||
      (plan.effects.has(Effect::emission) && plan.effects.has(Effect::vertexColors));
  plan.groups.transmission = plan.traceRefractions;
  // Where no vertex normal differs from its triangle's there is nothing to lift.
  plan.groups.lift =
      options.shading.terminator && plan.traceShadows && plan.effects.has(Effect::smoothNormals);
  plan.groups.paths = plan.glossySamples > 0;
  plan.groups.cones = options.shading.textureFilter == TextureFilter::trilinear &&
                      (plan.effects.has(Effect::textures) || plan.effects.has(Effect::normalMaps));
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
  bool hits = true, shadows = plan.traceShadows;
  for (const simd::Kernel& kernel : simd::kKernels) {
    if (!runs(plan, kernel)) continue;
    if (hits && kernel.stage >= Stage::findIntersections && kernel.name != "packRays") {
      uses.push_back({Stage::findIntersections, "intersect", "plain", "embree"});
      hits = false;
    }
    if (shadows && kernel.stage >= Stage::checkShadows && kernel.name != "packShadowRays") {
      uses.push_back({Stage::checkShadows, "occluded", "plain", "embree"});
      shadows = false;
    }
    const EffectSet variant = kernel.variant(kernel.variantFor(plan.effects));
    uses.push_back({kernel.stage, std::string(kernel.name), simd::variantName(variant), target});
  }
  return uses;
}

}  // namespace whit
