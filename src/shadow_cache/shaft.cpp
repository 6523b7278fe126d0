#include "shadow_cache/shaft.h"

#include <algorithm>
#include <cmath>

#include "bake/facet.h"

namespace whit {

namespace {

// Weights are floats whose sum is rounded, and so is the rim that kernels hold them against.
constexpr double kRim = kShadowRim * (1 - 0x1p-6);
// Per axis to Euclidean, with what the kernel's own interpolation may be off.
constexpr double kReach = kCachedShadowReach * 1.7320508 * 1.5;
// A triangle is a sliver if twice its area is less than this share of its longest edge squared. Of
// 120 random scenes of needles, two had rays that met the triangle where they start, at a share of
// 0.00134; this is three times as much.
constexpr double kSliverArea = 0x1p-8;

struct Weights2 {
  double u = 0, v = 0;
};

struct Polygon {
  std::array<Weights2, Receiver::kMostCorners> corners;
  std::size_t count = 0;
};

// The part of the polygon that has a positive `distance`, which is linear.
template <typename Distance>
Polygon cut(const Polygon& polygon, const Distance& distance) {
  Polygon rest;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Weights2& a = polygon.corners[i];
    const Weights2& b = polygon.corners[(i + 1) % polygon.count];
    const double da = distance(a), db = distance(b);
    if (da >= 0) rest.corners[rest.count++] = a;
    if ((da >= 0) == (db >= 0)) continue;
    const double t = da / (da - db);
    rest.corners[rest.count++] = {a.u + (b.u - a.u) * t, a.v + (b.v - a.v) * t};
  }
  return rest;
}

}  // namespace

ReceivingTriangle::ReceivingTriangle(const TriangleRecord& record, int parts)
    : corner_(cornersOf(record, nullptr)), rim_(kRim / parts) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d extent = abs(corner_[i]);
    size_[i] = extent.x + extent.y + extent.z;
  }
  const Vec3d e1 = corner_[1] - corner_[0], e2 = corner_[2] - corner_[0];
  longest_ = std::max({length(e1), length(e2), length(e2 - e1)});
  sliver_ = !(length(cross(e1, e2)) > kSliverArea * longest_ * longest_);
}

Receiver ReceivingTriangle::piece(const WeightSquare& square) const {
  const double u1 = square.u + square.side, v1 = square.v + square.side;
  Polygon polygon{{{{square.u, square.v}, {u1, square.v}, {u1, v1}, {square.u, v1}}}, 4};
  if (1 - square.u - square.v - rim_ < 0) return {};
  if (square.u < rim_) polygon = cut(polygon, [this](const Weights2& w) { return w.u - rim_; });
  if (square.v < rim_) polygon = cut(polygon, [this](const Weights2& w) { return w.v - rim_; });
  if (1 - u1 - v1 - rim_ < 0) {
    polygon = cut(polygon, [this](const Weights2& w) { return 1 - w.u - w.v - rim_; });
  }
  Receiver receiver;
  double size = 0;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const auto [u, v] = polygon.corners[i];
    const double w = 1 - u - v;
    const Vec3d p = corner_[0] * w + corner_[1] * u + corner_[2] * v;
    receiver.add(p);
    receiver.center += p;
    size = std::max(size, size_[0] * w + size_[1] * u + size_[2] * v);
  }
  if (receiver.count == 0) return receiver;
  receiver.reach = kReach * size;
  receiver.center = receiver.center / static_cast<double>(receiver.count);
  double farthest2 = 0;
  for (std::size_t i = 0; i < receiver.count; ++i) {
    const Vec3d away = receiver.corners[i] - receiver.center;
    farthest2 = std::max(farthest2, dot(away, away));
  }
  receiver.radius = std::sqrt(farthest2);
  return receiver;
}

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
