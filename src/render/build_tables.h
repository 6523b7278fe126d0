// The kernels' tables, from a frozen scene.
#pragma once

#include "stages/shading_tables.h"

namespace whit {

// Only what `effects` need is copied. The scene must outlive the tables. Throws Error(limit) when
// textures hold more texels than a 31-bit index reaches.
ShadingTables buildTables(const Scene& scene, EffectSet effects);

// After materials or lights of the scene have changed, the effects being the same: texels and
// geometry, which take long to copy, stay where they are, unless other textures are needed now.
void refreshShading(const Scene& scene, EffectSet effects, ShadingTables& tables);

}  // namespace whit
