// The camera's rays through the pixels of a queue.
#include "simd/kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/generate_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep

#include "simd/random_streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Points of the unit disk that belong to points of the unit square (reference/generate_rays.cpp).
struct DiskPoints {
  VF x, y;
};

HWY_INLINE DiskPoints DiskPointsOf(const UnitPoints& square) {
  const FloatTag d;
  const VF one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
  const VF a = MulThenSub(two, square.u, one), b = MulThenSub(two, square.v, one);
  const MF byA = hn::Gt(hn::Abs(a), hn::Abs(b));
  const VF radius = hn::IfThenElse(byA, a, b), other = hn::IfThenElse(byA, b, a);
  const VF divisor = hn::IfThenElse(hn::Eq(radius, hn::Zero(d)), one, radius);
  const VF turn = hn::Mul(hn::Set(d, 0.785398163f), hn::Div(other, divisor));
  const VF along = hn::Mul(radius, hn::Cos(d, turn)), across = hn::Mul(radius, hn::Sin(d, turn));
  return {hn::IfThenElse(byA, along, across), hn::IfThenElse(byA, across, along)};
}

// Moves the starts of rays to points of the lens and turns the rays, so that they meet in the plane
// of focus where they met it before.
class Lens {
 public:
  explicit Lens(const CameraFrame& camera)
      : right_(Broadcast3(Vec3f(normalized(camera.right) * camera.aperture))),
        up_(Broadcast3(Vec3f(normalized(camera.up) * camera.aperture))) {
    // Neither factor of the sum is above 1, so that no component overflows.
    const double largest = std::max(camera.aperture, camera.focus);
    forward_ = hn::Set(FloatTag(), static_cast<float>(camera.focus / largest));
    turnRight_ = Broadcast3(Vec3f(normalized(camera.right) * (-camera.aperture / largest)));
    turnUp_ = Broadcast3(Vec3f(normalized(camera.up) * (-camera.aperture / largest)));
  }

  // `direction` reaches from the start to the plane at distance 1.
  HWY_INLINE void Bend(const DiskPoints& at, V3& origin, V3& direction) const {
    origin = MulAdd3(right_, at.x, MulAdd3(up_, at.y, origin));
    direction = MulAdd3(turnRight_, at.x, MulAdd3(turnUp_, at.y, Scale3(direction, forward_)));
  }

 private:
  V3 right_, up_, turnRight_, turnUp_;
  VF forward_;
};

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
  const Lens lens(camera);
  const bool hasLens = camera.aperture > 0;
  const LobeSampling lensSampling = lightSampling(0, 1, sampleNumber);
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
      direction = MulAdd3(right, x, MulAdd3(up, y, forward));
    }
    if (hasLens) {
      const VU path = StreamOfPixel(packed, sampleNumber, seed);
      lens.Bend(DiskPointsOf(SaltedPoints(path, lensSampling, kLensSalt, 0)), origin, direction);
    }
    if (hasLens || !camera.orthographic) direction = Normalize3(direction);
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

StepFunction FindGenerateRays() { return GenerateRays; }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(GenerateRays)
}  // namespace whit::simd
#endif
