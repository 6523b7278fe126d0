#include "shadow_cache/shaft.h"

#include <algorithm>
#include <cmath>

namespace whit {

void setBox(simd::BoxBlock& block, std::size_t i, const Box& box) {
  constexpr float kOutwards = 1 + 0x1p-22f;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis], upper = box.upper[axis];
    const auto middle = static_cast<float>((lower + upper) / 2);
    block.center[axis][i] = middle;
    block.half[axis][i] = static_cast<float>(std::max(upper - middle, middle - lower)) * kOutwards;
  }
}

LightPoint LightPoint::of(const Light& light) {
  if (light.kind == Light::Kind::directional) {
    return {Vec3d(Vec3f(whit::towards(light, {}))), true};
  }
  return {Vec3d(light.position), false};
}

Shaft::Shaft(const Receiver& receiver, const LightPoint& light, double length)
    : reach_(receiver.reach) {
  Vec3d &lower = sides_.lower, &upper = sides_.upper;
  lower = upper = receiver.corners[0];
  const auto include = [&](const Vec3d& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  };
  for (std::size_t i = 0; i < receiver.count; ++i) {
    include(receiver.corners[i]);
    if (light.directional) include(receiver.corners[i] + light.position * length);
  }
  if (!light.directional) include(light.position);
  lower = lower - Vec3d(reach_);
  upper = upper + Vec3d(reach_);
  for (std::size_t i = 0; i < receiver.count; ++i) {
    const Vec3d &p = receiver.corners[i], &q = receiver.corners[(i + 1) % receiver.count];
    addPlane(cross(q - p, light.towards(p)), p, receiver.center);
  }
  const Vec3d& p = receiver.corners[0];
  const Vec3d up = cross(receiver.corners[1] - p, receiver.corners[2] - p);
  addPlane(up, p, p + light.towards(p));
}

simd::RoundedShaft Shaft::rounded() const {
  const auto near = [](double x) { return static_cast<float>(x); };
  // The kernel's sums are off by no more than this part of the largest number in them, which is no
  // larger than where a box must lie to be passed by.
  constexpr double kRounding = 0x1p-20;
  simd::RoundedShaft shaft;
  const Vec3d largest = max(abs(sides_.lower), abs(sides_.upper));
  const double margin = kRounding * (largest.x + largest.y + largest.z);
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = sides_.lower[axis], upper = sides_.upper[axis];
    shaft.middle[axis] = near((lower + upper) / 2);
    shaft.width[axis] = near((upper - lower) / 2) + near(margin);
  }
  shaft.count = sides_.count;
  for (std::size_t i = 0; i < sides_.count; ++i) {
    const auto& [outward, offset] = sides_.planes[i];
    for (int axis = 0; axis < 3; ++axis) {
      shaft.outward[i][axis] = near(outward[axis]);
      shaft.size[i][axis] = near(std::fabs(outward[axis]));
    }
    shaft.offset[i] = near(offset + margin);
  }
  return shaft;
}

void Shaft::addPlane(const Vec3d& normal, const Vec3d& through, const Vec3d& inside) {
  const double size = length(normal);
  if (!(size > 0)) return;
  const Vec3d unit = normal / size;
  const double side = dot(inside - through, unit);
  // A plane that all of the shaft lies in bounds it on neither side.
  if (!(std::fabs(side) > 4 * reach_)) return;
  const Vec3d outward = side > 0 ? -unit : unit;
  sides_.planes[sides_.count++] = {outward, dot(outward, through) + reach_};
}

bool Shaft::misses(const Box& box) const {
  const Vec3d lower(box.lower), upper(box.upper);
  if (lower.x > sides_.upper.x || lower.y > sides_.upper.y || lower.z > sides_.upper.z ||
      upper.x < sides_.lower.x || upper.y < sides_.lower.y || upper.z < sides_.lower.z) {
    return true;
  }
  const Vec3d center = (lower + upper) * 0.5, half = (upper - lower) * 0.5;
  for (std::size_t i = 0; i < sides_.count; ++i) {
    const auto& plane = sides_.planes[i];
    if (dot(plane.outward, center) - dot(abs(plane.outward), half) > plane.offset) return true;
  }
  return false;
}

}  // namespace whit
