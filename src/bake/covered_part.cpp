#include "bake/covered_part.h"

#include <algorithm>
#include <cmath>

#include "bake/facet.h"

namespace whit {

namespace {

// The weights of corners 1 and 2 of a triangle.
struct Weights {
  double u, v;
};

// A point whose weights are off by no more than `off` lies inside of the edges of a triangle if it
// lies in the triangle.
std::array<CoveredPart::Edge, 3> edgesAround(const std::array<Weights, 3>& corners,
                                             const Weights& off) {
  constexpr double kRounding = 0x1p-20;  // of the sum in floats
  std::array<CoveredPart::Edge, 3> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    const Weights &p = corners[i], &q = corners[(i + 1) % 3], &opposite = corners[(i + 2) % 3];
    double a = p.v - q.v, b = q.u - p.u, c = p.u * q.v - p.v * q.u;
    const double inside = a * opposite.u + b * opposite.v + c;
    const double size = std::copysign(std::max({std::abs(a), std::abs(b), std::abs(c)}), inside);
    // An edge whose inner side is lost in rounding has nothing outside.
    if (!(std::abs(inside) > kRounding * std::abs(size))) continue;
    a /= size, b /= size, c /= size;
    c += std::abs(a) * off.u + std::abs(b) * off.v + 3 * kRounding;
    edges[i] = {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
  }
  return edges;
}

}  // namespace

CoveredPart coveredPart(const Facet& on, const Facet& of) {
  // Rounding of the hits' weights, which are floats.
  constexpr double kRounding = 0x1p-12;
  const Vec3d e1 = on.corners[1] - on.corners[0], e2 = on.corners[2] - on.corners[0];
  const double area = dot(cross(e1, e2), on.normal);
  // A weight grows along the normal of the edge that faces its corner.
  const Vec3d growthU = cross(e2, on.normal) / area, growthV = cross(on.normal, e1) / area;
  const double slack = on.error + of.error;
  const Weights off = {kRounding + slack * length(growthU), kRounding + slack * length(growthV)};
  std::array<Weights, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d from = of.corners[i] - on.corners[0];
    corners[i] = {dot(from, growthU), dot(from, growthV)};
  }
  const auto [u0, u1] = std::minmax({corners[0].u, corners[1].u, corners[2].u});
  const auto [v0, v1] = std::minmax({corners[0].v, corners[1].v, corners[2].v});
  const auto bounded = [](double weight) {
    return static_cast<float>(std::clamp(weight, -1.0, 2.0));
  };
  return {bounded(u0 - off.u), bounded(u1 + off.u), bounded(v0 - off.v), bounded(v1 + off.v),
          edgesAround(corners, off)};
}

}  // namespace whit
