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

// Lanes that name a record; kMiss and kNoTexture are negative.
HWY_INLINE hn::Mask<IntTag> NonNegative(VI index) { return hn::Gt(index, hn::Set(IntTag(), -1)); }

struct V3 {
  VF x, y, z;
};

HWY_INLINE V3 Broadcast3(const Vec3f& v) {
  const FloatTag d;
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

HWY_INLINE V3 Load3(const Columns3& from, size_t i) {
  const FloatTag d;
  return {hn::Load(d, from.x + i), hn::Load(d, from.y + i), hn::Load(d, from.z + i)};
}

HWY_INLINE void Store3(const V3& v, const Columns3& to, size_t i) {
  const FloatTag d;
  hn::Store(v.x, d, to.x + i);
  hn::Store(v.y, d, to.y + i);
  hn::Store(v.z, d, to.z + i);
}

HWY_INLINE V3 Add3(const V3& a, const V3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE V3 Sub3(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

// Returns 1 - share for each channel: the light that remains for the layers below.
HWY_INLINE V3 Complement3(const V3& share) { return Sub3(Broadcast3(Vec3f(1.0f)), share); }

HWY_INLINE V3 Mul3(const V3& a, const V3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

HWY_INLINE V3 Scale3(const V3& a, VF s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

// a * s + b
HWY_INLINE V3 MulAdd3(const V3& a, VF s, const V3& b) {
  return {MulThenAdd(a.x, s, b.x), MulThenAdd(a.y, s, b.y), MulThenAdd(a.z, s, b.z)};
}

HWY_INLINE V3 Abs3(const V3& a) { return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)}; }

HWY_INLINE V3 Select3(MF m, const V3& yes, const V3& no) {
  return {hn::IfThenElse(m, yes.x, no.x), hn::IfThenElse(m, yes.y, no.y),
          hn::IfThenElse(m, yes.z, no.z)};
}

HWY_INLINE VF Dot(const V3& a, const V3& b) {
  return MulThenAdd(a.x, b.x, MulThenAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE VF MaxComponent(const V3& a) { return hn::Max(a.x, hn::Max(a.y, a.z)); }

HWY_INLINE VF DifferenceOfProducts(VF a, VF b, VF c, VF d) {
  return MulThenSub(a, b, hn::Mul(c, d));
}

HWY_INLINE V3 Cross(const V3& a, const V3& b) {
  return {DifferenceOfProducts(a.y, b.z, a.z, b.y), DifferenceOfProducts(a.z, b.x, a.x, b.z),
          DifferenceOfProducts(a.x, b.y, a.y, b.x)};
}

// a * b - c * e where the products are exact.
HWY_INLINE VF ExactDifferenceOfProducts(VF a, VF b, VF c, VF e) {
  const FloatTag d;
  const auto differenceOf = [&](auto df, auto p, auto q, auto r, auto s) HWY_ATTR {
    const hn::Rebind<double, decltype(df)> dd;
    const auto pq = hn::Mul(hn::PromoteTo(dd, p), hn::PromoteTo(dd, q));
    return hn::DemoteTo(df, hn::Sub(pq, hn::Mul(hn::PromoteTo(dd, r), hn::PromoteTo(dd, s))));
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
HWY_INLINE VF InverseSqrt(VF a) { return hn::Div(hn::Set(FloatTag(), 1.0f), hn::Sqrt(a)); }

// Normalizes vectors of ordinary length only.
HWY_INLINE V3 Normalize3(const V3& a) { return Scale3(a, InverseSqrt(Dot(a, a))); }

// `a` normalized, or `fallback` where it has no length.
HWY_INLINE V3 NormalizeOr(const V3& a, const V3& fallback) {
  const FloatTag d;
  const VF squared = Dot(a, a);
  const MF good = hn::Gt(squared, hn::Set(d, 1e-30f));
  const VF inverse = InverseSqrt(hn::IfThenElse(good, squared, hn::Set(d, 1.0f)));
  return Select3(good, Scale3(a, inverse), fallback);
}

// The power of two 2^-e where 2^e <= a < 2^(e+1), for `a` above zero and normal. Products with this
// power are exact and bring lengths into the range where squares neither overflow nor vanish.
HWY_INLINE VF InverseExponent(VF a) {
  const UintTag du;
  const VU exponent = hn::And(hn::BitCast(du, a), hn::Set(du, 0x7F800000u));
  return hn::BitCast(FloatTag(), hn::Sub(hn::Set(du, 0x7F000000u), exponent));
}

// Azimuth from -z towards +x as a fraction of a turn, in [0, 1].
HWY_INLINE VF AzimuthFraction(VF x, VF z) {
  const FloatTag d;
  const VF cosine = hn::Neg(z);
  const VF ax = hn::Abs(x), ac = hn::Abs(cosine);

  // Atan of the smaller over the larger keeps the quotient in [0, 1].
  const MF steep = hn::Gt(ax, ac);
  const VF larger = hn::Max(hn::Max(ax, ac), hn::Set(d, 1e-30f));
  const VF a = hn::Atan(d, hn::Div(hn::Min(ax, ac), larger));

  // The quotient covers an eighth of a turn; three reflections reach the whole turn.
  VF angle = hn::IfThenElse(steep, hn::Sub(hn::Set(d, 1.57079637f), a), a);
  angle =
      hn::IfThenElse(hn::Lt(cosine, hn::Zero(d)), hn::Sub(hn::Set(d, 3.14159274f), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 6.28318548f), angle), angle);
  return hn::Mul(angle, hn::Set(d, 0.159154943f));
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
