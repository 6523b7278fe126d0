#pragma once

#include <cmath>

namespace whit::test {

// Fresnel's reflectance without polarization by Snell's law and the two amplitudes, as textbooks
// have them.
template <typename Real>
Real fresnelOf(Real n1, Real n2, Real c) {
  const Real sine2 = (1 - c) * (1 + c) * n1 * n1 / (n2 * n2);
  if (sine2 >= 1) return 1;
  const Real behind = std::sqrt(1 - sine2);
  const Real s = (n1 * c - n2 * behind) / (n1 * c + n2 * behind);
  const Real p = (n1 * behind - n2 * c) / (n1 * behind + n2 * c);
  return (s * s + p * p) / 2;
}

}  // namespace whit::test
