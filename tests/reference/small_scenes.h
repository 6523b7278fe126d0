// Scenes of a few polygons, and rays through them.
#pragma once

#include "brute_force.h"
#include "pi.h"
#include "reference/reference.h"
#include "verify/scene_builder.h"

namespace whit::test {

using namespace verify;

// Returns a direction downwards, at an angle to the vertical.
inline Vec3d steep(double degrees) {
  const double angle = degrees * kPi / 180;
  return {std::sin(angle), -std::cos(angle), 0};
}

inline Light sun(const Vec3f& direction, float irradiance) {
  Light light;
  light.kind = Light::Kind::directional;
  light.direction = direction;
  light.intensity = Rgb(irradiance);
  return light;
}

// Returns settings of depth 8 without a cutoff, so that all contributions count.
inline reference::Settings uncut(int depth = 8) {
  reference::Settings settings;
  settings.options.depth = depth;
  settings.options.cutoff = 0;
  return settings;
}

// Returns the radiance that the reference computes along a ray by brute force. `direction` has any
// length.
inline RgbD radianceAlong(const Scene& scene, const Vec3d& origin, const Vec3d& direction,
                          const reference::Settings& settings = uncut(),
                          reference::RayCounts* counts = nullptr) {
  const reference::BruteForce bruteForce(scene, settings.effects);
  const reference::Tracer tracer(scene, bruteForce, settings);
  reference::RayCounts own;
  return tracer.traceImpulse({origin, normalized(direction)}, 0, 1.0, 0, counts ? *counts : own);
}

}  // namespace whit::test
