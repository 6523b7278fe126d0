// Exact spheres for the hard cases. The chord of a ray through a sphere is computed in long double,
// by formulas of its own, from the very floats that the scene and the ray hold.
#pragma once

#include "bake/sphere.h"
#include "verify/bodies.h"

namespace whit::verify {

using Vec3l = Vec3<long double>;

// Unit round-off of float.
inline constexpr double kBallRounding = 0x1p-24;

// Upper bound, in radii, on how far the rounding of a hit's weights moves its point along the
// sphere. The weights are below 5/16 and off by 2^-26, the coordinates in the octahedral square by
// 8 times that. The point of the octahedron is off by sqrt(6) times as much, because its height
// follows from both coordinates, and it is no nearer to the center than 1 / sqrt(3).
inline constexpr double kWeightAngle = 4.2426406871192857 * 0x1p-23;

// The intersection of a line with a sphere: the distance of the line from the center, in radii, and
// the ends of the chord, in lengths of the direction. Both ends are NaN when the line misses.
struct BallChord {
  long double aside = 0, near = 0, far = 0;

  // The end that a ray hits, which is negative if both are behind it.
  long double ahead() const { return near > 0 ? near : far; }
};

inline BallChord chordOf(const Vec3l& fromCenter, const Vec3l& direction, long double radius) {
  const long double squared = dot(direction, direction);
  const Vec3l across = cross(fromCenter, direction);
  const long double aside = std::sqrt(dot(across, across) / squared) / radius;
  const long double middle = -dot(fromCenter, direction) / squared;
  const long double half = radius * std::sqrt((1 - aside) * (1 + aside) / squared);
  return {aside, middle - half, middle + half};
}

struct Ball {
  Vec3f center;
  float radius = 1;

  double r() const { return radius; }
  // The point at this distance from the center, which is given in radii.
  Vec3d point(const Vec3d& direction, double radii) const {
    return Vec3d(center) + direction * (radii * r());
  }
  Mesh mesh(std::uint32_t material = 0) const {
    return exactSphere(material, Affine::translation(Vec3d(center)) * Affine::scaling(Vec3d(r())));
  }
  Scene scene(const Material& material) const { return sceneOf(mesh(), material); }

  BallChord chord(const ProbeRay& ray) const {
    return chordOf(Vec3l(ray.origin) - Vec3l(center), Vec3l(ray.direction), radius);
  }
  double aside(const ProbeRay& ray) const { return double(chord(ray).aside); }
  double heightOf(const Vec3f& position) const {
    return double(length(Vec3l(position) - Vec3l(center)) - radius);
  }
  // Upper bound on the height of a hit's position: the length of the unit vector is off by four and
  // a half roundings (three products, root, quotient, product), the radius by one, the sum with the
  // center by one of the sum.
  double heightError() const { return kBallRounding * (6.5 * r() + length(Vec3d(center))); }
};

inline std::string textOf(const Ball& ball) {
  return "radius " + textOf(ball.r()) + " about " + textOf(ball.center) + ", ";
}

inline bool enters(const Probe& probe, std::size_t i) {
  return (probe.surfels().flags[i] & kEntering) != 0;
}

inline Vec3d across(const Vec3d& d, Numbers& numbers) {
  return normalized(cross(d, numbers.direction()));
}

// Radii from 1e-6 to 1e6, each at these distances from the origin, in radii.
inline std::vector<Ball> ballsOfAllSizes(std::initializer_list<double> distances) {
  std::vector<Ball> balls;
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double away : distances) {
      balls.push_back({Vec3f(Vec3d{0.6, -0.64, 0.48} * (away * radius)), float(radius)});
    }
  }
  return balls;
}

}  // namespace whit::verify
