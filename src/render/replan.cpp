// What may change from frame to frame: options, materials and lights.
#include "core/error.h"
#include "core/option_table.h"
#include "render/build_tables.h"
#include "render/renderer_parts.h"

namespace whit {

namespace {

// What the acceleration structure has built in of a plan's effects.
EffectSet builtIn(const Plan& plan) {
  constexpr EffectSet kBuiltIn = EffectSet().with(Effect::alphaMasks).with(Effect::instances);
  return EffectSet(plan.effects.bits() & kBuiltIn.bits());
}

}  // namespace

void Renderer::Parts::replan(const Plan& next) {
  const bool otherQueues =
      next.groups != plan.groups || next.effects != plan.effects || next.depth != plan.depth;
  plan = next;
  if (otherQueues) tracers.clear();  // laid out again by the next frame
}

void Renderer::shadingChanged() {
  Parts& p = *parts_;
  const Plan plan = makePlan(p.scene, p.options);
  if (plan.effects == p.plan.effects) {
    refreshShading(p.scene, plan.effects, p.machine.threads, p.tables);
  } else {
    p.tables = buildTables(p.scene, plan.effects, p.options.shading, p.machine.threads);
  }
  p.replan(plan);
}

void Renderer::setOptions(const RenderOptions& options) {
  Parts& p = *parts_;
  const Plan plan = makePlan(p.scene, options);
  if (builtIn(plan) != builtIn(p.plan)) {
    throwUsage(
        "alpha masks and instances are part of the acceleration structure: it has to be built "
        "anew");
  }
  const bool lacksMips = plan.groups.cones && p.tables.mipLevels.empty();
  if (rebuildNeeded(p.options, options) >= Rebuild::tables &&
      (plan.effects != p.plan.effects || lacksMips)) {
    p.tables = buildTables(p.scene, plan.effects, options.shading, p.machine.threads);
  }
  p.tables.shading = options.shading;
  p.replan(plan);
  if (options.spp != p.options.spp) p.probes.reset();
  takeOver(options, Rebuild::tables, p.options);
}

bool Renderer::canSetOptions(const RenderOptions& options) const {
  const Parts& p = *parts_;
  return rebuildNeeded(p.options, options) <= Rebuild::tables &&
         builtIn(makePlan(p.scene, options)) == builtIn(p.plan);
}

}  // namespace whit
