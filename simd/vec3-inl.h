// Vectors of three vectors: one Vec3 a lane.
#if defined(WHIT_SIMD_VEC3_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_VEC3_INL_H_
#undef WHIT_SIMD_VEC3_INL_H_
#else
#define WHIT_SIMD_VEC3_INL_H_
#endif

#include <cstddef>

#include "core/shading_choices.h"
#include "core/vec3.h"
#include "simd/product-inl.h"
#include "stages/columns.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A packet of 16 is one vector on AVX-512, two on AVX2, four on SSE4 and NEON.
using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using VF = hn::Vec<FloatTag>;
using VI = hn::Vec<IntTag>;
using VU = hn::Vec<UintTag>;
using MF = hn::Mask<FloatTag>;

// The functions of Highway for vectors of these three types, which need no tag.
HWY_INLINE VF Set(float x) { return Set(FloatTag(), x); }
HWY_INLINE VI Set(int32_t x) { return Set(IntTag(), x); }
HWY_INLINE VU Set(uint32_t x) { return Set(UintTag(), x); }
HWY_INLINE VF Zero() { return Zero(FloatTag()); }
HWY_INLINE VF Load(const float* column, size_t i) { return Load(FloatTag(), column + i); }
HWY_INLINE VU Load(const uint32_t* column, size_t i) { return Load(UintTag(), column + i); }
HWY_INLINE void Store(VF v, float* column, size_t i) { Store(v, FloatTag(), column + i); }
HWY_INLINE void Store(VU v, uint32_t* column, size_t i) { Store(v, UintTag(), column + i); }
HWY_INLINE bool AllFalse(MF lanes) { return AllFalse(FloatTag(), lanes); }
HWY_INLINE bool AllTrue(MF lanes) { return AllTrue(FloatTag(), lanes); }

// Lanes that name a record; kMiss and kNoTexture are negative.
HWY_INLINE hn::Mask<IntTag> NonNegative(VI index) { return Gt(index, Set(-1)); }

struct V3 {
  VF x, y, z;
};

HWY_INLINE V3 Broadcast3(const Vec3f& v) { return {Set(v.x), Set(v.y), Set(v.z)}; }

HWY_INLINE V3 Zero3() { return {Zero(), Zero(), Zero()}; }

HWY_INLINE V3 Load3(const Columns3& from, size_t i) {
  return {Load(from.x, i), Load(from.y, i), Load(from.z, i)};
}

HWY_INLINE void Store3(const V3& v, const Columns3& to, size_t i) {
  Store(v.x, to.x, i);
  Store(v.y, to.y, i);
  Store(v.z, to.z, i);
}

HWY_INLINE V3 Add3(const V3& a, const V3& b) {
  return {Add(a.x, b.x), Add(a.y, b.y), Add(a.z, b.z)};
}

HWY_INLINE V3 Sub3(const V3& a, const V3& b) {
  return {Sub(a.x, b.x), Sub(a.y, b.y), Sub(a.z, b.z)};
}

// Returns 1 - share for each channel: the light that remains for the layers below.
HWY_INLINE V3 Complement3(const V3& share) { return Sub3(Broadcast3(Vec3f(1.0f)), share); }

HWY_INLINE V3 Neg3(const V3& a) { return {Neg(a.x), Neg(a.y), Neg(a.z)}; }

HWY_INLINE V3 Mul3(const V3& a, const V3& b) {
  return {Mul(a.x, b.x), Mul(a.y, b.y), Mul(a.z, b.z)};
}

HWY_INLINE V3 Scale3(const V3& a, VF s) { return {Mul(a.x, s), Mul(a.y, s), Mul(a.z, s)}; }

// a * s + b
HWY_INLINE V3 MulAdd3(const V3& a, VF s, const V3& b) {
  return {MulThenAdd(a.x, s, b.x), MulThenAdd(a.y, s, b.y), MulThenAdd(a.z, s, b.z)};
}

HWY_INLINE V3 Abs3(const V3& a) { return {Abs(a.x), Abs(a.y), Abs(a.z)}; }

HWY_INLINE V3 Select3(MF m, const V3& yes, const V3& no) {
  return {IfThenElse(m, yes.x, no.x), IfThenElse(m, yes.y, no.y), IfThenElse(m, yes.z, no.z)};
}

HWY_INLINE VF Dot(const V3& a, const V3& b) {
  return MulThenAdd(a.x, b.x, MulThenAdd(a.y, b.y, Mul(a.z, b.z)));
}

// Brings the lanes into [0, 1].
HWY_INLINE VF Clamped01(VF x) { return Min(Max(x, Zero()), Set(1.0f)); }

HWY_INLINE VF MaxComponent(const V3& a) { return Max(a.x, Max(a.y, a.z)); }

