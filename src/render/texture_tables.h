// The kernels' tables of textures. Texels lie in tiles of 4x4, a cache line each (Blinn 1990, "The
// truth about texture mapping"), which overlap by one: the four of a bilinear lookup share a line
// always, at the price of 16/9 of the memory.
#pragma once

#include "core/shading_choices.h"
#include "stages/shading_tables.h"

namespace whit {

// Adds the textures that the materials of `tables` use, with mip levels where lookups are
// trilinear. `threads` threads share the work. Throws Error(limit) if they hold more texels than a
// 31-bit index reaches, borders included, or if a texture has a side beyond kTextureSideLimit.
void addTextures(const Scene& scene, EffectSet effects, TextureFilter filter, int threads,
                 ShadingTables& tables);

}  // namespace whit
