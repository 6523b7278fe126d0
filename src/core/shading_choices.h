// Choices of a frame that change a formula, in the kernels and in the reference alike. The defaults
// are the accurate ones.
#pragma once

namespace whit {

// Reflectance of a dielectric: Fresnel's equations, or Schlick's polynomial in the cosine on the
// side of the lower refractive index (Schlick 1994, "An inexpensive BRDF model for physically-based
// rendering"). Where reflection is total, both are 1.
enum class FresnelModel { exact, schlick };

// Filter of colors and normal maps; alpha masks are always bilinear. Trilinear: between the
// two mip levels whose texels come closest to the pixel's footprint, which follows from a cone
// about the ray (Akenine-Moeller et al. 2019, "Texture level of detail strategies for real-time ray
// tracing", Ray Tracing Gems, chapter 20). Mirrors and glass hand the cone's spread on as it is,
// whatever their curvature, and so do samples of glossy lobes.
enum class TextureFilter { nearest, bilinear, trilinear };

// How far from its surface a ray starts, along the geometric normal on the side that it goes to.
enum class OffsetMethod {
  // The surfel's own bound on the rounding error of its position (see surfacePoint). On the
  // viewer's side back along the ray as well: the way there is clear, so a point that has been
  // rounded onto or beyond a wall which meets the surface in an edge comes back inside of that, and
  // no light leaks in (hard case H7).
  bound,
  // kFixedOffset, whatever the size of the scene.
  fixed,
  // 256 units in the last place of each coordinate, times the normal's component, and near the
  // origin 1/65536 (Waechter and Binder 2019, "A fast and robust method for avoiding
  // self-intersection", Ray Tracing Gems, chapter 6).
  wachterBinder,
};
inline constexpr float kFixedOffset = 1e-3f;
// Where on the way to a light shadow rays end. The light's position is exact, the way to it and
// what Embree finds at its end are not: by some ulps of the way, whatever the place.
inline constexpr float kShadowReach = 1.0f - 0x1p-20f;

struct ShadingChoices {
  // A light that adds less than this to the pixel, at most, is left out, shadow ray and all. The
  // pixel's error is at most this times the number of such lights and surfels.
  float lightCutoff = 0;
  FresnelModel fresnel = FresnelModel::exact;
  TextureFilter textureFilter = TextureFilter::trilinear;
  OffsetMethod offset = OffsetMethod::bound;
  // Shadow rays start above the facet, where the surface that its vertex normals stand for would be
  // (Hanika 2021, "Hacking the shadow terminator", Ray Tracing Gems II, chapter 4).
  bool terminator = false;

  // Impulses that a bent shading normal sends to the wrong side of the surface are turned back to
  // the right one (hard case H32); else they start into the solid, or out of it.
  bool bend = true;

  bool operator==(const ShadingChoices&) const = default;
};

}  // namespace whit
