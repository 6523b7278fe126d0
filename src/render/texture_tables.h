// The kernels' tables of textures. Texels lie in tiles of 4x4, a cache line each, so that the four
// of a bilinear lookup share a line and a page more often than not (Blinn 1990, "The truth about
// texture mapping").
#pragma once

#include "stages/shading_tables.h"

namespace whit {

// Those that the materials of `tables` use, with mip levels where lookups are trilinear, made by
// `threads` together. Throws Error(limit) when they hold more texels than a 31-bit index reaches.
void addTextures(const Scene& scene, EffectSet effects, int threads, ShadingTables& tables);

}  // namespace whit
