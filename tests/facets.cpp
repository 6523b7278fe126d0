#include "facets.h"

#include <cmath>

#include "pi.h"

namespace whit::test {

double albedoByFacets(double f0, double f90, double roughness, double nv) {
  constexpr int kSteps = 300;
  const double a2 = std::pow(roughness, 4), sine = std::sqrt(1 - nv * nv);
  const auto lambda = [&](double c) { return (std::sqrt(1 + a2 * (1 / (c * c) - 1)) - 1) / 2; };

  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps, nh = std::sqrt((1 - u) / (1 + (a2 - 1) * u));
    for (int k = 0; k < kSteps; ++k) {
      const double across = std::sqrt(1 - nh * nh) * std::cos(kPi * (k + 0.5) / kSteps);
      const double vh = sine * across + nv * nh, nl = 2 * vh * nh - nv;
      if (!(vh > 0 && nl > 0)) continue;

      const double fresnel = f0 + (f90 - f0) * std::pow(1 - vh, 5);
      sum += fresnel * vh / (nv * nh) / (1 + lambda(nl) + lambda(nv));
    }
  }
  return sum / (kSteps * kSteps);
}

}  // namespace whit::test
