// Changes between frames: options, materials and lights.
#include "core/error.h"
#include "core/option_table.h"
#include "render/build_tables.h"
#include "render/renderer.h"

namespace whit {

namespace {

// The effects of a plan that are built into the acceleration structure.
EffectSet builtIn(const Plan& plan) {
  constexpr EffectSet kBuiltIn =
      EffectSet().with(Effect::alphaMasks).with(Effect::instances).with(Effect::spheres);
  return EffectSet(plan.effects.bits() & kBuiltIn.bits());
}

}  // namespace

void Renderer::replan(Plan next) {
  // Tracers follow the plan that is there; only the columns that they hold are made for one.
  if (next.features != plan_.features || next.effects != plan_.effects ||
      next.depth != plan_.depth || next.channels != plan_.channels) {
    scheduler_.forgetTracers();
  }
  plan_ = std::move(next);
}

bool Renderer::usesShadowCache(const RenderOptions& options) const {
  const bool standsStill = !scene_.motion.ofGeometry && !scene_.motion.ofLights();
  return standsStill && shadowCacheBytes_ > 0 && options.shadowCache != ShadowCacheMode::off;
}

void Renderer::expectFrames(std::uint64_t mostBytes, std::uint32_t askingTurns) {
  shadowCacheBytes_ = mostBytes;
  asking_ = {0, askingTurns};
  replan(makePlan(scene_, options_, usesShadowCache(options_)));
  renewShadowCache();
}

// Tables for the lights whose shadows the plan decides; what is known of the others goes.
void Renderer::renewShadowCache() {
  const std::vector<std::size_t> lights = lightsWithShadowCache(plan_);
  if (lights.empty()) return;
  if (shadowTables_ && shadowTables_->lights() == lights &&
      shadowTables_->views().size() == scene_.lights.size()) {
    shadowTables_->forgetMovedLights();
  } else {
    shadowTables_.emplace(scene_, lights, shadowCacheBytes_);
  }
}

FillReport Renderer::fillShadowCache(const FillLimits& limits) {
  return decidesShadows() ? shadowTables_->fill(scheduler_.pool(), limits) : FillReport();
}

void Renderer::forgetShadowRequests() {
  if (shadowTables_) shadowTables_->forgetAsked();
}

void Renderer::shadingChanged() {
  Plan plan = makePlan(scene_, options_, usesShadowCache(options_));
  if (plan.effects == plan_.effects) {
    refreshShading(scene_, plan.effects, options_.shading, machine_.threads, tables_);
  } else {
    tables_ = buildTables(scene_, plan.effects, options_.shading, machine_.threads);
  }
  replan(std::move(plan));
  renewShadowCache();
}

void Renderer::setOptions(const RenderOptions& options) {
  Plan plan = makePlan(scene_, options, usesShadowCache(options));
  if (builtIn(plan) != builtIn(plan_)) {
    throwUsage(
        "alpha masks, spheres and instances are part of the acceleration structure: it has to be "
        "built anew");
  }
  const bool lacksMips = plan.features.has(Feature::cones) && tables_.mipLevels.empty();
  if (rebuildNeeded(options_, options) >= Rebuild::tables &&
      (plan.effects != plan_.effects || lacksMips)) {
    tables_ = buildTables(scene_, plan.effects, options.shading, machine_.threads);
  }
  replan(std::move(plan));
  takeOver(options, Rebuild::tables, options_);
  renewShadowCache();
}

bool Renderer::canSetOptions(const RenderOptions& options) const {
  return rebuildNeeded(options_, options) <= Rebuild::tables &&
         builtIn(makePlan(scene_, options)) == builtIn(plan_);
}

}  // namespace whit
