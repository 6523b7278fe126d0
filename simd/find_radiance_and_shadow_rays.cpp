// One light at the surfels, as if nothing were in its way, and the rays that find out.
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/find_radiance_and_shadow_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/compact-inl.h"
#include "simd/light-inl.h"
#include "simd/ray_origin-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// GGX lobe with height-correlated Smith masking (Walter et al. 2007; Heitz 2014, equation 99) and
// Schlick's Fresnel term, whose grazing value fades out for reflectances below 4 %.
HWY_INLINE V3 GlossyLobe(const V3& f0, VF alpha, VF nl, VF nv, const V3& n, const V3& h, VF vh) {
  const FloatTag d;
  const VF one = hn::Set(d, 1.0f);
  const VF a2 = hn::Mul(alpha, alpha);
  // (n.h)^2 (a2 - 1) + 1 with the sine from the cross product: next to the highlight of a narrow
  // lobe the cosine alone has lost it (4 digits at alpha = 0.001).
  const VF nh = Dot(n, h);
  const V3 across = Cross(n, h);
  const VF denominator = MulThenAdd(hn::Mul(nh, nh), a2, Dot(across, across));
  const VF distribution =
      hn::Div(a2, hn::Mul(hn::Set(d, 3.14159265f), hn::Mul(denominator, denominator)));
  const VF rest = hn::Sub(one, a2);
  const VF maskV = hn::Mul(nl, hn::Sqrt(MulThenAdd(hn::Mul(nv, nv), rest, a2)));
  const VF maskL = hn::Mul(nv, hn::Sqrt(MulThenAdd(hn::Mul(nl, nl), rest, a2)));
  const VF visibility = hn::Div(hn::Set(d, 0.5f), hn::Add(maskV, maskL));
  const VF f90 = hn::Min(one, hn::Mul(hn::Set(d, 25.0f), MaxComponent(f0)));
  const VF m = hn::Sub(one, vh), m2 = hn::Mul(m, m);
  const VF schlick = hn::Mul(hn::Mul(m2, m2), m);
  const VF scale = hn::Mul(distribution, visibility);
  const V3 grazing{hn::Sub(f90, f0.x), hn::Sub(f90, f0.y), hn::Sub(f90, f0.z)};
  return Scale3(MulAdd3(grazing, schlick, f0), scale);
}

