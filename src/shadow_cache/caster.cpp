#include "shadow_cache/caster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stages/caster_rounding.h"

namespace whit {

LightPoint LightPoint::of(const Light& light) {
  if (light.kind == Light::Kind::directional) {
    return {Vec3d(Vec3f(whit::towards(light, {}))), true};
  }
  return {Vec3d(light.position), false};
}

// The largest errors by rounding, for rays whose starts have been moved as well.
struct Caster::Bounds {
  double away = 0;  // of the farthest vertex from a ray's start
  double way = 0;   // the longest way to the light
  std::array<double, 3> edge{};
  double largestEdge = 0;
  double slope = 0, height = 0;
};

Caster::Caster(const TriangleRecord& record, const LightPoint& light) : light_(light) {
  for (std::size_t i = 0; i < 3; ++i) {
    const float* p = record.position + 3 * i;
    corner_[i] = Vec3d(Vec3f{p[0], p[1], p[2]});
  }
  normal_ = cross(corner_[1] - corner_[0], corner_[2] - corner_[0]);
  area2_ = length(normal_);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d &p = corner_[i], &q = corner_[(i + 1) % 3];
    edgeLength_[i] = length(q - p);
    longest_ = std::max(longest_, edgeLength_[i]);
    const Vec3d& l = light.position;
    edges_[i] = light.directional ? Linear{p, cross(q - p, l)} : Linear{l, cross(p - l, q - l)};
    gradient_[i] = length(edges_[i].gradient);
  }
  toLight_ = light.directional ? 1 : length(corner_[0] - light.position);
  lightHeight_ =
      light.directional ? -dot(light.position, normal_) : dot(corner_[0] - light.position, normal_);
}

Caster::Range Caster::over(const Receiver& receiver, const Linear& number) {
  Range range{number.at(receiver.corners[0]), number.at(receiver.corners[0])};
  for (std::size_t i = 1; i < receiver.count; ++i) {
    const double value = number.at(receiver.corners[i]);
    range.least = std::min(range.least, value);
    range.most = std::max(range.most, value);
  }
  return range;
}

Caster::Range Caster::slope(const Receiver& receiver) const {
  if (light_.directional) return {-lightHeight_, -lightHeight_};
  return over(receiver, {light_.position, normal_});
}

double Caster::farthest(const Receiver& receiver) const {
  const Vec3d way = light_.towards(receiver.center);
  const double aside = length(cross(corner_[0] - receiver.center, way));
  const double spread = receiver.radius + receiver.reach;
  return aside + spread * toLight_ + longest_ * (length(way) + (light_.directional ? 0 : spread));
}

Caster::Bounds Caster::boundsFor(const Receiver& receiver) const {
  Bounds b;
  const double spread = receiver.radius + receiver.reach;
  b.away = length(corner_[0] - receiver.center) + longest_ + spread;
  b.way = light_.directional ? 1 : length(light_.position - receiver.center) + spread;
  const double unit = kRoundings * kHalfUlp, aside = 2 * farthest(receiver);
  for (std::size_t i = 0; i < 3; ++i) {
    b.edge[i] = unit * b.away * (edgeLength_[i] * b.way + aside) + gradient_[i] * receiver.reach +
                kFlushed * (1 + b.way);
    b.largestEdge = std::max(b.largestEdge, b.edge[i]);
  }
  const double turned = unit * (area2_ + longest_ * b.away);
  b.slope =
      turned * b.way + (light_.directional ? 0 : area2_ * receiver.reach) + kFlushed * (1 + b.way);
  b.height = turned * b.away + area2_ * receiver.reach + kFlushed * (1 + b.away);
  return b;
}

Meeting Caster::meet(const Receiver& receiver) const {
  const Bounds bounds = boundsFor(receiver);
  const Range heights = over(receiver, {corner_[0], normal_}), slopes = slope(receiver);
  // Rays that start on the side of its plane where the light is.
  const double lightBound = bounds.height + bounds.slope;
  if (heights.above(bounds.height) && lightHeight_ > lightBound) return Meeting::never;
  if (heights.below(bounds.height) && lightHeight_ < -lightBound) return Meeting::never;

  const bool known = slopes.awayFrom(bounds.slope);
  const double sign = slopes.least > 0 ? 1 : -1;
  const double slopeSize = std::max(std::fabs(slopes.least), std::fabs(slopes.most));
  const double zero = kEdgeTolerance * slopeSize + bounds.slope * kEdgeTolerance;
  const double leastSlope =
      std::min(std::fabs(slopes.least), std::fabs(slopes.most)) - bounds.slope;
  bool positive = known && sign > 0 && leastSlope > 3 * (bounds.largestEdge + zero);
  bool negative = known && sign < 0 && leastSlope > 3 * (bounds.largestEdge + zero);
  bool anyAbove = false, anyBelow = false;
  int inside = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Range range = over(receiver, edges_[i]);
    const bool above = range.above(bounds.edge[i] + zero);
    const bool below = range.below(bounds.edge[i] + zero);
    anyAbove = anyAbove || above;
    anyBelow = anyBelow || below;
    if (known && (sign > 0 ? above : below)) ++inside;
  }
  positive = positive || anyAbove;
  negative = negative || anyBelow;
  if ((anyBelow && positive) || (anyAbove && negative)) return Meeting::never;

  if (inside == 3) {
    const bool ahead = sign > 0 ? heights.above(bounds.height) : heights.below(bounds.height);
    const double end = lightBound + 0x1p-19 * slopeSize;
    const bool before = light_.directional || -lightHeight_ * sign > end;
    if (ahead && before) return Meeting::always;
  }
  return Meeting::unsure;
}

// Told by the triangle as rounding may have moved it (by `turned` from its plane, where the light
// is): rays that cross its plane outside of it do so at a distance x or more, where the least of
// the edge functions is below zero by cosine * lowest / 2 * x or more.
double Caster::influence(double distance) const {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  if (!(area2_ > 0)) return kNowhere;
  const double lowest = area2_ / longest_;  // height over the longest edge
  const double unit = kRoundings * kHalfUlp * distance;
  const double toLight = toLight_ + (light_.directional ? 0 : longest_);
  const double away = std::fabs(lightHeight_) / area2_;
  const double turned = unit * ((light_.directional ? 0 : 1) + toLight / lowest);
  if (!(away > 2 * turned)) return kNowhere;
  // The point may be as far from the triangle as the light is.
  const double cosine = away / 2 / (light_.directional ? 1 : 2 * toLight);
  const double gained = cosine * lowest / 2 - 2 * unit;
  if (!(gained > 0)) return kNowhere;
  const double influence = 2 * (3 * unit * longest_ / gained);
  return light_.directional || influence < toLight ? influence : kNowhere;
}

}  // namespace whit
