// The camera's rays through the pixels of a queue.
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/generate_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/random_streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

void GenerateRays(Chunk& c) noexcept {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const CameraFrame& camera = c.frame->camera;
  const RayColumns rays = c.rays;
  const uint32_t* const pixels = c.pixels.data() + c.first;
  const size_t n = c.n;
  const auto firstSlot = static_cast<uint32_t>(c.first);
  const uint32_t sampleNumber = c.sampleNumber, seed = c.frame->seed;
  const bool media = c.has(Feature::transmission), cones = c.has(Feature::cones);
  const bool streams = c.has(Feature::streams);
  const V3 eye = Broadcast3(Vec3f(camera.eye)), forward = Broadcast3(Vec3f(camera.forward));
  const V3 right = Broadcast3(Vec3f(camera.right)), up = Broadcast3(Vec3f(camera.up));
  const auto coneWidth = static_cast<float>(pixelCone(camera).width);
  // Whole pixels minus half the size are exact in float; the sample's place is added last.
  const VF shiftX = hn::Set(d, c.sample.x), shiftY = hn::Set(d, c.sample.y);
  const VF halfWidth = hn::Set(d, static_cast<float>(camera.width) / 2);
  const VF halfHeight = hn::Set(d, static_cast<float>(camera.height) / 2);
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
    hn::Store(hn::Iota(du, firstSlot + static_cast<uint32_t>(i)), du, rays.parent + i);
    if (media) hn::Store(hn::Set(du, camera.media), du, rays.media + i);
    if (cones) hn::Store(hn::Set(d, coneWidth), d, rays.cone + i);
    if (streams) hn::Store(StreamOfPixel(packed, sampleNumber, seed), du, rays.path + i);
  }
}

StepFunction FindGenerateRays(size_t /*index*/) { return GenerateRays; }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(GenerateRays)
}  // namespace whit::simd
#endif
