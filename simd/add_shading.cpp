#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/add_shading.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

void AddShading(const UnshadowedColumns& unshadowed, size_t n, const RadianceColumns& radiance) {
  const FloatTag d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const MF visible = hn::Gt(hn::Load(d, unshadowed.visible + i), hn::Zero(d));
    if (hn::AllFalse(d, visible)) continue;
    const V3 light = Load3(unshadowed.r, unshadowed.g, unshadowed.b, i);
    const V3 sum = Load3(radiance.r, radiance.g, radiance.b, i);
    // Selected, not multiplied by zero: a dark slot's light may be stale.
    Store3(Select3(visible, Add3(sum, light), sum), radiance.r, radiance.g, radiance.b, i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(AddShading);
void addShading(const UnshadowedColumns& unshadowed, std::size_t n,
                const RadianceColumns& radiance) noexcept {
  HWY_DYNAMIC_DISPATCH(AddShading)(unshadowed, n, radiance);
}
}  // namespace whit::simd
#endif
