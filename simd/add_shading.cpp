// One light added to the radiance, where it is visible.
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/add_shading.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

void AddShading(Chunk& c) {
  const FloatTag d;
  const UnshadowedColumns unshadowed = c.unshadowed;
  const RadianceColumns radiance = c.radiance;
  const size_t n = c.n;

  for (size_t i = 0; i < n; i += Lanes(d)) {
    const MF visible = Gt(Load(unshadowed.visible, i), Zero());
    if (AllFalse(visible)) continue;

    const V3 light = Load3(unshadowed.rgb, i);
    const V3 sum = Load3(radiance.rgb, i);

    // The sum is selected, not multiplied by zero, because the light of an invisible slot may be
    // stale.
    Store3(Select3(visible, Add3(sum, light), sum), radiance.rgb, i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(AddShading)
}  // namespace whit::simd
#endif
