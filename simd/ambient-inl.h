// Ambient light that surfels reflect (the scalar reference: src/reference/
// write_emitted_and_reflective_ambient.cpp).
#if defined(WHIT_SIMD_AMBIENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_AMBIENT_INL_H_
#undef WHIT_SIMD_AMBIENT_INL_H_
#else
#define WHIT_SIMD_AMBIENT_INL_H_
#endif

#include "simd/glossy-inl.h"
#include "simd/material-inl.h"
#include "simd/sky-inl.h"
#include "stages/chunk.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

class ReflectedAmbient {
 public:
  HWY_INLINE explicit ReflectedAmbient(const Chunk& c)
      : tables_(c.tables()),
        rays_(c.rays),
        surfels_(c.surfels),
        // down + (up - down) * (1 + n.y) / 2 as middle + half * n.y
        middle_(Broadcast3((tables_.ambient.up + tables_.ambient.down) * 0.5f)),
        half_(Broadcast3((tables_.ambient.up - tables_.ambient.down) * 0.5f)),
        special_((c.materialFlags & (kMaterialDiffuses | kMaterialBlursSky)) != 0) {}

  // The ambient light at the surfels from i on; `hit` masks the lanes whose ray hit a surface.
  HWY_INLINE V3 At(size_t i, MF hit) const {
    const FloatTag d;
    const V3 ns = Load3(surfels_.nsX, surfels_.nsY, surfels_.nsZ, i);
    const V3 albedo = Load3(surfels_.diffuseR, surfels_.diffuseG, surfels_.diffuseB, i);
    const V3 all = Mul3(albedo, MulAdd3(half_, ns.y, middle_));
    if (HWY_LIKELY(!special_ || hn::AllFalse(d, hit))) return all;
    // Surfaces that reflect the scene do so in place of ambient light.
    const VI material = hn::Load(IntTag(), reinterpret_cast<const int32_t*>(surfels_.material) + i);
    const VU flags = MaterialLanes(tables_, material, hit).Lobe().flags;
    const V3 left = Select3(HasFlags(flags, kMaterialDiffuses), Broadcast3(Vec3f()), all);
    const MF blurs = hn::And(hit, HasFlags(flags, kMaterialBlursSky));
    if (hn::AllFalse(d, blurs)) return left;
    const V3 direction = Load3(rays_.dirX, rays_.dirY, rays_.dirZ, i);
    const VF towards = hn::Neg(Dot(ns, direction));
    const VF roughness = hn::Sqrt(hn::Load(d, surfels_.alpha + i));
    const V3 f0 = Load3(surfels_.specularR, surfels_.specularG, surfels_.specularB, i);
    const V3 lobe = LobeAlbedo(f0, hn::Max(towards, hn::Zero(d)), roughness);
    const V3 mirrored = Normalize3(MulAdd3(ns, hn::Add(towards, towards), direction));
    const V3 sky = BlurredRadiance(tables_.blurredSky, mirrored, roughness, blurs);
    return Select3(blurs, Add3(left, Mul3(sky, lobe)), left);
  }

 private:
  const ShadingTables& tables_;
  RayColumns rays_;
  SurfelColumns surfels_;
  V3 middle_, half_;
  bool special_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
