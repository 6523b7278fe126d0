// What a renderer rebuilds when its options change.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/option_table.h"
#include "inspect/knobs.h"
#include "render/plan.h"

namespace whit {
namespace {

// Renderer::setOptions() keeps the shading tables after changes of options that are declared not to
// affect them. The lens belongs to the camera and no table depends on it.
TEST(Replan, OnlyOptionsOfTheTablesChangeWhatTablesAreMadeFrom) {
  Scene scene;
  scene.effects = EffectSet::all();
  for (const char* filter : {"bilinear", "trilinear"}) {
    RenderOptions base;
    base.glossy = 1;
    setOption(base, "texture-filter", filter);
    const Plan plan = makePlan(scene, base);
    forEachOption(std::as_const(base), [&](const OptionSpec& spec, const auto&) {
      const auto knob = std::ranges::find(allKnobs(), spec.name, &Knob::name);
      if (knob == allKnobs().end() || spec.rebuilds >= Rebuild::tables) return;

      for (const KnobValue& value : knob->values) {
        RenderOptions options = base;
        setOption(options, knob->name, value.label);
        const Plan other = makePlan(scene, options);
        EXPECT_EQ(other.effects.without(Effect::depthOfField),
                  plan.effects.without(Effect::depthOfField))
            << spec.name << " " << value.label;
        EXPECT_EQ(other.features.has(Feature::cones), plan.features.has(Feature::cones))
            << spec.name << " " << value.label;
      }
    });
  }
}

}  // namespace
}  // namespace whit
