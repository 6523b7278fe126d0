// Fresnel's and Snell's laws at a smooth dielectric interface, in a form that keeps its precision
// where the two refractive indices are close or equal.
#pragma once

#include <cmath>

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

// Schlick's (1 - c)^5 (1994, "An inexpensive BRDF model for physically-based rendering").
inline double schlickTerm(double c) {
  const double m = 1 - c;
  return m * m * m * m * m;
}

// c in [0, 1]. Equal indices reflect nothing at any angle; at or beyond the critical angle, and
// along the surface (c = 0), everything is reflected. `model` is about the reflectance alone.
inline Interface makeInterface(double n1, double n2, double c,
                               FresnelModel model = FresnelModel::exact) {
  Interface interface;
  interface.eta = n2 / n1;
  interface.k = (n2 - n1) * (n2 + n1) / (n1 * n1);
  if (interface.k == 0) {
    interface.g = c;
    return interface;
  }

  // Beyond the critical angle reflection is total.
  const double g2 = interface.k + c * c;
  if (g2 <= 0 || c == 0) {
    interface.reflectance = 1;
    return interface;
  }

  const double g = std::sqrt(g2);
  interface.g = g;
  if (model == FresnelModel::schlick) {
    const double normal = (n2 - n1) / (n2 + n1), f0 = normal * normal;
    // Schlick's term takes the smaller of the two cosines, which is the refracted ray's where the
    // ray leaves the denser medium; otherwise total reflection would start with a jump.
    interface.reflectance = f0 + (1 - f0) * schlickTerm(n2 < n1 ? g / interface.eta : c);
    return interface;
  }

  // The amplitudes are Fresnel's for both polarisations, with differences written in k.
  const double perpendicular = -interface.k / ((c + g) * (c + g));
  const double parallel = interface.k * (c - 1 / (c + g)) / (interface.eta * interface.eta * c + g);
  interface.reflectance = (perpendicular * perpendicular + parallel * parallel) / 2;
  return interface;
}

// Returns the unit direction behind the interface of a ray along the unit direction `d`, whose
// cosine to the unit normal `n` on its side is c; exactly `d` where k = 0. Reflection must not be
// total.
inline Vec3d refract(const Interface& interface, const Vec3d& d, const Vec3d& n, double c) {
  if (interface.k == 0) return d;
  return normalized((d - n * (interface.k / (c + interface.g))) / interface.eta);
}

// Returns the unit direction `d` mirrored at the unit normal `n`.
inline Vec3d reflect(const Vec3d& d, const Vec3d& n) { return normalized(d - n * (2 * dot(d, n))); }

}  // namespace whit::reference
