#include "render/enclosure.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

// Points of a Fibonacci lattice on the sphere: none lies in a plane of symmetry that a model is
// likely to have.
Vec3f latticeDirection(int i, int n) {
  constexpr double kGoldenAngle = 2.399963229728653;
  const double y = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - y * y), turn = kGoldenAngle * i + 0.3;
  return Vec3f(Vec3d{r * std::cos(turn), y, r * std::sin(turn)});
}

bool moves(const Scene& scene, std::uint32_t camera) {
  const std::vector<MovingCamera>& moving = scene.motion.given.cameras;
  return std::any_of(moving.begin(), moving.end(),
                     [&](const MovingCamera& m) { return m.camera == camera; });
}

}  // namespace

bool isEnclosed(const Accel& accel, const Vec3f& eye) {
  constexpr int kDirections = 256;
  for (int i = 0; i < kDirections; ++i) {
    if (!accel.closest(eye, latticeDirection(i, kDirections)).found()) return false;
  }
  return true;
}

bool isEnclosed(const Scene& scene, const Accel& accel) {
  for (std::uint32_t i = 0; i < scene.cameras.size(); ++i) {
    if (!moves(scene, i) && !isEnclosed(accel, scene.cameras[i].eye)) return false;
  }
  for (const Keyframe& key : scene.cameraPath) {
    if (!isEnclosed(accel, key.camera.eye)) return false;
  }
  return true;
}

}  // namespace whit
