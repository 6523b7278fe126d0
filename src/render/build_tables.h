// The kernels' tables, from a frozen scene.
#pragma once

#include "core/shading_choices.h"
#include "stages/shading_tables.h"

namespace whit {

// Only what `effects` and choices need is copied or, of mip maps, made, by `threads` together. The
// scene must outlive the tables. Throws Error(limit) when textures hold more texels than a 31-bit
// index reaches.
ShadingTables buildTables(const Scene& scene, EffectSet effects, const ShadingChoices& shading,
                          int threads = 1);

// After moveScene().
void refreshInstances(const Scene& scene, ShadingTables& tables);

// After materials or lights of the scene, the effects or choices have changed: texels and geometry,
// which take long to copy, stay where they are, unless other textures or mip maps are needed now.
void refreshShading(const Scene& scene, EffectSet effects, const ShadingChoices& shading,
                    int threads, ShadingTables& tables);

}  // namespace whit
