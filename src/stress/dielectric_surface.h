// The surface between two dielectrics, as the kernels have it and as the textbook does.
#pragma once

#include <vector>

#include "stress/probe.h"

namespace whit::stress {

// A surfel with both normals up, met by rays at given cosines.
struct Incidence {
  std::vector<ProbeRay> rays;
  std::vector<double> cosines;  // as the kernel sees them
};

Incidence raysAt(const std::vector<double>& cosines);

// What the kernels make of a dielectric: F from the reflected weight, or 0 where nothing is
// reflected; the refracted weight and direction, or 0.
struct Interfaces {
  std::vector<double> reflected, refracted;
  std::vector<Vec3d> direction;
};

// `from` is the index in front. The medium number 1 is in front where it is not the vacuum.
Interfaces throughKernels(float from, float to, const Incidence& incidence, const Setup& setup);

using Real = long double;
// Unpolarised reflectance in the textbook's form, in long double.
Real fresnel(Real n1, Real n2, Real c);

}  // namespace whit::stress