HWY_INLINE VF DifferenceOfProducts(VF a, VF b, VF c, VF d) { return MulThenSub(a, b, Mul(c, d)); }

HWY_INLINE V3 Cross(const V3& a, const V3& b) {
  return {DifferenceOfProducts(a.y, b.z, a.z, b.y), DifferenceOfProducts(a.z, b.x, a.x, b.z),
          DifferenceOfProducts(a.x, b.y, a.y, b.x)};
}

// a * b - c * e where the products are exact.
HWY_INLINE VF ExactDifferenceOfProducts(VF a, VF b, VF c, VF e) {
  const FloatTag d;
  const auto differenceOf = [&](auto df, auto p, auto q, auto r, auto s) HWY_ATTR {
    const hn::Rebind<double, decltype(df)> dd;
    const auto pq = Mul(PromoteTo(dd, p), PromoteTo(dd, q));
    return hn::DemoteTo(df, Sub(pq, Mul(PromoteTo(dd, r), PromoteTo(dd, s))));
  };

#if HWY_TARGET == HWY_SCALAR
  return differenceOf(d, a, b, c, e);
#else
  const hn::Half<FloatTag> half;
  const auto low = [&](VF v) HWY_ATTR { return hn::LowerHalf(half, v); };
  const auto high = [&](VF v) HWY_ATTR { return hn::UpperHalf(half, v); };
  return hn::Combine(d, differenceOf(half, high(a), high(b), high(c), high(e)),
                     differenceOf(half, low(a), low(b), low(c), low(e)));
#endif
}

// Planes use exact products, because rounding them would turn the planes of needle triangles.
HWY_INLINE V3 ExactCross(const V3& a, const V3& b) {
  return {ExactDifferenceOfProducts(a.y, b.z, a.z, b.y),
          ExactDifferenceOfProducts(a.z, b.x, a.x, b.z),
          ExactDifferenceOfProducts(a.x, b.y, a.y, b.x)};
}

// 1 / sqrt(a), for `a` above zero and normal. True division and square root have the same bits on
// every target; estimates with Newton steps saved no time.
HWY_INLINE VF InverseSqrt(VF a) { return Div(Set(1.0f), Sqrt(a)); }

// Normalizes vectors of ordinary length only.
HWY_INLINE V3 Normalize3(const V3& a) { return Scale3(a, InverseSqrt(Dot(a, a))); }

// `a` normalized, or `fallback` where it has no length.
HWY_INLINE V3 NormalizeOr(const V3& a, const V3& fallback) {
  const VF squared = Dot(a, a);
  const MF good = Gt(squared, Set(1e-30f));
  const VF inverse = InverseSqrt(IfThenElse(good, squared, Set(1.0f)));
  return Select3(good, Scale3(a, inverse), fallback);
}

// A unit vector across the unit vector `n`. It turns with the x axis, or with the y axis where
// |n.x| is `alongY` or more.
HWY_INLINE V3 UnitAcross(const V3& n, float alongY) {
  const VF zero = Zero(), one = Set(1.0f);
  const MF useX = Lt(Abs(n.x), Set(alongY));
  const V3 axis{IfThenElseZero(useX, one), IfThenElse(useX, zero, one), zero};
  return NormalizeOr(Cross(n, axis), axis);
}

// The power of two 2^-e where 2^e <= a < 2^(e+1), for `a` above zero and normal. Products with this
// power are exact and bring lengths into the range where squares neither overflow nor vanish.
HWY_INLINE VF InverseExponent(VF a) {
  const UintTag du;
  const VU exponent = And(BitCast(du, a), Set(0x7F800000u));
  return BitCast(FloatTag(), Sub(Set(0x7F000000u), exponent));
}

// Azimuth from -z towards +x as a fraction of a turn, in [0, 1].
HWY_INLINE VF AzimuthFraction(VF x, VF z) {
  const FloatTag d;
  const VF cosine = Neg(z);
  const VF ax = Abs(x), ac = Abs(cosine);

  // Atan of the smaller over the larger keeps the quotient in [0, 1].
  const MF steep = Gt(ax, ac);
  const VF larger = Max(Max(ax, ac), Set(1e-30f));
  const VF a = hn::Atan(d, Div(Min(ax, ac), larger));

  // The quotient covers an eighth of a turn; three reflections reach the whole turn.
  VF angle = IfThenElse(steep, Sub(Set(1.57079637f), a), a);
  angle = IfThenElse(Lt(cosine, Zero()), Sub(Set(3.14159274f), angle), angle);
  angle = IfThenElse(Lt(x, Zero()), Sub(Set(6.28318548f), angle), angle);
  return Mul(angle, Set(0.159154943f));
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
