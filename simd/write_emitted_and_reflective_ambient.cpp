// Radiance that surfels send to the viewer without a light source, and the sky where rays left the
// scene.
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/write_emitted_and_reflective_ambient.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/ambient-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

void WriteEmittedAndReflectiveAmbient(Chunk& c) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;

  const ShadingTables& tables = c.tables();
  const RayColumns rays = c.rays;
  const SurfelColumns surfels = c.surfels;
  const RadianceColumns radiance = c.radiance;
  const size_t n = c.n;

  // No surfel needs its material in a chunk where nothing emits.
  const bool emission = c.has(Feature::emission) && (c.materialFlags & kMaterialEmits) != 0;
  const bool factors = c.has(Feature::emissionFactors), ambient = c.has(Feature::ambient);
  const bool coverage = c.has(Feature::coverage);
  const bool sky = c.has(Feature::sky);
  const bool hidden = c.has(Feature::transmission);

  const V3 black = Broadcast3(Vec3f());
  const ReflectedAmbient reflected(c);

  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VU material = hn::Load(du, surfels.material + i);
    const MF hit = hn::RebindMask(d, hn::Ne(material, hn::Set(du, kMiss)));

    // Surfaces send ambient light that no ray tests for occlusion, and emission.
    V3 result = black;
    if (ambient) result = reflected.At(i, hit);
    if (emission && !hn::AllFalse(d, hit)) {
      V3 own = MaterialLanes(tables, hn::BitCast(di, material), hit).Emission();
      if (factors) {
        own = Mul3(own, Load3(surfels.emissionR, surfels.emissionG, surfels.emissionB, i));
      }
      result = Add3(result, own);
    }

    // Only the share of the surface that is there sends light, and a hidden surface sends none.
    if (coverage) result = Scale3(result, hn::Load(d, surfels.coverage + i));
    if (hidden) result = Select3(HasFlags(hn::Load(du, surfels.flags + i), kHidden), black, result);

    if (hn::AllTrue(d, hit)) {
      Store3(result, radiance.r, radiance.g, radiance.b, i);
      continue;
    }

    // Rays that left the scene see the sky.
    V3 beyond = black;
    if (sky) {
      const V3 direction = DirectionAt(rays, i);
      beyond = SkyRadiance(tables.sky, direction, hn::AndNot(hit, hn::FirstN(d, n - i)));

      // A direction of 0 belongs to a pixel that sees nothing.
      const MF seen = hn::Gt(MaxComponent(Abs3(direction)), hn::Zero(d));
      beyond = Select3(seen, beyond, black);
    }

    Store3(Select3(hit, result, beyond), radiance.r, radiance.g, radiance.b, i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(WriteEmittedAndReflectiveAmbient)
}  // namespace whit::simd
#endif
