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
  x = Mul(Xor(x, ShiftRight<16>(x)), Set(kMixFirst));
  x = Mul(Xor(x, ShiftRight<13>(x)), Set(kMixSecond));
  return Xor(x, ShiftRight<16>(x));
}

HWY_INLINE VU StreamOfPixel(VU pixel, uint32_t sample, uint32_t seed) {
  return Add(Mixed(Add(pixel, Set(pixelSalt(seed)))), Set(sample * kSampleStep));
}

HWY_INLINE VU ChildStream(VU path, uint32_t branch) {
  return Mixed(Xor(path, Set(branch * kBranchStep)));
}

// Points of the unit square, [0, 1)^2.
struct UnitPoints {
  VF u, v;
};

HWY_INLINE VF UnitFraction(VU bits) {
  const FloatTag d;
  const IntTag di;
  return Mul(ConvertTo(d, BitCast(di, ShiftRight<8>(bits))), Set(0x1p-24f));
}

HWY_INLINE UnitPoints LobePoints(VU path, const LobeSampling& sampling, uint32_t k) {
  const VU shift = Sub(path, Set(sampling.unshift));
  const uint32_t index = sampling.first + k;
  return {UnitFraction(Add(shift, Set(index * sampling.lattice.u))),
          UnitFraction(Add(Mixed(Xor(shift, Set(kSecondShift))), Set(index * sampling.lattice.v)))};
}

HWY_INLINE UnitPoints SaltedPoints(VU path, const LobeSampling& sampling, uint32_t salt,
                                   uint32_t k) {
  const VU own = Xor(Sub(path, Set(sampling.unshift)), Set(salt));
  LobeSampling unshifted = sampling;
  unshifted.unshift = 0;
  return LobePoints(Mixed(own), unshifted, k);
}

HWY_INLINE UnitPoints LightPoints(VU path, const LobeSampling& sampling, uint32_t light,
                                  uint32_t k) {
  return SaltedPoints(path, sampling, lightSalt(light), k);
}

HWY_INLINE VF PathDraw(VU path, uint32_t salt) { return UnitFraction(Mixed(Xor(path, Set(salt)))); }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
