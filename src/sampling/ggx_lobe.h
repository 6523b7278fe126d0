// The GGX lobe (Walter et al. 2007, "Microfacet models for refraction through rough surfaces") with
// height-correlated Smith masking (Heitz 2014): normals of its facets that can be seen, and the
// share of even light that it reflects.
#pragma once

#include <algorithm>
#include <array>

#include "core/vec3.h"

namespace whit {

// The view's cosine counts as no less than this: the lobe divides by it, and bent normals can make
// it 0 or negative.
inline constexpr double kLeastCosine = 1e-4;

// A normal of the microsurface, drawn from those that can be seen along `view`, each as often as it
// is seen (Heitz 2018, "Sampling the GGX distribution of visible normals", JCGT 7(4); by the
// spherical cap of Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps",
// Computer Graphics Forum 42(8)), at a point of the unit square: v, and u as cosine and sine of the
// angle 2 pi u. The surface's normal is z; `view` is a unit vector above it; of width 0 the surface
// is smooth and the result z.
Vec3d visibleNormal(const Vec3d& view, double alpha, double cosine, double sine, double v);

// G2 / G1: the share of the light reflected by a visible facet that no other facet shadows. `nv`
// and `nl` are the cosines of view and reflected ray to the normal.
double passingShare(double nv, double nl, double alpha);

// Smith's G1: the share of a facet that is seen at this cosine to the surface's normal. Of what a
// visible facet transmits as much gets out, since either side of the surface has its own masking
// (Walter et al. 2007, section 5.1).
double seenShare(double cosine, double alpha);

// A table of the share of even light that the lobe reflects (Karis 2013, "Real Shading in Unreal
// Engine 4"): F0 * (all - grazing) + F90 * grazing with the reflectances F0 at normal and F90 at
// grazing incidence. It has a row for each roughness from 0 to 1 and a column for each square root
// of the view's cosine.
inline constexpr int kLobeSteps = 32;
struct LobeTable {
  std::array<float, kLobeSteps * kLobeSteps> all{}, grazing{};
};
// The table is made at the first call.
const LobeTable& lobeTable();
// The share by bilinear interpolation in the table.
RgbD lobeAlbedo(const RgbD& f0, double f90, double cosine, double roughness);

// F90, `ratio` times the largest channel of F0 (Material::grazingRatio).
inline double lobeGrazing(const RgbD& f0, double ratio) {
  return std::min(1.0, ratio * maxComponent(f0));
}

}  // namespace whit
