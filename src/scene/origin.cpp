#include "scene/origin.h"

#include <algorithm>
#include <cmath>

namespace whit {

Vec3d originOf(const BoxOf<Vec3d>& box) {
  // A box of coordinates that were rounded already may be too small by twice this.
  constexpr double kRounding = 0x1p-23;
  constexpr double kStepOverSize = 0.25;

  const Vec3d middle = box.center();
  const double size = std::max(box.diagonal(), 2 * kRounding * length(middle));
  const double step = std::exp2(std::floor(std::log2(kStepOverSize * size)));
  if (box.empty() || !std::isnormal(step)) return {};

  Vec3d origin;
  for (int axis = 0; axis < 3; ++axis) {
    const bool isFar = std::abs(middle[axis]) > kFarOverSize * size;
    if (isFar) origin[axis] = std::round(middle[axis] / step) * step;
  }
  return isFinite(origin) ? origin : Vec3d();
}

}  // namespace whit
