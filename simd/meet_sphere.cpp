// Intersections of a packet's rays with an exact sphere, for Embree, in both findIntersections and
// checkShadows. In double, so that a sphere far away or far from the origin is as round as a near
// one.
#include "simd/meet_sphere.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/meet_sphere.cpp"
#include "bake/sphere.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/product-inl.h"
#include "stages/packet_words.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct Vec3Of {
  hn::Vec<D> x, y, z;
};

template <class D>
HWY_INLINE hn::Vec<D> DotOf(const Vec3Of<D>& a, const Vec3Of<D>& b) {
  return MulThenAdd(a.x, b.x, MulThenAdd(a.y, b.y, Mul(a.z, b.z)));
}

template <class D>
HWY_INLINE Vec3Of<D> ToUnit(D d, const SphereInverse& sphere, const Vec3Of<D>& v) {
  if (sphere.diagonal) {
    return {Mul(v.x, Set(d, sphere.rows[0][0])), Mul(v.y, Set(d, sphere.rows[1][1])),
            Mul(v.z, Set(d, sphere.rows[2][2]))};
  }

  const auto row = [&](const double* r) HWY_ATTR {
    return DotOf<D>({Set(d, r[0]), Set(d, r[1]), Set(d, r[2])}, v);
  };
  return {row(sphere.rows[0]), row(sphere.rows[1]), row(sphere.rows[2])};
}

// Stores the octahedral map of a point of the sphere. The scalar reference is sphereWeights in
// src/bake/sphere.cpp.
template <class D>
HWY_INLINE void StoreWeights(D d, const Vec3Of<D>& p, size_t i, const SphereHits& to) {
  const hn::Rebind<float, D> df;
  const auto one = Set(d, 1.0), zero = Zero(d);

  // The point is projected onto the octahedron |x| + |y| + |z| = 1.
  const auto sum = Add(Add(Abs(p.x), Abs(p.y)), Abs(p.z));
  const auto inverse = Div(one, sum), x = Mul(p.x, inverse), y = Mul(p.y, inverse);

  // The lower half is folded outwards over the edges of the upper one.
  const auto below = Lt(p.z, zero);
  const auto flatX = IfThenElse(below, CopySign(Sub(one, Abs(y)), x), x);
  const auto flatY = IfThenElse(below, CopySign(Sub(one, Abs(x)), y), y);

  // The square is shrunk into the interior of a triangle's weights.
  const auto begin = Set(d, kSphereWeightBegin), scale = Set(d, kSphereWeightScale);
  const auto store = [&](hn::Vec<D> flat, float* column) HWY_ATTR {
    const auto weight = MulThenAdd(Add(flat, one), scale, begin);
    StoreU(hn::DemoteTo(df, weight), df, column + i);
  };

  store(flatX, to.u);
  store(flatY, to.v);
}

