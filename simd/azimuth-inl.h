// Angles about an axis.
#if defined(WHIT_SIMD_AZIMUTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_AZIMUTH_INL_H_
#undef WHIT_SIMD_AZIMUTH_INL_H_
#else
#define WHIT_SIMD_AZIMUTH_INL_H_
#endif

#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Azimuth from -z towards +x as a fraction of a turn, in [0, 1].
HWY_INLINE VF AzimuthFraction(VF x, VF z) {
  const FloatTag d;
  const VF cosine = hn::Neg(z);
  const VF ax = hn::Abs(x), ac = hn::Abs(cosine);
  // Atan of the smaller over the larger keeps the quotient in [0, 1].
  const MF steep = hn::Gt(ax, ac);
  const VF larger = hn::Max(hn::Max(ax, ac), hn::Set(d, 1e-30f));
  const VF a = hn::Atan(d, hn::Div(hn::Min(ax, ac), larger));
  VF angle = hn::IfThenElse(steep, hn::Sub(hn::Set(d, 1.57079637f), a), a);
  angle =
      hn::IfThenElse(hn::Lt(cosine, hn::Zero(d)), hn::Sub(hn::Set(d, 3.14159274f), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 6.28318548f), angle), angle);
  return hn::Mul(angle, hn::Set(d, 0.159154943f));
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
