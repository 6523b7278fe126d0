// Texture lookups in double precision.
#pragma once

#include "bake/mip_maps.h"
#include "core/shading_choices.h"
#include "surfaces/intersect.h"

namespace whit {

// The triangle and weights by which textures are looked up: those of the hit, or of a triangle that
// touches the sphere.
struct Textured {
  TriangleRecord triangle;
  TriangleHit hit;
  const float* secondUvs = nullptr;

  const float* uvs(bool second) const { return second && secondUvs ? secondUvs : triangle.uv; }
};

Textured texturedAt(const Scene& scene, std::uint32_t number, const TriangleHit& hit);

// The factor of alpha and coverage maps by the alpha of vertices (Material::alphaByVertex).
double vertexAlpha(const Material& material, const Textured& at);

// Texture coordinates at the hit, from those of the corners (Scene::uvsOf).
struct TexturePoint {
  double u = 0, v = 0;
};

TexturePoint texturePoint(const float* uvs, const TriangleHit& hit);

// u runs to the right and v upwards; texel centers lie at half-integers. Coordinates that are not
// finite or beyond 2^20 either way, where a float holds no fraction of a texel any more, count as
// 0. Returns linear light, or the first three channels of TexelFormat::data, in [0, 1].
RgbD sampleTexture(const Texture& texture, double u, double v,
                   TextureFilter filter = TextureFilter::bilinear);

// The mip level at which a texel is as large as the `area` of the full texture, in texels: 0 up to
// one texel, and one more each time that the area's sides double. 0 where the area is no number.
double mipLevel(double area);

// Mixes bilinear lookups in the levels below and above `level` by its fraction.
RgbD sampleTexture(const MipMaps& maps, const ShownMap& map, double u, double v, double level);

}  // namespace whit
