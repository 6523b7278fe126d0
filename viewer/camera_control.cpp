#include "viewer/camera_control.h"

#include <algorithm>
#include <cmath>

namespace whit::view {

double cruisingSpeed(const Scene& scene) {
  constexpr double kSeconds = 12, kLeast = 1e-3;
  const double size = length(Vec3d(scene.upper) - Vec3d(scene.lower));
  return std::isfinite(size) ? std::max(size / kSeconds, kLeast) : 1;
}

void CameraControl::set(const Camera& camera) {
  camera_ = camera;
  const CameraFrame frame = makeCameraFrame(camera, 1, 1);
  eye_ = frame.eye;
  up_ = normalized(Vec3d(camera.up), Vec3d{0, 1, 0});
  const Vec3d across = normalized(frame.right);
  right_ = normalized(across - up_ * dot(across, up_), across);
  elevation_ = std::asin(std::clamp(dot(frame.forward, up_), -1.0, 1.0));
  const double distance = length(Vec3d(camera.at) - eye_);
  distance_ = distance > 0 && std::isfinite(distance) ? distance : 1;
}

Vec3d CameraControl::forward() const {
  return cross(up_, right_) * std::cos(elevation_) + up_ * std::sin(elevation_);
}

void CameraControl::turn(double rightwards, double upwards) {
  right_ = normalized(right_ * std::cos(rightwards) - cross(up_, right_) * std::sin(rightwards));
  // A view that began steeper may stay so.
  elevation_ = std::clamp(elevation_ + upwards, std::min(-kSteepestRadians, elevation_),
                          std::max(kSteepestRadians, elevation_));
}

void CameraControl::writeCamera() {
  camera_.eye = Vec3f(eye_);
  camera_.at = Vec3f(eye_ + forward() * distance_);
}

bool CameraControl::step(const CameraMotion& m, double seconds) {
  speed_ = std::clamp(speed_ * std::pow(kWheelFactor, m.wheel), firstSpeed_ / kSpeedRange,
                      firstSpeed_ * kSpeedRange);
  const double arrows = kRadiansPerSecond * seconds;
  const double right = m.lookX * kRadiansPerPixel + m.turnRight * arrows;
  const double up = -m.lookY * kRadiansPerPixel + m.turnUp * arrows;
  const bool turns = right != 0 || up != 0;
  if (turns) turn(right, up);
  const bool orbits = m.orbitX != 0 || m.orbitY != 0;
  if (orbits) {
    const Vec3d center = eye_ + forward() * distance_;
    turn(m.orbitX * kRadiansPerPixel, -m.orbitY * kRadiansPerPixel);
    eye_ = center - forward() * distance_;
  }
  const Vec3d direction =
      normalized(forward() * m.forward + right_ * m.right + up_ * m.up);  // zero when at rest
  const Vec3d there = eye_ + direction * (speed_ * seconds * (m.fast ? kFastFactor : 1));
  const bool moves = direction != Vec3d() && seconds > 0 &&
                     maxComponent(abs(there)) + distance_ < static_cast<double>(kLargestCoordinate);
  if (moves) eye_ = there;
  if (!turns && !orbits && !moves) return false;
  writeCamera();
  return true;
}

}  // namespace whit::view
