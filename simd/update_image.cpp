// The 8-bit half of updateImage.
#include "core/display.h"
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/update_image.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// 255 * srgb(x) for x in [0, 1], off by at most kNear: from the interpolation of t^(5/3) in
// t = x^(1/4) at the seven Chebyshev nodes of [0.2365, 1], which is off by 0.00055; float adds
// 1e-4.
constexpr float kNear = 0x1p-10f;
HWY_INLINE VF NearCode(VF x) {
  const FloatTag d;
  const VF t = hn::Sqrt(hn::Sqrt(x));
  VF curve = MulThenAdd(t, hn::Set(d, 15.7422484f), hn::Set(d, -75.0331475f));
  curve = MulThenAdd(t, curve, hn::Set(d, 158.355582f));
  curve = MulThenAdd(t, curve, hn::Set(d, -210.446404f));
  curve = MulThenAdd(t, curve, hn::Set(d, 345.416025f));
  curve = MulThenAdd(t, curve, hn::Set(d, 36.1993571f));
  curve = MulThenAdd(t, curve, hn::Set(d, -15.2334479f));

  // The transfer function of sRGB is a line up to 0.0031308.
  const VF line = hn::Mul(x, hn::Set(d, 255 * 12.92f));
  return hn::IfThenElse(hn::Gt(x, hn::Set(d, 0.0031308f)), curve, line);
}

// round(255 * srgb(x)), exactly as the scalar srgbCode of the same float.
HWY_INLINE VU SrgbCode(const float* leastOfCodes, VF x) {
  const FloatTag d;
  const IntTag di;
  const VF one = hn::Set(d, 1.0f);

  // A comparison that NaN fails makes NaN 0 on every target.
  const VF clamped = hn::Min(hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x), one);

  // Rounding down the lower bound gives the least possible code. The code is larger, by one, only
  // where the next whole number is near: in one lane of 500. There the least float of the next code
  // decides.
  const VF least = hn::Add(NearCode(clamped), hn::Set(d, 0.5f - kNear));
  const VF whole = hn::Floor(least);
  const VI code = hn::ConvertTo(di, whole);
  const MF open = hn::Ge(hn::Sub(least, whole), hn::Set(d, 1 - 2 * kNear));
  if (HWY_LIKELY(hn::AllFalse(d, open))) return hn::BitCast(UintTag(), code);

  const VF next = hn::GatherIndex(d, leastOfCodes, hn::Add(code, hn::Set(di, 1)));
  const VI step = hn::IfThenElseZero(hn::RebindMask(di, hn::Ge(clamped, next)), hn::Set(di, 1));
  return hn::BitCast(UintTag(), hn::Add(code, step));
}

// Hable's shoulder-and-toe curve (2010), scaled so that 11.2 becomes 1.
HWY_INLINE VF HableCurve(VF x) {
  const FloatTag d;
  const VF a = hn::Set(d, 0.15f), b = hn::Set(d, 0.50f), cb = hn::Set(d, 0.05f);
  const VF de = hn::Set(d, 0.20f * 0.02f), df = hn::Set(d, 0.20f * 0.30f);
  const VF numerator = MulThenAdd(x, MulThenAdd(a, x, cb), de);
  const VF denominator = MulThenAdd(x, MulThenAdd(a, x, b), df);
  return hn::Sub(hn::Div(numerator, denominator), hn::Set(d, 0.02f / 0.30f));
}

HWY_INLINE VF ToneCurved(ToneCurve curve, VF x) {
  const FloatTag d;
  const VF positive = hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x);

  switch (curve) {
    case ToneCurve::reinhard: {
      // Infinity stays 1, not infinity over infinity.
      const VF bounded = hn::Min(positive, hn::Set(d, 1e30f));
      return hn::Div(bounded, hn::Add(bounded, hn::Set(d, 1.0f)));
    }
    case ToneCurve::filmic: {
      const VF bounded = hn::Min(positive, hn::Set(d, 1e15f));
      return hn::Div(HableCurve(bounded), HableCurve(hn::Set(d, 11.2f)));
    }
    case ToneCurve::none:
      break;
  }
  return positive;
}

void EncodeDisplay(const EncodeArgs& args) {
  const FloatTag d;
  const UintTag du;

  const float* leastOfCodes = leastWithCodes().data();
  const ToneCurve curve = args.curve;
  const RadianceColumns radiance = args.radiance;
  const VF scale = hn::Set(d, args.exposureScale);

  for (size_t i = 0; i < args.n; i += hn::Lanes(d)) {
    const auto encode = [&](const float* column) HWY_ATTR {
      return SrgbCode(leastOfCodes, ToneCurved(curve, hn::Mul(hn::Load(d, column + i), scale)));
    };

    const VU r = encode(radiance.rgb.x), g = hn::ShiftLeft<8>(encode(radiance.rgb.y));
    const VU b = hn::ShiftLeft<16>(encode(radiance.rgb.z));
    hn::StoreU(hn::Or(hn::Or(r, g), hn::Or(b, hn::Set(du, 0xFF000000u))), du, args.codes + i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(EncodeDisplay);
void encodeDisplay(const EncodeArgs& args) noexcept { HWY_DYNAMIC_DISPATCH(EncodeDisplay)(args); }
}  // namespace whit::simd
#endif
