// One light at the surfels, as if nothing were in its way, and the rays that find out.
#include "simd/kernels.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/find_radiance_and_shadow_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "scene/light.h"
#include "simd/lobes-inl.h"
#include "simd/material-inl.h"
#include "simd/new_rays-inl.h"
#include "simd/random_streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Light that arrives from a light source of any kind.
class LightLanes {
 public:
  // Without `cones` a spot light shines to all sides.
  HWY_INLINE LightLanes(const Light& light, bool cones)
      : spot_(cones && light.kind == Light::Kind::spot),
        directional_(light.kind == Light::Kind::directional) {
    position_ = Broadcast3(directional_ ? Vec3f(towards(light, {})) : light.position);
    radiusSquared_ = Set(light.radius * light.radius);
    const SpotCone cone = spot_ ? coneOf(light) : SpotCone();
    axis_ = Broadcast3(Vec3f(cone.axis));
    cosOuter_ = Set(static_cast<float>(cone.cosOuter));
    coneScale_ = Set(static_cast<float>(cone.scale));
  }

  // Returns the vector to the light, of length 1 if the light is directional.
  HWY_INLINE V3 Towards(const V3& from) const {
    return directional_ ? position_ : Sub3(position_, from);
  }

  // True in lanes that the cone reaches. The test is not exact where the light has almost fallen
  // off to nothing.
  HWY_INLINE MF Within(MF live, const V3& toLight, VF distanceSquared) const {
    if (!spot_) return live;
    const VF along = Neg(Dot(axis_, toLight)), zero = Zero();
    const VF edge = Mul(Mul(cosOuter_, cosOuter_), distanceSquared);
    return And(live, And(Gt(along, zero), Gt(Mul(along, along), edge)));
  }

  // The area by which the intensity is divided at this distance.
  HWY_INLINE VF Area(VF distanceSquared) const { return Max(distanceSquared, radiusSquared_); }

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
    const VF one = Set(1.0f), two = Set(2.0f);
    const VF squared = Dot(toCenter, toCenter);
    const MF outside = Gt(squared, radiusSquared_);
    const VF safe = IfThenElse(outside, squared, one);
    const VF distance = Sqrt(safe);
    const VF sine2 = Div(IfThenElseZero(outside, radiusSquared_), safe);
    const VF height = Div(sine2, Add(one, Sqrt(Sub(one, sine2))));
    const VF h = Mul(at.u, height), turn = Mul(at.v, Set(6.28318531f));
    const VF s = Sqrt(Mul(h, Sub(two, h)));
    const V3 z = Scale3(toCenter, Div(one, distance));
    const V3 x = UnitAcross(z, 0.5f), y = Cross(z, x);
    const V3 l = MulAdd3(x, Mul(s, hn::Cos(d, turn)),
                         MulAdd3(y, Mul(s, hn::Sin(d, turn)), Scale3(z, Sub(one, h))));
    const VF far = Mul(Sub(one, at.u), NegMulThenAdd(height, Add(one, at.u), two));
    const VF inside = Sqrt(Div(far, Sub(two, height)));
    const VF toPoint = NegMulThenAdd(Sqrt(radiusSquared_), inside, Mul(distance, Sub(one, h)));
    const VF area = Div(radiusSquared_, Add(height, height));
    return {Select3(outside, Scale3(l, toPoint), toCenter),
            IfThenElse(outside, area, Area(squared))};
  }

  // The share of the intensity that a surface receives; `nl` is the cosine at the surface, `l` the
  // direction.
  HWY_INLINE VF Falloff(VF nl, const V3& l, VF area) const {
    if (directional_) return nl;
    const VF falloff = Div(nl, area);
    return spot_ ? Mul(falloff, Cone(l)) : falloff;
  }

  // Where shadow rays end, in lengths of Towards().
  HWY_INLINE VF Reach() const {
    return Set(directional_ ? std::numeric_limits<float>::infinity() : kShadowReach);
  }

 private:
  // SpotCone::falloff.
  HWY_INLINE VF Cone(const V3& l) const {
    const VF inside = Sub(Neg(Dot(axis_, l)), cosOuter_);
    const VF s = Clamped01(Mul(inside, coneScale_));
    return Mul(s, s);
  }

  V3 position_;  // or the unit vector towards a directional light
  VF radiusSquared_;
  bool spot_, directional_;
  V3 axis_;
  VF cosOuter_, coneScale_;
};

