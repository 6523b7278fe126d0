// Products that are rounded before a sum takes them, and Highway's functions made of such.
// Highway's own MulAdd is fused where the target can do that, so its last bit depends on the
// processor.
#if defined(WHIT_SIMD_PRODUCT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_PRODUCT_INL_H_
#undef WHIT_SIMD_PRODUCT_INL_H_
#else
#define WHIT_SIMD_PRODUCT_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// a * b + c
template <class V>
HWY_INLINE V MulThenAdd(V a, V b, V c) {
  return hn::Add(hn::Mul(a, b), c);
}
// a * b - c
template <class V>
HWY_INLINE V MulThenSub(V a, V b, V c) {
  return hn::Sub(hn::Mul(a, b), c);
}
// c - a * b
template <class V>
HWY_INLINE V NegMulThenAdd(V a, V b, V c) {
  return hn::Sub(c, hn::Mul(a, b));
}

// Vectors of three in double, up to eight side by side, operation for operation as Vec3d.
using Doubles = hn::CappedTag<double, 8>;
using VD = hn::Vec<Doubles>;

struct D3 {
  VD x, y, z;
};

HWY_INLINE D3 Add3(const D3& a, const D3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE D3 Sub3(const D3& a, const D3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE D3 Scale3(const D3& a, VD s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE VD Dot3(const D3& a, const D3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE D3 Cross3(const D3& a, const D3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// Polynomials in Highway's sine, exponential and others call these.
#define MulAdd ::whit::simd::HWY_NAMESPACE::MulThenAdd
#define MulSub ::whit::simd::HWY_NAMESPACE::MulThenSub
#define NegMulAdd ::whit::simd::HWY_NAMESPACE::NegMulThenAdd
#include "hwy/contrib/math/math-inl.h"
#undef MulAdd
#undef MulSub
#undef NegMulAdd

#endif
