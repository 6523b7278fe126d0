// Ambient light at the surfels as if nothing occluded it, and the occlusion rays that test whether
// something does.
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/find_ambient_and_occlusion_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/ambient-inl.h"
#include "simd/lobes-inl.h"
#include "simd/new_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

void FindAmbientAndOcclusionRays(Chunk& c) {
  const FloatTag d;
  const UintTag du;
  const RayColumns rays = c.rays;
  const SurfelColumns surfels = c.surfels;
  const UnshadowedColumns unshadowed = c.unshadowed;
  const ShadowColumns shadows = c.shadows;

  const OffsetMethod offset = c.options().shading.offset;
  const bool nested = c.has(Feature::transmission), offsetsShadows = c.has(Feature::shadowOffset);
  const bool coverage = c.has(Feature::coverage);

  // Each of the samples carries an equal share of the ambient light.
  const VF zero = Zero(), share = Set(1.0f / static_cast<float>(c.lightSamples));
  const VF radius = Set(c.tables().ambient.occlusion);
  const LobeSampling points = lightSampling(c.depth, c.lightSamples, c.sampleNumber);
  const ReflectedAmbient ambient(c);

  size_t count = 0;
  for (size_t i = 0; i < c.n; i += Lanes(d)) {
    // Slots without an occlusion ray stay invisible; checkShadows writes the others.
    Store(zero, unshadowed.visible, i);

    // Misses and surfaces inside a dielectric of higher priority reflect nothing.
    MF live = SurfaceLanes(surfels, nested, i);
    if (AllFalse(live)) continue;

    // Occlusion rays are distributed by the cosine to the shading normal.
    const V3 ng = Load3(surfels.ng, i);
    const V3 ns = Load3(surfels.ns, i);
    const VU path = Load(rays.path, i);
    const V3 direction =
        CosineLobes(ns).Direction(LightPoints(path, points, c.lightNumber, c.lightSample));

    // A direction below the facet is occluded by the surface itself, unless the shading terminator
    // is smoothed.
    V3 start = Load3(surfels.pos, i);
    MF front = Gt(Dot(ng, direction), zero);
    if (offsetsShadows) OffsetShadowStart(surfels, i, start, front);

    // The surface reflects this light if nothing is in the way.
    V3 radiance = Scale3(ambient.At(i, live), share);
    if (coverage) radiance = Scale3(radiance, Load(surfels.coverage, i));
    live = And(live, And(front, Gt(MaxComponent(radiance), zero)));
    if (AllFalse(live)) continue;

    Store3(radiance, unshadowed.rgb, i);
    const V3 origin =
        RayOrigin(offset, start, ng, DirectionAt(rays, i), LoadClearance(surfels, i), 1.0f);
    const VU slot = hn::Iota(du, static_cast<uint32_t>(i));
    AppendShadowRays(shadows, live, origin, direction, radius, slot, count);
  }

  c.shadowCount = count;
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(FindAmbientAndOcclusionRays)
}  // namespace whit::simd
#endif
