// The scalar reference of the proofs in simd/meet_casters.h: one triangle and all shadow rays from
// a receiver to a light.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "shadow_cache/shaft.h"
#include "stages/shadow_cache_view.h"

namespace whit {

enum class Meeting {
  never,   // no ray meets the triangle
  always,  // every one does
  unsure
};

class Caster {
 public:
  Caster(const TriangleRecord& record, const LightPoint& light);

  Meeting meet(const Receiver& receiver) const;

 private:
  // A number linear in the ray's origin: (anchor - O) . gradient.
  struct Linear {
    Vec3d anchor, gradient;
    double at(const Vec3d& origin) const { return dot(anchor - origin, gradient); }
  };
  struct Range {
    double least = 0, most = 0;
    bool above(double bound) const { return least > bound; }
    bool below(double bound) const { return most < -bound; }
    bool awayFrom(double bound) const { return above(bound) || below(bound); }
  };
  static Range over(const Receiver& receiver, const Linear& number);
  // Towards the light from the receiver's corners, times the normal.
  Range slope(const Receiver& receiver) const;
  // An upper bound on the products of the corners' distances from the rays and the rays' lengths.
  double farthest(const Receiver& receiver) const;

  struct Bounds;
  Bounds boundsFor(const Receiver& receiver) const;

  LightPoint light_;
  std::array<Vec3d, 3> corner_;
  Vec3d normal_;  // twice the area long
  double longest_ = 0, area2_ = 0;
  std::array<Linear, 3> edges_;
  std::array<double, 3> edgeLength_{}, gradient_{};  // lengths
  double toLight_ = 0;                               // from corner 0; 1 for a directional light
  double lightHeight_ = 0;                           // (v0 - L) . N; of a directional light -D.N
};

// The largest errors by rounding, for rays whose starts have been moved as well.
struct Caster::Bounds {
  double away = 0;  // of the farthest vertex from a ray's start
  double way = 0;   // the longest way to the light
  std::array<double, 3> edge{};
  double largestEdge = 0;
  double slope = 0, height = 0;
};

inline Caster::Caster(const TriangleRecord& record, const LightPoint& light) : light_(light) {
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

inline Caster::Range Caster::over(const Receiver& receiver, const Linear& number) {
  Range range{number.at(receiver.corners[0]), number.at(receiver.corners[0])};
  for (std::size_t i = 1; i < receiver.count; ++i) {
    const double value = number.at(receiver.corners[i]);
    range.least = std::min(range.least, value);
    range.most = std::max(range.most, value);
  }
  return range;
}

inline Caster::Range Caster::slope(const Receiver& receiver) const {
  if (light_.directional) return {-lightHeight_, -lightHeight_};
  return over(receiver, {light_.position, normal_});
}

inline double Caster::farthest(const Receiver& receiver) const {
  const Vec3d way = light_.towards(receiver.center);
  const double aside = length(cross(corner_[0] - receiver.center, way));
  const double spread = receiver.radius + receiver.reach;
  return aside + spread * toLight_ + longest_ * (length(way) + (light_.directional ? 0 : spread));
}

inline Caster::Bounds Caster::boundsFor(const Receiver& receiver) const {
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

inline Meeting Caster::meet(const Receiver& receiver) const {
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

// True if the shaft surely misses the triangle by more than `distance`.
inline bool shaftMisses(const simd::ShaftSides& sides, const TriangleRecord& triangle,
                        double distance) {
  const float* p = triangle.position;
  const Vec3d a{p[0], p[1], p[2]}, b{p[3], p[4], p[5]}, c{p[6], p[7], p[8]};
  const Vec3d lower = min(a, min(b, c)), upper = max(a, max(b, c));
  if (lower.x - distance > sides.upper.x || lower.y - distance > sides.upper.y ||
      lower.z - distance > sides.upper.z || upper.x + distance < sides.lower.x ||
      upper.y + distance < sides.lower.y || upper.z + distance < sides.lower.z) {
    return true;
  }
  for (std::size_t i = 0; i < sides.count; ++i) {
    const auto& plane = sides.planes[i];
    const double bound = plane.offset + distance;
    if (dot(plane.outward, a) > bound && dot(plane.outward, b) > bound &&
        dot(plane.outward, c) > bound) {
      return true;
    }
  }
  return false;
}

}  // namespace whit
