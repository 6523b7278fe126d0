// Ambient light that surfels reflect (the scalar reference: src/reference/
// write_emitted_and_reflective_ambient.cpp).
#if defined(WHIT_SIMD_AMBIENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_AMBIENT_INL_H_
#undef WHIT_SIMD_AMBIENT_INL_H_
#else
#define WHIT_SIMD_AMBIENT_INL_H_
#endif

#include "simd/material-inl.h"
#include "stages/chunk.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

class ReflectedAmbient {
 public:
  HWY_INLINE explicit ReflectedAmbient(const Chunk& c)
      : tables_(c.tables()),
        surfels_(c.surfels),
        // down + (up - down) * (1 + n.y) / 2 as middle + half * n.y
        middle_(Broadcast3((tables_.ambient.up + tables_.ambient.down) * 0.5f)),
        half_(Broadcast3((tables_.ambient.up - tables_.ambient.down) * 0.5f)),
        indirect_((c.materialFlags & kMaterialDiffuses) != 0) {}

  // The ambient light at the surfels from i on; `hit` masks the lanes whose ray hit a surface.
  HWY_INLINE V3 At(size_t i, MF hit) const {
    const FloatTag d;
    const VF ny = hn::Load(d, surfels_.nsY + i);
    const V3 albedo = Load3(surfels_.diffuseR, surfels_.diffuseG, surfels_.diffuseB, i);
    const V3 all = Mul3(albedo, MulAdd3(half_, ny, middle_));
    if (HWY_LIKELY(!indirect_ || hn::AllFalse(d, hit))) return all;
    // Surfaces that reflect the scene do so in place of ambient light.
    const VI material = hn::Load(IntTag(), reinterpret_cast<const int32_t*>(surfels_.material) + i);
    const VU flags = MaterialLanes(tables_, material, hit).Lobe().flags;
    return Select3(HasFlags(flags, kMaterialDiffuses), Broadcast3(Vec3f()), all);
  }

 private:
  const ShadingTables& tables_;
  SurfelColumns surfels_;
  V3 middle_, half_;
  bool indirect_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
