// The kernels' tables, from a frozen scene.
#pragma once

#include "stages/shading_tables.h"

namespace whit {

// Only what `effects` need is copied. The scene must outlive the tables. Throws Error(limit) when
// textures hold more texels than a 31-bit index reaches.
ShadingTables buildTables(const Scene& scene, EffectSet effects);

}  // namespace whit
