#include "scene/origin.h"

#include <cmath>

namespace whit {

Vec3d originOf(const BoxOf<Vec3d>& box) {
  constexpr double kStepOverSize = 0.25;
  const double size = box.empty() ? 0 : box.diagonal();
  const double distance = length(box.center());
  const bool isFar = size > 0 && std::isfinite(distance) && distance > kFarOverSize * size;
  if (!isFar) return {};

  const double step = std::exp2(std::floor(std::log2(kStepOverSize * size)));
  Vec3d origin = box.center();
  for (int axis = 0; axis < 3; ++axis) origin[axis] = std::round(origin[axis] / step) * step;
  return origin;
}

}  // namespace whit
