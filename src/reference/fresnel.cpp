#include "reference/fresnel.h"

#include <cmath>

namespace whit::reference {

Interface makeInterface(double n1, double n2, double c, FresnelModel model) {
  Interface interface;
  interface.eta = n2 / n1;
  interface.k = (n2 - n1) * (n2 + n1) / (n1 * n1);
  if (interface.k == 0) {
    interface.g = c;
    return interface;
  }
  const double g2 = interface.k + c * c;
  if (g2 <= 0 || c == 0) {
    interface.reflectance = 1;
    return interface;
  }
  const double g = interface.g = std::sqrt(g2);
  if (model == FresnelModel::schlick) {
    const double normal = (n2 - n1) / (n2 + n1), f0 = normal * normal;
    // The refracted ray's cosine where that is the smaller one, or total reflection would not be
    // reached at the critical angle.
    interface.reflectance = f0 + (1 - f0) * schlickTerm(n2 < n1 ? g / interface.eta : c);
    return interface;
  }
  const double perpendicular = -interface.k / ((c + g) * (c + g));
  const double parallel = interface.k * (c - 1 / (c + g)) / (interface.eta * interface.eta * c + g);
  interface.reflectance = (perpendicular * perpendicular + parallel * parallel) / 2;
  return interface;
}

Vec3d refract(const Interface& interface, const Vec3d& d, const Vec3d& n, double c) {
  if (interface.k == 0) return d;
  return normalized((d - n * (interface.k / (c + interface.g))) / interface.eta);
}

Vec3d reflect(const Vec3d& d, const Vec3d& n) { return normalized(d - n * (2 * dot(d, n))); }

double schlickTerm(double c) {
  const double m = 1 - c;
  return m * m * m * m * m;
}

}  // namespace whit::reference
