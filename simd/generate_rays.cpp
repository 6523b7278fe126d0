#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/generate_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/random_streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

void GenerateRays(const CameraRays& camera, const uint32_t* pixels, size_t n,
                  const RayColumns& rays) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const V3 eye = Broadcast3(camera.eye), forward = Broadcast3(camera.forward);
  const V3 right = Broadcast3(camera.right), up = Broadcast3(camera.up);
  // Whole pixels minus half the size are exact in float; the sample's place is added last.
  const VF shiftX = hn::Set(d, camera.sampleX), shiftY = hn::Set(d, camera.sampleY);
  const VF halfWidth = hn::Set(d, camera.halfWidth), halfHeight = hn::Set(d, camera.halfHeight);
  const VF one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VU packed = hn::LoadU(du, pixels + i);
    const VI px = hn::BitCast(di, hn::And(packed, hn::Set(du, 0xFFFFu)));
    const VI py = hn::BitCast(di, hn::ShiftRight<16>(packed));
    const VF x = hn::Add(hn::Sub(hn::ConvertTo(d, px), halfWidth), shiftX);
    const VF y = hn::Sub(hn::Sub(halfHeight, hn::ConvertTo(d, py)), shiftY);
    V3 origin = eye, direction = forward;
    if (camera.orthographic) {
      origin = MulAdd3(right, x, MulAdd3(up, y, eye));
    } else {
      direction = Normalize3(MulAdd3(right, x, MulAdd3(up, y, forward)));
    }
    Store3(origin, rays.orgX, rays.orgY, rays.orgZ, i);
    Store3(direction, rays.dirX, rays.dirY, rays.dirZ, i);
    Store3({one, one, one}, rays.weightR, rays.weightG, rays.weightB, i);
    hn::Store(one, d, rays.throughput + i);
    hn::Store(hn::Iota(du, static_cast<uint32_t>(i)), du, rays.parent + i);
    if (rays.media) hn::Store(hn::Set(du, camera.media), du, rays.media + i);
    if (rays.cone) hn::Store(hn::Set(d, camera.coneWidth), d, rays.cone + i);
    if (rays.path) hn::Store(StreamOfPixel(packed, camera.sampleNumber), du, rays.path + i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(GenerateRays);
void generateRays(const CameraRays& camera, const std::uint32_t* pixels, std::size_t n,
                  const RayColumns& rays) noexcept {
  HWY_DYNAMIC_DISPATCH(GenerateRays)(camera, pixels, n, rays);
}
}  // namespace whit::simd
#endif
