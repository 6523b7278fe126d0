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

  for (size_t i = 0; i < n; i += Lanes(d)) {
    const VU material = Load(surfels.material, i);
    const MF hit = RebindMask(d, Ne(material, Set(kMiss)));

    // Surfaces send ambient light that no ray tests for occlusion, and emission.
    V3 result = black;
    if (ambient) result = reflected.At(i, hit);
    if (emission && !AllFalse(hit)) {
      V3 own = MaterialLanes(tables, BitCast(di, material), hit).Emission();
      if (factors) {
        own = Mul3(own, Load3(surfels.emission, i));
      }
      result = Add3(result, own);
    }

    // Only the share of the surface that is there sends light, and a hidden surface sends none.
    if (coverage) result = Scale3(result, Load(surfels.coverage, i));
    if (hidden) result = Select3(HasFlags(Load(surfels.flags, i), kHidden), black, result);

    if (AllTrue(hit)) {
      Store3(result, radiance.rgb, i);
      continue;
    }

    // Rays that left the scene see the sky.
    V3 beyond = black;
    if (sky) {
      const V3 direction = DirectionAt(rays, i);
      beyond = SkyRadiance(tables.sky, direction, AndNot(hit, hn::FirstN(d, n - i)));

      // A direction of 0 belongs to a pixel that sees nothing.
      const MF seen = Gt(MaxComponent(Abs3(direction)), Zero());
      beyond = Select3(seen, beyond, black);
    }

    Store3(Select3(hit, result, beyond), radiance.rgb, i);
  }
}

void AddFog(Chunk& c) {
  const FloatTag d;
  const UintTag du;
  const RayColumns rays = c.rays;
  const RadianceColumns radiance = c.radiance;
  const bool media = c.has(Feature::transmission);
  const V3 density = Broadcast3(c.tables().fog.density), color = Broadcast3(c.tables().fog.color);
  const VF zero = Zero(), one = Set(1.0f), opaque = Set(kOpaqueFog);

  for (size_t i = 0; i < c.n; i += Lanes(d)) {
    // A direction of 0 belongs to a pixel that sees nothing.
    MF fogged = Gt(MaxComponent(Abs3(DirectionAt(rays, i))), zero);
    if (media) {
      const VU stack = Load(rays.media, i);
      fogged = And(fogged, RebindMask(d, Eq(stack, Zero(du))));
    }
    if (AllFalse(fogged)) continue;

    const VU material = Load(c.surfels.material, i);
    const MF hit = RebindMask(d, Ne(material, Set(kMiss)));
    const VF t = Load(c.hits.t, i);

    // exp(sigma * t) - 1 in channels with fog.
    const auto growth = [&](VF sigma) HWY_ATTR {
      const VF depth = IfThenElse(hit, Min(Mul(sigma, t), opaque), opaque);
      const MF dims = And(fogged, Gt(sigma, zero));
      return hn::Expm1(d, IfThenElseZero(dims, depth));
    };
    const V3 more{growth(density.x), growth(density.y), growth(density.z)};

    const V3 sum = Load3(radiance.rgb, i);
    Store3(Add3(sum, Mul3(color, more)), radiance.rgb, i);
    DimRays(rays,
            {Div(one, Add(one, more.x)), Div(one, Add(one, more.y)), Div(one, Add(one, more.z))},
            i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(WriteEmittedAndReflectiveAmbient)
WHIT_EXPORT_KERNEL(AddFog)
}  // namespace whit::simd
#endif
