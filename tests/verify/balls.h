// Exact spheres for the hard cases, and where rays meet them: in long double, by formulas of their
// own, from the very floats that the scene and the ray hold.
#pragma once

#include "bake/sphere.h"
#include "verify/bodies.h"

namespace whit::verify {

using Vec3l = Vec3<long double>;

struct Ball {
  Vec3f center;
  float radius = 1;
};

inline Mesh mappedSphere(const Affine& map, std::uint32_t material) {
  Mesh mesh;
  mesh.spheres = {map};
  mesh.materials = {material};
  return mesh;
}
inline Mesh exactBall(const Ball& ball, std::uint32_t material) {
  Affine map = Affine::scaling(Vec3d(double{ball.radius}));
  map.p = Vec3d(ball.center);
  return mappedSphere(map, material);
}
inline Scene sceneOfBall(const Ball& ball, const Material& material) {
  return sceneOf(exactBall(ball, 0), material);
}

// What a line has of a sphere: how far it passes the center, in radii, and where it is in it, in
// lengths of its direction. Both ends are NaN where it passes by.
struct BallChord {
  long double aside = 0, near = 0, far = 0;
};

inline BallChord chordOf(const Vec3l& fromCenter, const Vec3l& direction, long double radius) {
  const long double squared = dot(direction, direction);
  const Vec3l across = cross(fromCenter, direction);
  const long double aside = std::sqrt(dot(across, across) / squared) / radius;
  const long double middle = -dot(fromCenter, direction) / squared;
  const long double half = radius * std::sqrt((1 - aside) * (1 + aside) / squared);
  return {aside, middle - half, middle + half};
}
inline BallChord chordOf(const Ball& ball, const ProbeRay& ray) {
  return chordOf(Vec3l(ray.origin) - Vec3l(ball.center), Vec3l(ray.direction),
                 static_cast<long double>(ball.radius));
}

// Unit round-off of float.
inline constexpr double kBallRounding = 0x1p-24;

// By so many radii a hit's weights, which are floats, move its point along the sphere at the most.
// They are below 5/16 and off by 2^-26, the coordinates in the octahedral square by 8 times that.
// The point of the octahedron is off by sqrt(6) times as much, for its height follows from both,
// and it is no nearer to the center than 1 / sqrt(3).
inline constexpr double kWeightAngle = 4.2426406871192857 * 0x1p-23;

// By so much the position may be off the sphere: the length of the unit vector by four and a half
// roundings (three products, root, quotient, product), the radius by one, the sum with the center
// by one of the whole.
inline double ballHeightError(const Ball& ball) {
  const auto radius = static_cast<double>(ball.radius);
  return kBallRounding * (6.5 * radius + length(Vec3d(ball.center)));
}

inline double heightOver(const Ball& ball, const Vec3f& position) {
  const Vec3l from = Vec3l(position) - Vec3l(ball.center);
  return static_cast<double>(std::sqrt(dot(from, from)) - static_cast<long double>(ball.radius));
}

inline bool enters(const Probe& probe, std::size_t i) {
  return (probe.surfels().flags[i] & kEntering) != 0;
}

inline bool isFiniteRay(const ProbeRay& ray) {
  return isFinite(ray.origin) && isFinite(ray.direction);
}

inline std::string describeBall(const Ball& ball, const ProbeRay& ray) {
  return "radius " + hexText(double{ball.radius}) + " about " + hexText(ball.center) + ", " +
         describeRay(ray);
}
inline auto describedOn(const Ball& ball, const ProbeRay& ray) {
  return [&ball, &ray] { return describeBall(ball, ray); };
}

// Radii from 1e-6 to 1e6, each at these distances from the origin, in radii.
inline std::vector<Ball> ballsOfAllSizes(std::initializer_list<double> distances) {
  std::vector<Ball> balls;
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double away : distances) {
      balls.push_back(
          {Vec3f(Vec3d{0.6, -0.64, 0.48} * (away * radius)), static_cast<float>(radius)});
    }
  }
  return balls;
}

}  // namespace whit::verify