// Intersects the rays of one vector, from lane i of the packet on, and returns the bits of those
// that hit. The scalar reference is meetSphere in src/bake/sphere.cpp.
template <class D>
HWY_INLINE uint32_t MeetLanes(D d, const SphereInverse& sphere, const float* words, size_t width,
                              size_t i, const int* valid, const float* after, const float* end,
                              const SphereHits& to) {
  const hn::Rebind<float, D> df;
  const auto load = [&](size_t column)
                        HWY_ATTR { return PromoteTo(d, LoadU(df, words + column * width + i)); };

  const Vec3Of<D> from{Sub(load(packet_column::orgX), Set(d, sphere.center[0])),
                       Sub(load(packet_column::orgY), Set(d, sphere.center[1])),
                       Sub(load(packet_column::orgZ), Set(d, sphere.center[2]))};
  const Vec3Of<D> along{load(packet_column::dirX), load(packet_column::dirY),
                        load(packet_column::dirZ)};

  // Where the sphere is the unit sphere, the point of the line that is nearest to the center
  // decides about a hit without cancellation (Haines et al. 2019).
  const Vec3Of<D> f = ToUnit(d, sphere, from), v = ToUnit(d, sphere, along);
  const auto one = Set(d, 1.0), zero = Zero(d);
  const auto a = DotOf<D>(v, v), b = Neg(DotOf<D>(f, v)), inverse = Div(one, a);
  const auto middle = Mul(b, inverse);
  const Vec3Of<D> nearest{MulThenAdd(v.x, middle, f.x), MulThenAdd(v.y, middle, f.y),
                          MulThenAdd(v.z, middle, f.z)};
  const auto inside = Sub(one, DotOf<D>(nearest, nearest));

  const auto hit = Ge(inside, zero);
  if (AllFalse(d, hit)) return 0;

  // The root of larger magnitude is q / a; the other one follows from the product of both, so that
  // neither suffers from cancellation.
  const auto root = Sqrt(Mul(a, IfThenElseZero(hit, inside)));
  const auto q = Add(b, CopySign(root, b));
  const auto first = Div(Sub(DotOf<D>(f, f), one), q), second = Mul(q, inverse);
  const auto low = Min(first, second), high = Max(first, second);

  // The hit is the nearer root beyond `after`, rounded to a float as Embree keeps it.
  const auto start = PromoteTo(d, LoadU(df, after + i));
  const auto t = IfThenElse(Gt(low, start), low, high);
  const auto there = And(And(hit, Ne(q, zero)), Gt(t, start));
  const auto rounded = hn::DemoteTo(df, IfThenElse(there, t, hn::NaN(d)));
  StoreU(rounded, df, to.t + i);

  // The hit counts for valid rays that do not end before it.
  const hn::Rebind<int32_t, D> di;
  const auto asks = RebindMask(df, Ne(LoadU(di, valid + i), Zero(di)));
  uint8_t bits[8] = {};  // as many as masks of any vector may store
  hn::StoreMaskBits(df, And(asks, Le(rounded, LoadU(df, end + i))), bits);

  if (bits[0] != 0 && to.u) {
    StoreWeights(d, {MulThenAdd(v.x, t, f.x), MulThenAdd(v.y, t, f.y), MulThenAdd(v.z, t, f.z)}, i,
                 to);
  }

  return uint32_t{bits[0]} << i;
}

// Vectors without a valid ray are skipped, because Embree also calls this for single rays of
// packets.
template <size_t kWidth>
HWY_INLINE uint32_t MeetPacket(const SphereInverse& sphere, const float* words, size_t width,
                               const int* valid, const float* after, const float* end,
                               const SphereHits& to) {
  const hn::CappedTag<double, kWidth> d;
  const size_t lanes = Lanes(d);
  static_assert(hn::MaxLanes(d) <= 8);

  uint32_t hitLanes = 0;
  for (size_t i = 0; i < width; i += lanes) {
    int any = 0;
    for (size_t lane = 0; lane < lanes; ++lane) any |= valid[i + lane];
    if (any != 0) hitLanes |= MeetLanes(d, sphere, words, width, i, valid, after, end, to);
  }

  return hitLanes;
}

uint32_t MeetSphere(const SphereInverse& sphere, const float* words, size_t width, const int* valid,
                    const float* after, const float* end, const SphereHits& to) {
  switch (width) {
    case 16:
      return MeetPacket<16>(sphere, words, width, valid, after, end, to);
    case 8:
      return MeetPacket<8>(sphere, words, width, valid, after, end, to);
    case 4:
      return MeetPacket<4>(sphere, words, width, valid, after, end, to);
    default:
      return MeetPacket<1>(sphere, words, width, valid, after, end, to);
  }
}

SphereMeeter FindMeetSphere() { return MeetSphere; }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(FindMeetSphere);
SphereMeeter findMeetSphere() { return HWY_DYNAMIC_DISPATCH(FindMeetSphere)(); }
}  // namespace whit::simd
#endif
