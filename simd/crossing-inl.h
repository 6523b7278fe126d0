// Media along rays and at the surfaces that they meet.
#if defined(WHIT_SIMD_CROSSING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_CROSSING_INL_H_
#undef WHIT_SIMD_CROSSING_INL_H_
#else
#define WHIT_SIMD_CROSSING_INL_H_
#endif

#include "hwy/contrib/math/math-inl.h"
#include "simd/media-inl.h"
#include "stages/columns.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Media on both sides of the surface, and whether it is there at all.
HWY_INLINE void StoreMedia(const ShadingTables& tables, const RayColumns& rays, VF mediumBits,
                           MF entering, size_t i, const SurfelColumns& surfels) {
  const UintTag du;
  const VU stack = hn::Load(du, rays.media + i);
  const VU medium = hn::BitCast(du, mediumBits);
  const auto dielectric = hn::Ne(medium, hn::Zero(du));
  const auto enters = hn::RebindMask(du, entering);
  VU behind = hn::IfThenElse(enters, PushMedium(stack, medium), RemoveMedium(stack, medium));
  behind = hn::IfThenElse(dielectric, behind, stack);
  const auto same = hn::Eq(CurrentMedium(tables, stack), CurrentMedium(tables, behind));
  const VU hidden = hn::IfThenElseZero(hn::And(dielectric, same), hn::Set(du, kHidden));
  hn::Store(hn::Or(hn::IfThenElseZero(enters, hn::Set(du, kEntering)), hidden), du,
            surfels.flags + i);
  hn::Store(behind, du, surfels.mediaBehind + i);
}

// exp(-sigma * t) into weight and throughput of rays that crossed an absorbing medium.
HWY_INLINE void Absorb(const ShadingTables& tables, const RayColumns& rays, const HitColumns& hits,
                       MF valid, size_t i) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const VU stack = hn::Load(du, rays.media + i);
  if (hn::AllTrue(du, hn::Eq(stack, hn::Zero(du)))) return;
  const VI medium = hn::BitCast(di, CurrentMedium(tables, stack));
  const Records records = RecordsAt(tables.media.data(), kMediumStride, medium);
  const V4 record = LoadColumns4(records, 0);
  const VF t = hn::Load(d, hits.t + i);
  const auto transmittance = [&](VF sigma) HWY_ATTR {
    // 88 is past where exp underflows to zero; the limit keeps infinity out of the polynomial.
    const VF depth = hn::Min(hn::Mul(sigma, t), hn::Set(d, 104.0f));
    const VF hit = hn::IfThenElseZero(hn::Lt(depth, hn::Set(d, 87.0f)), hn::Exp(d, hn::Neg(depth)));
    const VF through = hn::IfThenElseZero(valid, hit);
    return hn::IfThenElse(hn::Gt(sigma, hn::Zero(d)), through, hn::Set(d, 1.0f));
  };
  const V3 factor{transmittance(record.y), transmittance(record.z), transmittance(record.w)};
  const V3 weight = Load3(rays.weightR, rays.weightG, rays.weightB, i);
  Store3(Mul3(weight, factor), rays.weightR, rays.weightG, rays.weightB, i);
  const VF throughput = hn::Load(d, rays.throughput + i);
  hn::Store(hn::Mul(throughput, MaxComponent(factor)), d, rays.throughput + i);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
