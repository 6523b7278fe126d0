#include "verdicts/shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace whit {

void BoxBlock::set(std::size_t i, const Box& box) {
  constexpr float kOutwards = 1 + 0x1p-22f;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis], upper = box.upper[axis];
    const auto middle = static_cast<float>((lower + upper) / 2);
    center[axis][i] = middle;
    half[axis][i] = static_cast<float>(std::max(upper - middle, middle - lower)) * kOutwards;
  }
}

Shaft::Shaft(const Receiver& receiver, const LightPoint& light, double length)
    : lower_(receiver.corners[0]), upper_(receiver.corners[0]), reach_(receiver.reach) {
  const auto include = [this](const Vec3d& p) {
    lower_ = min(lower_, p);
    upper_ = max(upper_, p);
  };
  for (std::size_t i = 0; i < receiver.count; ++i) {
    include(receiver.corners[i]);
    if (light.directional) include(receiver.corners[i] + light.position * length);
  }
  if (!light.directional) include(light.position);
  lower_ = lower_ - Vec3d(reach_);
  upper_ = upper_ + Vec3d(reach_);
  for (std::size_t i = 0; i < receiver.count; ++i) {
    const Vec3d &p = receiver.corners[i], &q = receiver.corners[(i + 1) % receiver.count];
    addPlane(cross(q - p, light.towards(p)), p, receiver.center);
  }
  const Vec3d& p = receiver.corners[0];
  const Vec3d up = cross(receiver.corners[1] - p, receiver.corners[2] - p);
  addPlane(up, p, p + light.towards(p));
  roundPlanes();
}

void Shaft::roundPlanes() {
  const auto rounded = [](double x) { return static_cast<float>(x); };
  // The sums below are off by no more than this part of the largest number in them, which is no
  // larger than where a box must lie to be passed by.
  constexpr double kRounding = 0x1p-20;
  for (int axis = 0; axis < 3; ++axis) {
    middle_[static_cast<std::size_t>(axis)] = rounded((lower_[axis] + upper_[axis]) / 2);
    width_[static_cast<std::size_t>(axis)] = rounded((upper_[axis] - lower_[axis]) / 2);
  }
  const Vec3d largest = max(abs(lower_), abs(upper_));
  const double margin = kRounding * (largest.x + largest.y + largest.z);
  for (float& width : width_) width += rounded(margin);
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& [outward, size, offset] = planes_[i];
    rounded_[i] = {{rounded(outward.x), rounded(outward.y), rounded(outward.z)},
                   {rounded(size.x), rounded(size.y), rounded(size.z)},
                   rounded(offset + margin)};
  }
}

// A sum's rounding grows with the boxes' own distance from the origin.
unsigned Shaft::meets(const BoxBlock& boxes) const {
  constexpr float kRounding = 0x1p-20f;
  constexpr std::size_t n = BoxBlock::kBoxes;
  const auto& [x, y, z] = boxes.center;
  const auto& [hx, hy, hz] = boxes.half;
  float far[n], size[n];
  for (std::size_t k = 0; k < n; ++k) {
    size[k] =
        kRounding * (std::fabs(x[k]) + std::fabs(y[k]) + std::fabs(z[k]) + hx[k] + hy[k] + hz[k]);
    const float a = std::fabs(x[k] - middle_[0]) - hx[k] - width_[0];
    const float b = std::fabs(y[k] - middle_[1]) - hy[k] - width_[1];
    const float c = std::fabs(z[k] - middle_[2]) - hz[k] - width_[2];
    far[k] = std::max(a, std::max(b, c));
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& [outward, extent, offset] = rounded_[i];
    for (std::size_t k = 0; k < n; ++k) {
      const float away = outward[0] * x[k] + outward[1] * y[k] + outward[2] * z[k] -
                         (extent[0] * hx[k] + extent[1] * hy[k] + extent[2] * hz[k]) - offset;
      far[k] = std::max(far[k], away);
    }
  }
  unsigned met = 0;
  for (std::size_t k = 0; k < n; ++k) met |= (far[k] > size[k] ? 0u : 1u) << k;
  return met;
}

void Shaft::addPlane(const Vec3d& normal, const Vec3d& through, const Vec3d& inside) {
  const double size = length(normal);
  if (!(size > 0)) return;
  const Vec3d unit = normal / size;
  const double side = dot(inside - through, unit);
  // A plane that all of the shaft lies in bounds it on neither side.
  if (!(std::fabs(side) > 4 * reach_)) return;
  const Vec3d outward = side > 0 ? -unit : unit;
  planes_[count_++] = {outward, abs(outward), dot(outward, through) + reach_};
}

bool Shaft::misses(const Box& box) const {
  const Vec3d lower(box.lower), upper(box.upper);
  if (lower.x > upper_.x || lower.y > upper_.y || lower.z > upper_.z || upper.x < lower_.x ||
      upper.y < lower_.y || upper.z < lower_.z) {
    return true;
  }
  const Vec3d center = (lower + upper) * 0.5, half = (upper - lower) * 0.5;
  for (std::size_t i = 0; i < count_; ++i) {
    const Plane& plane = planes_[i];
    if (dot(plane.outward, center) - dot(plane.size, half) > plane.offset) return true;
  }
  return false;
}

bool Shaft::misses(const TriangleRecord& triangle, double distance) const {
  const float* p = triangle.position;
  const Vec3d a{p[0], p[1], p[2]}, b{p[3], p[4], p[5]}, c{p[6], p[7], p[8]};
  const Vec3d lower = min(a, min(b, c)), upper = max(a, max(b, c));
  if (lower.x - distance > upper_.x || lower.y - distance > upper_.y ||
      lower.z - distance > upper_.z || upper.x + distance < lower_.x ||
      upper.y + distance < lower_.y || upper.z + distance < lower_.z) {
    return true;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const Plane& plane = planes_[i];
    const double bound = plane.offset + distance;
    if (dot(plane.outward, a) > bound && dot(plane.outward, b) > bound &&
        dot(plane.outward, c) > bound) {
      return true;
    }
  }
  return false;
}

}  // namespace whit
