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

// Functions that most kernels call. Argument-dependent lookup would not find them for targets whose
// vectors are types of the compiler.
using hn::Abs, hn::Add, hn::AllFalse, hn::AllTrue, hn::And, hn::AndNot, hn::BitCast, hn::ConvertTo,
    hn::CopySign, hn::Div, hn::Eq, hn::Floor, hn::GatherIndex, hn::Ge, hn::Gt, hn::IfThenElse,
    hn::IfThenElseZero, hn::Lanes, hn::Le, hn::Load, hn::LoadU, hn::Lt, hn::Max, hn::Min, hn::Mul,
    hn::Ne, hn::Neg, hn::Or, hn::PromoteTo, hn::RebindMask, hn::Set, hn::ShiftRight, hn::Sqrt,
    hn::Store, hn::StoreU, hn::Sub, hn::Xor, hn::Zero;

// a * b + c
template <class V>
HWY_INLINE V MulThenAdd(V a, V b, V c) {
  return Add(Mul(a, b), c);
}

// a * b - c
template <class V>
HWY_INLINE V MulThenSub(V a, V b, V c) {
  return Sub(Mul(a, b), c);
}

// c - a * b
template <class V>
HWY_INLINE V NegMulThenAdd(V a, V b, V c) {
  return Sub(c, Mul(a, b));
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