// GGX lobe with height-correlated Smith masking (Walter et al. 2007; Heitz 2014, equation 99) and
// Schlick's Fresnel term, from f0 to f90.
HWY_INLINE V3 GlossyLobe(const V3& f0, VF f90, VF alpha, VF nl, VF nv, const V3& n, const V3& h,
                         VF vh) {
  const VF a2 = Mul(alpha, alpha);
  // (n.h)^2 (a2 - 1) + 1 with the sine from the cross product: next to the highlight of a narrow
  // lobe the cosine alone has lost it (4 digits at alpha = 0.001).
  const VF nh = Dot(n, h);
  const V3 across = Cross(n, h);
  const VF denominator = MulThenAdd(Mul(nh, nh), a2, Dot(across, across));
  const VF distribution = Div(a2, Mul(Set(3.14159265f), Mul(denominator, denominator)));
  const VF rest = Sub(Set(1.0f), a2);
  const VF maskV = Mul(nl, Sqrt(MulThenAdd(Mul(nv, nv), rest, a2)));
  const VF maskL = Mul(nv, Sqrt(MulThenAdd(Mul(nl, nl), rest, a2)));
  const VF visibility = Div(Set(0.5f), Add(maskV, maskL));
  return Scale3(SchlickColor(f0, {f90, f90, f90}, vh), Mul(distribution, visibility));
}

// The light of the lobe, of which coats of the surfels at i leave what they do not reflect.
// `cosine`: between viewer and normal.
HWY_INLINE V3 UnderCoat(const Chunk& c, const V3& lobe, VF cosine, MF shiny, size_t i) {
  const SurfelColumns& surfels = c.surfels;
  const VI number = MaterialNumbers(surfels, i);
  const MaterialLanes material(c.tables(), number, shiny);
  const MF coated = And(shiny, HasFlags(material.Lobe().flags, kMaterialIsUnderCoat));
  if (AllFalse(coated)) return lobe;
  const VF towards = Clamped01(cosine);
  const V3 coat = MirrorReflectance(material, surfels, c.has(Feature::mirrorMaps), towards, i);
  return Select3(coated, Mul3(lobe, Complement3(coat)), lobe);
}

// Returns the share of the light from this distance that the fog lets through.
HWY_INLINE V3 ThroughFog(const Fog& fog, VF distance) {
  const FloatTag d;
  const V3 density = Broadcast3(fog.density);
  const auto left = [&](VF sigma) HWY_ATTR {
    const VF depth = Min(Mul(sigma, distance), Set(kOpaqueFog));
    return hn::Exp(d, Neg(depth));
  };
  return {left(density.x), left(density.y), left(density.z)};
}

