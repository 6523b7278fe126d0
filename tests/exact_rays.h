// Hits of rays in whole numbers without any rounding: an oracle for ray queries, which
// shares no code with them. Coordinates are whole numbers below 2^25, of rays below 2^41 (origins)
// and 2^31 (directions); all products of three then fit into 128 bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace whit::test {

using WholePoint = std::array<std::int64_t, 3>;
using WholeTriangle = std::array<WholePoint, 3>;
struct WholeRay {
  WholePoint origin{}, direction{};
};

struct ExactHit {
  std::uint32_t triangle = 0;
  bool onEdge = false;  // an edge or a corner is hit
  bool front = false;
  double cosine = 0;  // between the ray and the triangle's normal, not below 0
  __extension__ __int128 numerator = 0, denominator = 1;  // of t; the denominator is above 0
  double t() const;
};
// Returns true if `a` is nearer than `b`; equal distances give false both ways.
bool isNearer(const ExactHit& a, const ExactHit& b);

// All hits with t >= 0 in order of t. Triangles that are parallel to the ray are not hit.
std::vector<ExactHit> exactHits(std::span<const WholeTriangle> triangles, const WholeRay& ray);

}  // namespace whit::test
