// The part of a triangle that another triangle in its plane covers.
#pragma once

#include <array>

namespace whit {

struct Facet;

// In the weights of corners 1 and 2 of another triangle: what of it this one, in its plane, covers
// at the most.
struct CoveredPart {
  float u0 = 0, u1 = 0, v0 = 0, v1 = 0;  // a box around it
  // Along each of its edges: what lies outside of the edge has a * u + b * v + c < 0.
  struct Edge {
    float a = 0, b = 0, c = 0;
  };
  std::array<Edge, 3> edges;

  bool holds(float u, float v) const {
    if (u < u0 || u > u1 || v < v0 || v > v1) return false;
    const auto isInside = [&](const Edge& e) { return e.a * u + e.b * v + e.c >= 0; };
    return isInside(edges[0]) && isInside(edges[1]) && isInside(edges[2]);
  }
  // Tests a square, given by its corner of the least weights. False only if the square holds no
  // point of the part.
  bool meets(float u, float v, float side) const {
    const auto isInside = [&](const Edge& e) {
      return e.a * (e.a > 0 ? u + side : u) + e.b * (e.b > 0 ? v + side : v) + e.c >= 0;
    };
    return isInside(edges[0]) && isInside(edges[1]) && isInside(edges[2]);
  }
};
CoveredPart coveredPart(const Facet& on, const Facet& of);

}  // namespace whit
