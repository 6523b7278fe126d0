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
  const VF t = Sqrt(Sqrt(x));
  VF curve = MulThenAdd(t, Set(15.7422484f), Set(-75.0331475f));
  curve = MulThenAdd(t, curve, Set(158.355582f));
  curve = MulThenAdd(t, curve, Set(-210.446404f));
  curve = MulThenAdd(t, curve, Set(345.416025f));
  curve = MulThenAdd(t, curve, Set(36.1993571f));
  curve = MulThenAdd(t, curve, Set(-15.2334479f));

  // The transfer function of sRGB is a line up to 0.0031308.
  const VF line = Mul(x, Set(255 * 12.92f));
  return IfThenElse(Gt(x, Set(0.0031308f)), curve, line);
}

// round(255 * srgb(x)), exactly as the scalar srgbCode of the same float.
HWY_INLINE VU SrgbCode(const float* leastOfCodes, VF x) {
  const FloatTag d;
  const IntTag di;
  const VF one = Set(1.0f);

  // A comparison that NaN fails makes NaN 0 on every target.
  const VF clamped = Min(IfThenElseZero(Gt(x, Zero()), x), one);

  // Rounding down the lower bound gives the least possible code. The code is larger, by one, only
  // where the next whole number is near: in one lane of 500. There the least float of the next code
  // decides.
  const VF least = Add(NearCode(clamped), Set(0.5f - kNear));
  const VF whole = Floor(least);
  const VI code = ConvertTo(di, whole);
  const MF open = Ge(Sub(least, whole), Set(1 - 2 * kNear));
  if (HWY_LIKELY(AllFalse(open))) return BitCast(UintTag(), code);

  const VF next = GatherIndex(d, leastOfCodes, Add(code, Set(1)));
  const VI step = IfThenElseZero(RebindMask(di, Ge(clamped, next)), Set(1));
  return BitCast(UintTag(), Add(code, step));
}

// Hable's shoulder-and-toe curve (2010), scaled so that 11.2 becomes 1.
HWY_INLINE VF HableCurve(VF x) {
  const VF a = Set(0.15f), b = Set(0.50f), cb = Set(0.05f);
  const VF de = Set(0.20f * 0.02f), df = Set(0.20f * 0.30f);
  const VF numerator = MulThenAdd(x, MulThenAdd(a, x, cb), de);
  const VF denominator = MulThenAdd(x, MulThenAdd(a, x, b), df);
  return Sub(Div(numerator, denominator), Set(0.02f / 0.30f));
}

HWY_INLINE VF ToneCurved(ToneCurve curve, VF x) {
  const VF positive = IfThenElseZero(Gt(x, Zero()), x);

  switch (curve) {
    case ToneCurve::reinhard: {
      // Infinity stays 1, not infinity over infinity.
      const VF bounded = Min(positive, Set(1e30f));
      return Div(bounded, Add(bounded, Set(1.0f)));
    }
    case ToneCurve::filmic: {
      const VF bounded = Min(positive, Set(1e15f));
      return Div(HableCurve(bounded), HableCurve(Set(11.2f)));
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
  const VF scale = Set(args.exposureScale);

  for (size_t i = 0; i < args.n; i += Lanes(d)) {
    const auto encode = [&](const float* column) HWY_ATTR {
      return SrgbCode(leastOfCodes, ToneCurved(curve, Mul(Load(column, i), scale)));
    };

    const VU r = encode(radiance.rgb.x), g = hn::ShiftLeft<8>(encode(radiance.rgb.y));
    const VU b = hn::ShiftLeft<16>(encode(radiance.rgb.z));
    StoreU(Or(Or(r, g), Or(b, Set(0xFF000000u))), du, args.codes + i);
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
