// Directions drawn by their cosine to a normal (the scalar reference:
// src/sampling/cosine_lobe.h).
#if defined(WHIT_SIMD_COSINE_LOBE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_COSINE_LOBE_INL_H_
#undef WHIT_SIMD_COSINE_LOBE_INL_H_
#else
#define WHIT_SIMD_COSINE_LOBE_INL_H_
#endif

#include "sampling/cosine_lobe.h"
#include "simd/random_streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// About a vector of unit normals.
class CosineLobes {
 public:
  HWY_INLINE explicit CosineLobes(const V3& normal) : z_(normal) {
    const FloatTag d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const MF useX = hn::Lt(hn::Abs(normal.x), hn::Set(d, kFrameAlongY));
    const V3 axis{hn::IfThenElseZero(useX, one), hn::IfThenElse(useX, zero, one), zero};
    x_ = NormalizeOr(Cross(normal, axis), axis);
    y_ = Cross(normal, x_);
  }

  HWY_INLINE V3 Direction(const UnitPoints& at) const {
    const FloatTag d;
    const VF turn = hn::Mul(at.u, hn::Set(d, 6.28318531f));
    const VF sine = hn::Sqrt(at.v), cosine = hn::Sqrt(hn::Sub(hn::Set(d, 1.0f), at.v));
    const VF x = hn::Mul(sine, hn::Cos(d, turn)), y = hn::Mul(sine, hn::Sin(d, turn));
    return Normalize3(MulAdd3(x_, x, MulAdd3(y_, y, Scale3(z_, cosine))));
  }

 private:
  V3 x_, y_, z_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
