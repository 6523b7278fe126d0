// Light that arrives from a light source of any kind.
#if defined(WHIT_SIMD_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_LIGHT_INL_H_
#undef WHIT_SIMD_LIGHT_INL_H_
#else
#define WHIT_SIMD_LIGHT_INL_H_
#endif

#include <limits>

#include "scene/light.h"
#include "simd/random_streams-inl.h"
#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

class LightLanes {
 public:
  // Without `cones` a spot light shines to all sides.
  HWY_INLINE LightLanes(const Light& light, bool cones)
      : spot_(cones && light.kind == Light::Kind::spot),
        directional_(light.kind == Light::Kind::directional) {
    const FloatTag d;
    position_ = Broadcast3(directional_ ? Vec3f(towards(light, {})) : light.position);
    radiusSquared_ = hn::Set(d, light.radius * light.radius);
    const SpotCone cone = spot_ ? coneOf(light) : SpotCone();
    axis_ = Broadcast3(Vec3f(cone.axis));
    cosOuter_ = hn::Set(d, static_cast<float>(cone.cosOuter));
    coneScale_ = hn::Set(d, static_cast<float>(cone.scale));
  }

  // All the way, or a unit vector where the light is directional.
  HWY_INLINE V3 Towards(const V3& from) const {
    return directional_ ? position_ : Sub3(position_, from);
  }

  // True in lanes that the cone reaches. The test is not exact where the light has almost fallen
  // off to nothing.
  HWY_INLINE MF Within(MF live, const V3& toLight, VF distanceSquared) const {
    if (!spot_) return live;
    const VF along = hn::Neg(Dot(axis_, toLight)), zero = hn::Zero(FloatTag());
    const VF edge = hn::Mul(hn::Mul(cosOuter_, cosOuter_), distanceSquared);
    return hn::And(live, hn::And(hn::Gt(along, zero), hn::Gt(hn::Mul(along, along), edge)));
  }

  // The area by which the intensity is divided at this distance.
  HWY_INLINE VF Area(VF distanceSquared) const { return hn::Max(distanceSquared, radiusSquared_); }

  // A point on a light with a radius for each lane: the vector to it, and the area by which the
  // intensity is divided (the scalar reference, with its source, is viewOf in
  // src/reference/find_radiance_and_shadow_rays.cpp). It is not inlined, so that frames whose
  // lights are points do not pay for it.
  struct View {
    V3 toPoint;
    VF area;
  };
  HWY_NOINLINE View Look(const V3& toCenter, const UnitPoints& at) const {
    const FloatTag d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
    const VF squared = Dot(toCenter, toCenter);
    const MF outside = hn::Gt(squared, radiusSquared_);
    const VF safe = hn::IfThenElse(outside, squared, one);
    const VF distance = hn::Sqrt(safe);
    const VF sine2 = hn::Div(hn::IfThenElseZero(outside, radiusSquared_), safe);
    const VF height = hn::Div(sine2, hn::Add(one, hn::Sqrt(hn::Sub(one, sine2))));
    const VF h = hn::Mul(at.u, height), turn = hn::Mul(at.v, hn::Set(d, 6.28318531f));
    const VF s = hn::Sqrt(hn::Mul(h, hn::Sub(two, h)));
    const V3 z = Scale3(toCenter, hn::Div(one, distance));
    const MF useX = hn::Lt(hn::Abs(z.x), hn::Set(d, 0.5f));
    const V3 axis{hn::IfThenElseZero(useX, one), hn::IfThenElse(useX, zero, one), zero};
    const V3 x = NormalizeOr(Cross(z, axis), axis), y = Cross(z, x);
    const V3 l = MulAdd3(x, hn::Mul(s, hn::Cos(d, turn)),
                         MulAdd3(y, hn::Mul(s, hn::Sin(d, turn)), Scale3(z, hn::Sub(one, h))));
    const VF far = hn::Mul(hn::Sub(one, at.u), NegMulThenAdd(height, hn::Add(one, at.u), two));
    const VF inside = hn::Sqrt(hn::Div(far, hn::Sub(two, height)));
    const VF way =
        NegMulThenAdd(hn::Sqrt(radiusSquared_), inside, hn::Mul(distance, hn::Sub(one, h)));
    const VF area = hn::Div(radiusSquared_, hn::Add(height, height));
    return {Select3(outside, Scale3(l, way), toCenter),
            hn::IfThenElse(outside, area, Area(squared))};
  }

  // The share of the intensity that a surface receives; `nl` is the cosine at the surface, `l` the
  // direction.
  HWY_INLINE VF Falloff(VF nl, const V3& l, VF area) const {
    if (directional_) return nl;
    const VF falloff = hn::Div(nl, area);
    return spot_ ? hn::Mul(falloff, Cone(l)) : falloff;
  }

  // Where shadow rays end, in lengths of Towards().
  HWY_INLINE VF Reach() const {
    return hn::Set(FloatTag(),
                   directional_ ? std::numeric_limits<float>::infinity() : kShadowReach);
  }

 private:
  // SpotCone::falloff.
  HWY_INLINE VF Cone(const V3& l) const {
    const FloatTag d;
    const VF inside = hn::Sub(hn::Neg(Dot(axis_, l)), cosOuter_);
    const VF s = hn::Min(hn::Max(hn::Mul(inside, coneScale_), hn::Zero(d)), hn::Set(d, 1.0f));
    return hn::Mul(s, s);
  }

  V3 position_;  // of a directional light the unit vector towards it
  VF radiusSquared_;
  bool spot_, directional_;
  V3 axis_;
  VF cosOuter_, coneScale_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
