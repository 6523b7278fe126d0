// Texture lookups in double precision.
#pragma once

#include "core/shading_choices.h"
#include "scene/texture.h"

namespace whit::reference {

// u to the right, v upwards; texel centres lie at half-integers. Coordinates that are not finite or
// beyond 2^20 either way, where a float holds no fraction of a texel any more, count as 0.
// Linear light, of a texture in TexelFormat::colour.
RgbD sampleColour(const Texture& texture, double u, double v,
                  TextureFilter filter = TextureFilter::bilinear);

struct DataSample {
  double r = 0, g = 0, b = 0, a = 0;
};
// Channels in [0, 1], of a texture in TexelFormat::data.
DataSample sampleData(const Texture& texture, double u, double v,
                      TextureFilter filter = TextureFilter::bilinear);

}  // namespace whit::reference
