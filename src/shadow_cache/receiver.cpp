#include "shadow_cache/receiver.h"

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

}  // namespace whit
