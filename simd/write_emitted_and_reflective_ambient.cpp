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
        own = Mul3(own, Load3(surfels.emission, i));
      }
      result = Add3(result, own);
    }

    // Only the share of the surface that is there sends light, and a hidden surface sends none.
    if (coverage) result = Scale3(result, hn::Load(d, surfels.coverage + i));
    if (hidden) result = Select3(HasFlags(hn::Load(du, surfels.flags + i), kHidden), black, result);

    if (hn::AllTrue(d, hit)) {
      Store3(result, radiance.rgb, i);
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
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f), opaque = hn::Set(d, kOpaqueFog);

  for (size_t i = 0; i < c.n; i += hn::Lanes(d)) {
    // A direction of 0 belongs to a pixel that sees nothing.
    MF fogged = hn::Gt(MaxComponent(Abs3(DirectionAt(rays, i))), zero);
    if (media) {
      const VU stack = hn::Load(du, rays.media + i);
      fogged = hn::And(fogged, hn::RebindMask(d, hn::Eq(stack, hn::Zero(du))));
    }
    if (hn::AllFalse(d, fogged)) continue;

    const VU material = hn::Load(du, c.surfels.material + i);
    const MF hit = hn::RebindMask(d, hn::Ne(material, hn::Set(du, kMiss)));
    const VF t = hn::Load(d, c.hits.t + i);

    // exp(sigma * t) - 1 in channels with fog.
    const auto growth = [&](VF sigma) HWY_ATTR {
      const VF depth = hn::IfThenElse(hit, hn::Min(hn::Mul(sigma, t), opaque), opaque);
      const MF dims = hn::And(fogged, hn::Gt(sigma, zero));
      return hn::Expm1(d, hn::IfThenElseZero(dims, depth));
    };
    const V3 more{growth(density.x), growth(density.y), growth(density.z)};
    const V3 left{hn::Div(one, hn::Add(one, more.x)), hn::Div(one, hn::Add(one, more.y)),
                  hn::Div(one, hn::Add(one, more.z))};

    const V3 sum = Load3(radiance.rgb, i);
    Store3(Add3(sum, Mul3(color, more)), radiance.rgb, i);
    const V3 weight = Load3(rays.weight, i);
    Store3(Mul3(weight, left), rays.weight, i);
    const VF throughput = hn::Load(d, rays.throughput + i);
    hn::Store(hn::Mul(throughput, MaxComponent(left)), d, rays.throughput + i);
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
