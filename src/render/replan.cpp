// What may change from frame to frame: options, materials and lights.
#include "core/error.h"
#include "render/build_tables.h"
#include "render/renderer_parts.h"

namespace whit {

namespace {

// What Renderer::setOptions() takes over.
void takeOver(const RenderOptions& from, RenderOptions& to) {
  to.spp = from.spp;
  to.adaptive = from.adaptive;
  to.contrast = from.contrast;
  to.depth = from.depth;
  to.glossy = from.glossy;
  to.cutoff = from.cutoff;
  to.shading = from.shading;
  to.exposure = from.exposure;
  to.toneCurve = from.toneCurve;
  to.film = from.film;
  to.srgb = from.srgb;
  to.effects = from.effects;
  to.disable = from.disable;
}

// What is said to each frame anew, or means nothing to a renderer.
void takeOverFrame(const RenderOptions& from, RenderOptions& to) {
  to.size = from.size;
  to.crop = from.crop;
  to.camera = from.camera;
  to.eye = from.eye;
  to.at = from.at;
  to.up = from.up;
  to.fov = from.fov;
  to.ortho = from.ortho;
  to.mode = from.mode;
  to.quality = from.quality;
  to.strict = from.strict;
}

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
  if (plan.effects != p.plan.effects || lacksMips) {
    p.tables = buildTables(p.scene, plan.effects, options.shading, p.machine.threads);
  }
  p.tables.shading = options.shading;
  p.replan(plan);
  if (options.spp != p.options.spp) p.probes.reset();
  takeOver(options, p.options);
}

bool Renderer::canSetOptions(const RenderOptions& options) const {
  const Parts& p = *parts_;
  RenderOptions reached = p.options;
  takeOver(options, reached);
  takeOverFrame(options, reached);
  return reached == options && builtIn(makePlan(p.scene, options)) == builtIn(p.plan);
}

}  // namespace whit