void FindRadianceAndShadowRays(Chunk& c) noexcept {
  const FloatTag d;
  const UintTag du;
  const ShadingChoices choices = c.options().shading;
  const Light& light = *c.light;
  const RayColumns rays = c.rays;
  const SurfelColumns surfels = c.surfels;
  const UnshadowedColumns unshadowed = c.unshadowed;
  const ShadowColumns shadows = c.shadows;
  const size_t n = c.n;
  const bool traced = c.has(Feature::shadows), hidden = c.has(Feature::transmission);
  const bool lifted = c.has(Feature::lift), coverage = c.has(Feature::coverage);
  const bool glossy = c.has(Feature::glossy) && (c.materialFlags & kMaterialGlossy) != 0;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const LightLanes lanes(light, c.has(Feature::spotLights));
  const V3 intensity = Broadcast3(light.intensity);
  size_t count = 0;
  // One point of several of a light with a radius.
  const bool sampled = c.lightSamples > 1;
  const LobeSampling points = lightSampling(c.depth, c.lightSamples, c.sampleNumber);
  const VF share = hn::Set(d, 1.0f / static_cast<float>(c.lightSamples));
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VU material = hn::Load(du, surfels.material + i);
    MF live = hn::RebindMask(d, hn::Ne(material, hn::Set(du, kMiss)));
    if (hidden) {
      const VU flags = hn::Load(du, surfels.flags + i);
      live = hn::And(live,
                     hn::RebindMask(d, hn::Eq(hn::And(flags, hn::Set(du, kHidden)), hn::Zero(du))));
    }
    const V3 position = Load3(surfels.posX, surfels.posY, surfels.posZ, i);
    const V3 ng = Load3(surfels.ngX, surfels.ngY, surfels.ngZ, i);
    const V3 ns = Load3(surfels.nsX, surfels.nsY, surfels.nsZ, i);
    V3 toLight = lanes.Towards(position);
    VF distanceSquared = Dot(toLight, toLight), area = lanes.Area(distanceSquared);
    if (HWY_UNLIKELY(sampled)) {
      const VU path = hn::Load(du, rays.path + i);
      const auto view =
          lanes.Look(toLight, LightPoints(path, points, c.lightNumber, c.lightSample));
      toLight = view.toPoint;
      area = view.area;
      distanceSquared = Dot(toLight, toLight);
    }
    MF front = hn::Gt(Dot(ng, toLight), zero);
    V3 start = position;
    if (lifted) {
      // Above the facet, the smooth surface alone decides what lies behind the horizon.
      const V3 lift = Load3(surfels.liftX, surfels.liftY, surfels.liftZ, i);
      front = hn::Or(front, hn::Gt(MaxComponent(Abs3(lift)), zero));
      start = Add3(position, lift);
    }
    live = hn::And(live, hn::And(front, hn::Gt(Dot(ns, toLight), zero)));
    live = lanes.Within(hn::And(live, hn::Gt(distanceSquared, zero)), toLight, distanceSquared);
    if (hn::AllFalse(d, live)) {
      hn::Store(zero, d, unshadowed.visible + i);
      continue;
    }
    const VF inverseDistance = InverseSqrt(distanceSquared);
    const V3 l = Scale3(toLight, inverseDistance);
    const VF nl = Dot(ns, l);
    V3 bsdf = Scale3(Load3(surfels.diffuseR, surfels.diffuseG, surfels.diffuseB, i),
                     hn::Set(d, 0.318309886f));
    if (glossy) {
      const V3 f0 = Load3(surfels.specularR, surfels.specularG, surfels.specularB, i);
      const MF shiny = hn::And(live, hn::Gt(MaxComponent(f0), zero));
      if (!hn::AllFalse(d, shiny)) {
        const V3 direction = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
        const V3 v{hn::Neg(direction.x), hn::Neg(direction.y), hn::Neg(direction.z)};
        const V3 h = NormalizeOr(Add3(l, v), ns);
        const VF nv = hn::Max(Dot(ns, v), hn::Set(d, 1e-4f));
        const VF alpha = hn::Load(d, surfels.alpha + i);
        const V3 lobe = GlossyLobe(f0, alpha, nl, nv, ns, h, Dot(v, h));
        bsdf = Select3(shiny, Add3(bsdf, lobe), bsdf);
      }
    }
    V3 radiance = Scale3(Mul3(bsdf, intensity), lanes.Falloff(nl, l, area));
    if (coverage) radiance = Scale3(radiance, hn::Load(d, surfels.coverage + i));
    const VF largest = MaxComponent(radiance);
    live = hn::And(live, hn::Gt(largest, zero));
    if (choices.lightCutoff > 0) {
      const VF contribution = hn::Mul(hn::Load(d, rays.throughput + i), largest);
      live = hn::And(live, hn::Ge(contribution, hn::Set(d, choices.lightCutoff)));
    }
    Store3(sampled ? Scale3(radiance, share) : radiance, unshadowed.r, unshadowed.g, unshadowed.b,
           i);
    if (!traced) {
      hn::Store(hn::IfThenElseZero(live, one), d, unshadowed.visible + i);
      continue;
    }
    hn::Store(zero, d, unshadowed.visible + i);
    const V3 origin =
        RayOrigin(choices.offset, start, ng, Load3(rays.dirX, rays.dirY, rays.dirZ, i),
                  LoadClearance(surfels, i), 1.0f);
    const Compactor lit(live);
    lit.Store(origin, shadows.orgX, shadows.orgY, shadows.orgZ, count);
    const V3 way = sampled ? Sub3(Add3(position, toLight), origin) : lanes.Towards(origin);
    lit.Store(way, shadows.dirX, shadows.dirY, shadows.dirZ, count);
    lit.Store(lanes.Reach(), shadows.tFar + count);
    lit.Store(hn::Iota(du, static_cast<uint32_t>(i)), shadows.slot + count);
    count += lit.Count();
  }
  c.shadowCount = count;
}

StepFunction FindFindRadianceAndShadowRays() { return FindRadianceAndShadowRays; }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(FindRadianceAndShadowRays)
}  // namespace whit::simd
#endif
