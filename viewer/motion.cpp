#define GLFW_INCLUDE_NONE
#include "viewer/motion.h"

#include <GLFW/glfw3.h>

namespace whit::view {

double cruisingSpeed(const Scene& scene) {
  constexpr double kSeconds = 12, kLeast = 1e-3;
  const double size = length(Vec3d(scene.upper) - Vec3d(scene.lower));
  return std::isfinite(size) ? std::max(size / kSeconds, kLeast) : 1;
}

CameraMotion motionOf(const Input& input) {
  const auto axis = [&](int positive, int negative) {
    return static_cast<double>(input.isHeld(positive)) -
           static_cast<double>(input.isHeld(negative));
  };
  CameraMotion motion;
  motion.forward = axis(GLFW_KEY_W, GLFW_KEY_S);
  motion.right = axis(GLFW_KEY_D, GLFW_KEY_A);
  motion.up = axis(GLFW_KEY_E, GLFW_KEY_Q);
  motion.fast = input.isHeld(GLFW_KEY_LEFT_SHIFT) || input.isHeld(GLFW_KEY_RIGHT_SHIFT);
  motion.turnRight = axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT);
  motion.turnUp = axis(GLFW_KEY_UP, GLFW_KEY_DOWN);
  motion.lookX = input.lookX;
  motion.lookY = input.lookY;
  motion.orbitX = input.orbitX;
  motion.orbitY = input.orbitY;
  motion.wheel = input.wheel;
  return motion;
}

}  // namespace whit::view
