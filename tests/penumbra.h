// The penumbra of a straight edge under a light that is a sphere, integrated over the sphere's
// surface: an oracle that shares no code with what it is compared with.
#pragma once

#include <cmath>

#include "pi.h"

namespace whit::test {

// A floor at y = 0 that scatters `albedo` of the light, under a sphere of intensity `intensity` at
// (0, height, 0), of `radius`; between them, at y = `edge`, a screen that covers all x < 0.
struct Penumbra {
  double albedo = 0.5, intensity = 30, height = 4, radius = 0.8, edge = 1.5;
  bool screen = true;

  // Radiance of the floor at x: the sphere has radiance I / (pi r^2) in all directions, and an
  // element dA of it, seen at an angle phi to its normal from a distance t, fills dA cos(phi) /
  // t^2.
  double radianceAt(double x) const {
    constexpr int kSteps = 900;
    const double emitted = intensity / (kPi * radius * radius);
    double irradiance = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double ny = -1 + (i + 0.5) * 2 / kSteps, ring = std::sqrt(1 - ny * ny);
      for (int j = 0; j < kSteps; ++j) {
        const double turn = (j + 0.5) * 2 * kPi / kSteps;
        const double nx = ring * std::cos(turn), nz = ring * std::sin(turn);
        const double dx = radius * nx - x, dy = height + radius * ny, dz = radius * nz;
        const double t2 = dx * dx + dy * dy + dz * dz, t = std::sqrt(t2);

        const double facing = -(dx * nx + dy * ny + dz * nz) / t;
        const double crossing = x + dx * edge / dy;  // x where the line crosses the screen's height
        if (facing <= 0 || (screen && crossing < 0)) continue;
        irradiance += facing * (dy / t) / t2;
      }
    }

    const double element = radius * radius * 4 * kPi / (double{kSteps} * kSteps);
    return albedo / kPi * emitted * irradiance * element;
  }
  // Radiance of the floor at x without the screen. A sphere that is wholly visible acts as if its
  // intensity were at its center.
  double unshadowedAt(double x) const {
    const double d2 = x * x + height * height;
    return albedo / kPi * intensity * height / (d2 * std::sqrt(d2));
  }
};

}  // namespace whit::test
