// Where rays leave a surface (the scalar reference: src/reference/world.h).
#if defined(WHIT_SIMD_RAY_ORIGIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_RAY_ORIGIN_INL_H_
#undef WHIT_SIMD_RAY_ORIGIN_INL_H_
#else
#define WHIT_SIMD_RAY_ORIGIN_INL_H_
#endif

#include "core/shading_choices.h"
#include "simd/vec3-inl.h"
#include "stages/columns.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// One coordinate moved by 256 ulps times the normal's component, near the origin by 1/65536 of it
// (Waechter and Binder 2019).
HWY_INLINE VF MovedByUlps(VF p, VF n) {
  const FloatTag d;
  const IntTag di;
  const VI ulps = hn::ConvertTo(di, hn::Mul(n, hn::Set(d, 256.0f)));
  const VI away =
      hn::IfThenElse(hn::RebindMask(di, hn::Lt(p, hn::Zero(d))), hn::Sub(hn::Zero(di), ulps), ulps);
  const VF far = hn::BitCast(d, hn::Add(hn::BitCast(di, p), away));
  const VF near = MulThenAdd(n, hn::Set(d, 1.0f / 65536), p);
  return hn::IfThenElse(hn::Lt(hn::Abs(p), hn::Set(d, 1.0f / 32)), near, far);
}

// How far rays start from surfels (SurfelColumns).
struct Clearance {
  VF offset, retreat;
};

HWY_INLINE Clearance LoadClearance(const SurfelColumns& surfels, size_t i) {
  const FloatTag d;
  return {hn::Load(d, surfels.offset + i), hn::Load(d, surfels.retreat + i)};
}

// `side` is 1 for the viewer's side of the surface, -1 for the other; `direction` the viewer's ray.
HWY_INLINE V3 RayOrigin(OffsetMethod method, const V3& position, const V3& ng, const V3& direction,
                        const Clearance& clearance, float side) {
  const FloatTag d;
  const VF sign = hn::Set(d, side);
  if (method == OffsetMethod::wachterBinder) {
    const V3 n = Scale3(ng, sign);
    return {MovedByUlps(position.x, n.x), MovedByUlps(position.y, n.y),
            MovedByUlps(position.z, n.z)};
  }
  if (method == OffsetMethod::bound && side > 0) {
    return MulAdd3(ng, clearance.offset, MulAdd3(direction, hn::Neg(clearance.retreat), position));
  }
  const VF offset = method == OffsetMethod::fixed ? hn::Set(d, kFixedOffset) : clearance.offset;
  return MulAdd3(ng, hn::Mul(offset, sign), position);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
