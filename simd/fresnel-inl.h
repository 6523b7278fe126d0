// Dielectric reflectance in factored form: no difference of nearly equal numbers, exact for ior
// ratios near and at 1 (hard cases H37-H41).
#if defined(WHIT_SIMD_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_FRESNEL_INL_H_
#undef WHIT_SIMD_FRESNEL_INL_H_
#else
#define WHIT_SIMD_FRESNEL_INL_H_
#endif

#include "core/shading_choices.h"
#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

struct Interface {
  VF reflectance;  // F
  VF eta;          // ior behind over ior before
  VF k;            // eta^2 - 1
  VF bend;         // k / (c + g), the share of the normal that refraction takes off the direction
  MF straight;     // same ior on both sides: the direction does not change at all
};

// (1 - c)^5 (Schlick 1994).
HWY_INLINE VF SchlickTerm(VF c) {
  const VF m = hn::Sub(hn::Set(FloatTag(), 1.0f), c);
  const VF m2 = hn::Mul(m, m);
  return hn::Mul(hn::Mul(m2, m2), m);
}

// Schlick's polynomial, of the refracted ray's cosine g / eta where that is the smaller one.
HWY_INLINE VF SchlickReflectance(VF iorBefore, VF iorBehind, VF c, VF g) {
  const FloatTag d;
  const VF normal = hn::Div(hn::Sub(iorBehind, iorBefore), hn::Add(iorBehind, iorBefore));
  const VF f0 = hn::Mul(normal, normal);
  const VF refracted = hn::Mul(g, hn::Div(iorBefore, iorBehind));
  const VF cosine = hn::IfThenElse(hn::Lt(iorBehind, iorBefore), refracted, c);
  return MulThenAdd(hn::Sub(hn::Set(d, 1.0f), f0), SchlickTerm(cosine), f0);
}

// c: cosine between the viewer and the normal, in [0, 1].
HWY_INLINE Interface DielectricInterface(FresnelModel model, VF iorBefore, VF iorBehind, VF c) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const VF eta = hn::Div(iorBehind, iorBefore);
  // eta^2 - 1, factored over the iors themselves.
  const VF k = hn::Div(hn::Mul(hn::Sub(iorBehind, iorBefore), hn::Add(iorBehind, iorBefore)),
                       hn::Mul(iorBefore, iorBefore));
  const VF g2 = MulThenAdd(c, c, k);
  const MF straight = hn::Eq(k, zero);
  const MF total = hn::Or(hn::Le(g2, zero), hn::Le(c, zero));
  const VF g = hn::Sqrt(hn::Max(g2, zero));
  const VF sum = hn::Max(hn::Add(c, g), hn::Set(d, 1e-30f));
  const VF bend = hn::Div(k, sum);
  const VF rs = hn::Div(bend, sum);
  const VF etaSquaredC = hn::Mul(hn::Mul(eta, eta), c);
  const VF rp = hn::Div(hn::Mul(k, hn::Sub(c, hn::Div(one, sum))),
                        hn::Max(hn::Add(etaSquaredC, g), hn::Set(d, 1e-30f)));
  VF f = hn::Mul(hn::Set(d, 0.5f), MulThenAdd(rs, rs, hn::Mul(rp, rp)));
  if (model == FresnelModel::schlick) f = SchlickReflectance(iorBefore, iorBehind, c, g);
  f = hn::IfThenElse(total, one, hn::Min(f, one));
  f = hn::IfThenElse(straight, zero, f);
  return {f, eta, k, bend, straight};
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
