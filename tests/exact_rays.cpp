#include "exact_rays.h"

#include <algorithm>
#include <cmath>

namespace whit::test {

namespace {

__extension__ using Wide = __int128;
__extension__ using UnsignedWide = unsigned __int128;

struct WideVector {
  Wide x, y, z;
};

WideVector minus(const WholePoint& a, const WholePoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
WideVector crossOf(const WideVector& a, const WideVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Wide dotOf(const WideVector& a, const WideVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

double lengthOf(const WideVector& v) {
  return std::hypot(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}

// The 256 bits of a product, the upper half first.
std::array<UnsignedWide, 2> productOf(UnsignedWide a, UnsignedWide b) {
  constexpr UnsignedWide kLow = ~std::uint64_t{0};
  const UnsignedWide low = (a & kLow) * (b & kLow), first = (a >> 64) * (b & kLow) + (low >> 64),
                     second = (a & kLow) * (b >> 64) + (first & kLow);
  return {(a >> 64) * (b >> 64) + (first >> 64) + (second >> 64), second << 64 | (low & kLow)};
}

}  // namespace

// The numerators are not below 0, so that products of unsigned numbers order the fractions.
bool isNearer(const ExactHit& a, const ExactHit& b) {
  return productOf(static_cast<UnsignedWide>(a.numerator),
                   static_cast<UnsignedWide>(b.denominator)) <
         productOf(static_cast<UnsignedWide>(b.numerator),
                   static_cast<UnsignedWide>(a.denominator));
}

double ExactHit::t() const {
  return static_cast<double>(static_cast<long double>(numerator) /
                             static_cast<long double>(denominator));
}

std::vector<ExactHit> exactHits(std::span<const WholeTriangle> triangles, const WholeRay& ray) {
  std::vector<ExactHit> hits;

  const WideVector way{ray.direction[0], ray.direction[1], ray.direction[2]};
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [p, q, r] = triangles[i];
    const WideVector a = minus(p, ray.origin), b = minus(q, ray.origin), c = minus(r, ray.origin);
    const Wide wa = dotOf(way, crossOf(c, minus(q, r))), wb = dotOf(way, crossOf(a, minus(r, p))),
               wc = dotOf(way, crossOf(b, minus(p, q)));

    // The ray passes the triangle's edges on different sides.
    if (std::min({wa, wb, wc}) < 0 && std::max({wa, wb, wc}) > 0) continue;
    const WideVector normal = crossOf(minus(q, p), minus(r, p));
    const Wide slope = dotOf(normal, way), height = dotOf(normal, a);
    if (slope == 0) continue;

    ExactHit hit;
    hit.triangle = static_cast<std::uint32_t>(i);
    hit.onEdge = wa == 0 || wb == 0 || wc == 0;
    hit.front = slope < 0;
    hit.cosine = std::abs(static_cast<double>(slope)) / lengthOf(normal) / lengthOf(way);
    hit.numerator = slope < 0 ? -height : height;
    hit.denominator = slope < 0 ? -slope : slope;
    if (hit.numerator >= 0) hits.push_back(hit);
  }

  std::ranges::stable_sort(hits, isNearer);
  return hits;
}

}  // namespace whit::test