void FindRadianceAndShadowRays(Chunk& c) {
  const FloatTag d;
  const UintTag du;
  const ShadingChoices choices = c.options().shading;
  const Light& light = *c.light;
  const RayColumns rays = c.rays;
  const SurfelColumns surfels = c.surfels;
  const UnshadowedColumns unshadowed = c.unshadowed;
  const ShadowColumns shadows = c.shadows;
  const size_t n = c.n;
  const bool traced = c.has(Feature::shadows), nested = c.has(Feature::transmission);
  const bool offsetsShadows = c.has(Feature::shadowOffset), coverage = c.has(Feature::coverage);
  const bool fog = c.has(Feature::fog) && light.kind != Light::Kind::directional;
  const bool glossy = c.has(Feature::glossy) && (c.materialFlags & kMaterialGlossy) != 0;
  const bool coats = (c.materialFlags & kMaterialIsUnderCoat) != 0;
  const VF zero = Zero(), one = Set(1.0f);
  const LightLanes lanes(light, c.has(Feature::spotLights));
  const V3 intensity = Broadcast3(light.intensity);

  size_t count = 0;
  // One point of several of a light with a radius.
  const bool sampled = c.lightSamples > 1;
  const LobeSampling points = lightSampling(c.depth, c.lightSamples, c.sampleNumber);
  const VF share = Set(1.0f / static_cast<float>(c.lightSamples));

  for (size_t i = 0; i < n; i += Lanes(d)) {
    MF live = SurfaceLanes(surfels, nested, i);
    const V3 position = Load3(surfels.pos, i);
    const V3 ng = Load3(surfels.ng, i);
    const V3 ns = Load3(surfels.ns, i);

    // The light is looked at from the surfel, or one of its points is.
    V3 toLight = lanes.Towards(position);
    VF distanceSquared = Dot(toLight, toLight), area = lanes.Area(distanceSquared);
    if (HWY_UNLIKELY(sampled)) {
      const VU path = Load(rays.path, i);
      const auto view =
          lanes.Look(toLight, LightPoints(path, points, c.lightNumber, c.lightSample));
      toLight = view.toPoint;
      area = view.area;
      distanceSquared = Dot(toLight, toLight);
    }

    // Surfels that turn away from the light, or that it does not reach, are done.
    MF front = Gt(Dot(ng, toLight), zero);
    V3 start = position;
    if (offsetsShadows) OffsetShadowStart(surfels, i, start, front);
    live = And(live, And(front, Gt(Dot(ns, toLight), zero)));
    live = lanes.Within(And(live, Gt(distanceSquared, zero)), toLight, distanceSquared);
    if (AllFalse(live)) {
      Store(zero, unshadowed.visible, i);
      continue;
    }

    // The radiance is the light's, by the diffuse color and the glossy lobe.
    const VF inverseDistance = InverseSqrt(distanceSquared);
    const V3 l = Scale3(toLight, inverseDistance);
    const VF nl = Dot(ns, l);
    V3 bsdf = Scale3(Load3(surfels.diffuse, i), Set(0.318309886f));

    if (glossy) {
      const V3 f0 = Load3(surfels.specular, i);
      const MF shiny = And(live, Gt(MaxComponent(f0), zero));
      if (!AllFalse(shiny)) {
        const V3 direction = DirectionAt(rays, i);
        const V3 v = Neg3(direction);
        const V3 h = NormalizeOr(Add3(l, v), ns);
        const VF nv = Max(Dot(ns, v), Set(static_cast<float>(kLeastCosine)));
        const VF alpha = Load(surfels.alpha, i);
        const VF f90 = LobeGrazing(c.tables(), surfels, f0, i);
        V3 lobe = GlossyLobe(f0, f90, alpha, nl, nv, ns, h, Dot(v, h));
        if (HWY_UNLIKELY(coats)) lobe = UnderCoat(c, lobe, Dot(ns, v), shiny, i);
        bsdf = Select3(shiny, Add3(bsdf, lobe), bsdf);
      }
    }

    V3 radiance = Scale3(Mul3(bsdf, intensity), lanes.Falloff(nl, l, area));
    if (coverage) radiance = Scale3(radiance, Load(surfels.coverage, i));

    if (fog) {
      const VF distance = Mul(distanceSquared, inverseDistance);
      radiance = Mul3(radiance, ThroughFog(c.tables().fog, distance));
    }

    // Light that is too weak for --light-cutoff is left out.
    const VF largest = MaxComponent(radiance);
    live = And(live, Gt(largest, zero));
    if (choices.lightCutoff > 0) {
      const VF contribution = Mul(Load(rays.throughput, i), largest);
      live = And(live, Ge(contribution, Set(choices.lightCutoff)));
    }

    Store3(sampled ? Scale3(radiance, share) : radiance, unshadowed.rgb, i);
    if (!traced) {
      Store(IfThenElseZero(live, one), unshadowed.visible, i);
      continue;
    }

    Store(zero, unshadowed.visible, i);
    const V3 origin =
        RayOrigin(choices.offset, start, ng, DirectionAt(rays, i), LoadClearance(surfels, i), 1.0f);
    const V3 direction = sampled ? Sub3(Add3(position, toLight), origin) : lanes.Towards(origin);
    const VU slot = hn::Iota(du, static_cast<uint32_t>(i));
    AppendShadowRays(shadows, live, origin, direction, lanes.Reach(), slot, count);
  }
  c.shadowCount = count;
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(FindRadianceAndShadowRays)
}  // namespace whit::simd
#endif
