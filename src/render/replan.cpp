// What may change from frame to frame: options, materials and lights.
#include "core/error.h"
#include "render/build_tables.h"
#include "render/renderer.h"

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

void Renderer::replan(Plan next) {
  // Tracers follow the plan that is there; only the columns that they hold are made for one.
  if (next.features != plan_.features || next.effects != plan_.effects ||
      next.depth != plan_.depth) {
    scheduler_.forgetTracers();
  }
  plan_ = std::move(next);
}

void Renderer::shadingChanged() {
  Plan plan = makePlan(scene_, options_);
  if (plan.effects == plan_.effects) {
    refreshShading(scene_, plan.effects, options_.shading, machine_.threads, tables_);
  } else {
    tables_ = buildTables(scene_, plan.effects, options_.shading, machine_.threads);
  }
  replan(std::move(plan));
}

void Renderer::setOptions(const RenderOptions& options) {
  Plan plan = makePlan(scene_, options);
  if (builtIn(plan) != builtIn(plan_)) {
    throwUsage(
        "alpha masks and instances are part of the acceleration structure: it has to be built "
        "anew");
  }
  const bool lacksMips = plan.features.has(Feature::cones) && tables_.mipLevels.empty();
  if (plan.effects != plan_.effects || lacksMips) {
    tables_ = buildTables(scene_, plan.effects, options.shading, machine_.threads);
  }
  replan(std::move(plan));
  takeOver(options, options_);
}

bool Renderer::canSetOptions(const RenderOptions& options) const {
  RenderOptions reached = options_;
  takeOver(options, reached);
  takeOverFrame(options, reached);
  return reached == options && builtIn(makePlan(scene_, options)) == builtIn(plan_);
}

}  // namespace whit
