// Fresnel's and Snell's laws at a smooth dielectric interface, in a form that keeps its precision
// where the two refractive indices are close or equal.
#pragma once

#include "core/shading_choices.h"
#include "core/vec3.h"

namespace whit::reference {

// With eta = n2 / n1 and c the cosine of the incident ray to the normal on its side,
// g = sqrt(eta^2 - 1 + c^2) is eta times the cosine of the refracted ray (Cook and Torrance 1982,
// "A reflectance model for computer graphics"). Everything is written in k = eta^2 - 1, which is
// found as a product instead of a difference of nearly equal squares.
struct Interface {
  double eta = 1;
  double k = 0;            // eta^2 - 1; exactly 0 where the indices are equal
  double g = 0;            // 0 where reflection is total
  double reflectance = 0;  // mean of both polarisations; what is not reflected is refracted
};

// c in [0, 1]. Equal indices reflect nothing at any angle; at or beyond the critical angle, and
// along the surface (c = 0), everything is reflected. `model` is about the reflectance alone.
Interface makeInterface(double n1, double n2, double c, FresnelModel model = FresnelModel::exact);

// Unit direction behind the interface of a ray along the unit direction `d`, which meets the unit
// normal `n` (on the ray's side) at cosine c. Not for total reflection. Exactly `d` where k = 0.
Vec3d refract(const Interface& interface, const Vec3d& d, const Vec3d& n, double c);

// Unit direction mirrored at the unit normal `n`.
Vec3d reflect(const Vec3d& d, const Vec3d& n);

// Schlick's (1 - c)^5 (1994, "An inexpensive BRDF model for physically-based rendering").
double schlickTerm(double c);

}  // namespace whit::reference
