// Random numbers of paths (the scalar reference: src/sampling/random_streams.h; the bits are the
// same).
#if defined(WHIT_SIMD_RANDOM_STREAMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_RANDOM_STREAMS_INL_H_
#undef WHIT_SIMD_RANDOM_STREAMS_INL_H_
#else
#define WHIT_SIMD_RANDOM_STREAMS_INL_H_
#endif

#include "sampling/random_streams.h"
#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

HWY_INLINE VU Mixed(VU x) {
  const UintTag du;
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<16>(x)), hn::Set(du, kMixFirst));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<13>(x)), hn::Set(du, kMixSecond));
  return hn::Xor(x, hn::ShiftRight<16>(x));
}

HWY_INLINE VU StreamOfPixel(VU pixel, uint32_t sample, uint32_t seed) {
  const UintTag du;
  return hn::Add(Mixed(hn::Add(pixel, hn::Set(du, pixelSalt(seed)))),
                 hn::Set(du, sample * kSampleStep));
}

HWY_INLINE VU ChildStream(VU path, uint32_t branch) {
  return Mixed(hn::Xor(path, hn::Set(UintTag(), branch * kBranchStep)));
}

// Points of the unit square, [0, 1)^2.
struct UnitPoints {
  VF u, v;
};

HWY_INLINE VF UnitFraction(VU bits) {
  const FloatTag d;
  const IntTag di;
  return hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(bits))), hn::Set(d, 0x1p-24f));
}

HWY_INLINE UnitPoints LobePoints(VU path, const LobeSampling& sampling, uint32_t k) {
  const UintTag du;
  const VU shift = hn::Sub(path, hn::Set(du, sampling.unshift));
  const uint32_t index = sampling.first + k;
  return {UnitFraction(hn::Add(shift, hn::Set(du, index * kLatticeU))),
          UnitFraction(hn::Add(Mixed(hn::Xor(shift, hn::Set(du, kSecondShift))),
                               hn::Set(du, index * kLatticeV)))};
}

HWY_INLINE UnitPoints SaltedPoints(VU path, const LobeSampling& sampling, uint32_t salt,
                                   uint32_t k) {
  const UintTag du;
  const VU own = hn::Xor(hn::Sub(path, hn::Set(du, sampling.unshift)), hn::Set(du, salt));
  return LobePoints(Mixed(own), {sampling.count, sampling.first, 0}, k);
}

HWY_INLINE UnitPoints LightPoints(VU path, const LobeSampling& sampling, uint32_t light,
                                  uint32_t k) {
  return SaltedPoints(path, sampling, lightSalt(light), k);
}

HWY_INLINE VF PathDraw(VU path, uint32_t salt) {
  return UnitFraction(Mixed(hn::Xor(path, hn::Set(UintTag(), salt))));
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
