// Texture lookups, bilinear or of the nearest texel, a texture of its own in every lane if need be.
#if defined(WHIT_SIMD_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_TEXTURE_INL_H_
#undef WHIT_SIMD_TEXTURE_INL_H_
#else
#define WHIT_SIMD_TEXTURE_INL_H_
#endif

#include "core/shading_choices.h"
#include "hwy/cache_control.h"
#include "simd/records-inl.h"
#include "stages/shading_tables.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// A bilinear footprint along one axis: its number, a whole one kept as a float, which is 0 for the
// footprint that begins half a texel before the border; and the weight of its upper texel.
struct AxisTexels {
  VF footprint, fraction;
};

// `held` in texture coordinates from 0 to 1, `size` in texels: footprints 0 to `size`, also where
// rounding takes s - floor(s) to exactly 1 (hard case H69). What lies beyond the borders is in the
// strips (TextureRecord).
HWY_INLINE AxisTexels FootprintAt(VF held, VF size) {
  const FloatTag d;
  const VF x = MulThenSub(held, size, hn::Set(d, 0.5f));
  const VF floored = hn::Floor(x);
  return {hn::Add(floored, hn::Set(d, 1.0f)), hn::Sub(x, floored)};
}

HWY_INLINE AxisTexels WrapAxis(VF s, VF size, VI mode) {
  const FloatTag d;
  const IntTag di;

  // Nearly all textures repeat.
  const VF repeated = hn::Sub(s, hn::Floor(s));
  const auto repeats = hn::Eq(mode, hn::Zero(di));
  if (HWY_LIKELY(hn::AllTrue(di, repeats))) return FootprintAt(repeated, size);

  // A mirrored texture has period 2 and runs backwards in the second half of it.
  const VF half = hn::Mul(s, hn::Set(d, 0.5f));
  const VF phase = hn::Mul(hn::Sub(half, hn::Floor(half)), hn::Set(d, 2.0f));
  const VF mirrored = hn::Min(phase, hn::Sub(hn::Set(d, 2.0f), phase));
  const VF clamped = hn::Min(hn::Max(s, hn::Zero(d)), hn::Set(d, 1.0f));
  const MF mirrors = hn::RebindMask(d, hn::Eq(mode, hn::Set(di, 1)));
  const VF held = hn::IfThenElse(mirrors, mirrored, clamped);
  return FootprintAt(hn::IfThenElse(hn::RebindMask(d, repeats), repeated, held), size);
}

// Texture coordinates that are not finite, or so large that no fraction of a texel is left, count
// as 0 (H68).
HWY_INLINE VF CoordinateOrZero(VF s) {
  const FloatTag d;
  return hn::IfThenElseZero(hn::Le(hn::Abs(s), hn::Set(d, 1048576.0f)), s);
}

// The lookups of a block of rays. Texels are prefetched when they are queued and read when the
// whole block is queued, so that the cache misses of many rays overlap.
struct TexelQueue {
  static constexpr size_t kRays = 64;
  HWY_ALIGN int32_t texel[kRays];                      // the first of a footprint, or the nearest
  HWY_ALIGN float fractionX[kRays], fractionY[kRays];  // X below 0: no texture
  bool any[kRays];                                     // at the first lane of each vector
};

HWY_INLINE MF QueuedLanes(const TexelQueue& queue, size_t slot) {
  const FloatTag d;
  return hn::Ge(hn::Load(d, queue.fractionX + slot), hn::Zero(d));
}

// Converts whole numbers from 0 to 2^23 without the care for other numbers: the result is the low
// bits of the sum with 2^23.
HWY_INLINE VI IndexOf(VF whole) {
  const FloatTag d;
  const IntTag di;
  const VF shifted = hn::Add(whole, hn::Set(d, 0x1p23f));
  return hn::Sub(hn::BitCast(di, shifted), hn::BitCast(di, hn::Set(d, 0x1p23f)));
}

// The first texel of a footprint, counted from the first of its texture. The strip is floor(x /
// kTexelCells) of whole numbers up to kTextureSideLimit, half a step away from where rounding
// matters.
HWY_INLINE VI TexelOf(VF footprintX, VF footprintY, VI height) {
  const FloatTag d;
  const IntTag di;
  constexpr float kPerCell = 1.0f / kTexelCells;
  const VF strip =
      hn::Floor(MulThenAdd(footprintX, hn::Set(d, kPerCell), hn::Set(d, kPerCell / 2)));
  const VF inStrip = NegMulThenAdd(strip, hn::Set(d, float{kTexelCells}), footprintX);
  const VI rows = hn::Add(height, hn::Set(di, kTexelBorder));
  const VI row = hn::Add(hn::Mul(IndexOf(strip), rows), IndexOf(footprintY));
  return hn::Add(hn::Mul(row, hn::Set(di, kTexelStrip)), IndexOf(inStrip));
}

struct TextureLanes {
  VI firstTexel, height;
  VF width;
  VI wrap;
};

HWY_INLINE TextureLanes LoadTextures(const TextureRecord* table, VI texture, MF live) {
  using R = TextureRecord;
  static_assert(offsetof(R, width) == 4 && offsetof(R, height) == 8);
  const FloatTag d;
  const IntTag di;
  const SharedRecords<R> records(table, texture, live);
  const V4 r = records.Load4<offsetof(R, firstTexel), offsetof(R, wrap)>();
  return {hn::BitCast(di, r.x), hn::BitCast(di, r.z), hn::ConvertTo(d, hn::BitCast(di, r.y)),
          hn::BitCast(di, r.w)};
}

// Returns the fraction, but in the lanes of `snaps` that of the nearer texel: 0 or 1.
HWY_INLINE VF Snapped(VF fraction, MF snaps) {
  const FloatTag d;
  const VF one = hn::Set(d, 1.0f);
  const VF nearer = hn::IfThenElseZero(hn::Ge(fraction, hn::Set(d, 0.5f)), one);
  return hn::IfThenElse(snaps, nearer, fraction);
}

// Queues the four texels around (u, v) for the lanes of `live`; in these, `texture` is an index
// into `table`.
HWY_INLINE void QueueTexels(TextureFilter filter, const TextureRecord* table,
                            const uint32_t* texels, VI texture, MF live, VF u, VF v, size_t slot,
                            TexelQueue& queue) {
  const FloatTag d;
  const IntTag di;

  queue.any[slot] = !hn::AllFalse(d, live);
  if (!queue.any[slot]) return;

  const auto [first, height, width, wrap] = LoadTextures(table, texture, live);
  const VI wrapU = hn::And(wrap, hn::Set(di, 0xFF));
  const VI wrapV = hn::And(hn::ShiftRight<8>(wrap), hn::Set(di, 0xFF));

  // Image rows run downwards, v upwards.
  AxisTexels x = WrapAxis(CoordinateOrZero(u), width, wrapU);
  AxisTexels y =
      WrapAxis(hn::Sub(hn::Set(d, 1.0f), CoordinateOrZero(v)), hn::ConvertTo(d, height), wrapV);

  // Textures that are not interpolated take the nearer texel along each axis.
  const auto snaps = hn::Gt(wrap, hn::Set(di, int32_t{kNearestTexel} - 1));
  if (HWY_UNLIKELY(!hn::AllFalse(di, snaps))) {
    x.fraction = Snapped(x.fraction, hn::RebindMask(d, snaps));
    y.fraction = Snapped(y.fraction, hn::RebindMask(d, snaps));
  }

  // The nearest filter reads one texel of the footprint.
  VI texel = hn::Add(first, TexelOf(x.footprint, y.footprint, height));
  if (filter == TextureFilter::nearest) {
    const auto nearer = [&](VF fraction, int32_t step) HWY_ATTR {
      const MF upper = hn::Ge(fraction, hn::Set(d, 0.5f));
      return hn::IfThenElseZero(hn::RebindMask(di, upper), hn::Set(di, step));
    };
    texel = hn::Add(texel, hn::Add(nearer(x.fraction, 1), nearer(y.fraction, kTexelStrip)));
  }

  hn::Store(hn::IfThenElseZero(hn::RebindMask(di, live), texel), di, queue.texel + slot);
  hn::Store(hn::IfThenElse(live, x.fraction, hn::Set(d, -1.0f)), d, queue.fractionX + slot);
  hn::Store(y.fraction, d, queue.fractionY + slot);

  for (size_t lane = slot; lane < slot + hn::Lanes(d); ++lane) {
    // A footprint may lie in two cache lines.
    hwy::Prefetch(texels + queue.texel[lane]);
    hwy::Prefetch(texels + queue.texel[lane] + kTexelStrip);
  }
}

// The four texels of a bilinear lookup, and their weights.
struct Footprint {
  VU t00, t10, t01, t11;
  VF w00, w10, w01, w11;
};

HWY_INLINE Footprint FetchTexels(TextureFilter filter, const uint32_t* texels,
                                 const TexelQueue& queue, size_t slot) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);

  if (filter == TextureFilter::nearest) {
    const VI texel = hn::GatherIndex(di, reinterpret_cast<const int32_t*>(texels),
                                     hn::Load(di, queue.texel + slot));
    const VU nearest = hn::BitCast(du, texel);
    return {nearest, nearest, nearest, nearest, one, zero, zero, zero};
  }

  const VF fx = hn::Load(d, queue.fractionX + slot), fy = hn::Load(d, queue.fractionY + slot);
  const VF gx = hn::Sub(one, fx), gy = hn::Sub(one, fy);
  const V4 t = LoadSquares(texels, kTexelStrip, queue.texel + slot);
  return {hn::BitCast(du, t.x), hn::BitCast(du, t.y), hn::BitCast(du, t.z), hn::BitCast(du, t.w),
          hn::Mul(gx, gy),      hn::Mul(fx, gy),      hn::Mul(gx, fy),      hn::Mul(fx, fy)};
}

// The bits of `kMask` from `kShift` on, as a number.
template <int kShift, uint32_t kMask>
HWY_INLINE VF CodeOf(VU texel) {
  const VU code = hn::And(hn::ShiftRight<kShift>(texel), hn::Set(UintTag(), kMask));
  return hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), code));
}

template <class Decode>
HWY_INLINE VF FilterChannel(const Footprint& f, const Decode& decode) {
  VF sum = hn::Mul(decode(f.t00), f.w00);
  sum = MulThenAdd(decode(f.t10), f.w10, sum);
  sum = MulThenAdd(decode(f.t01), f.w01, sum);
  return MulThenAdd(decode(f.t11), f.w11, sum);
}

// (code / 1023)^2: linear light of a 10-bit channel (TexelFormat::color).
template <int kShift>
HWY_INLINE VF FilterColorChannel(const Footprint& f) {
  const VF squares = FilterChannel(f, [](VU texel) HWY_ATTR {
    const VF code = CodeOf<kShift, 1023>(texel);
    return hn::Mul(code, code);
  });
  return hn::Mul(squares, hn::Set(FloatTag(), 1.0f / (1023.0f * 1023.0f)));
}
HWY_INLINE V3 FilterColor(const Footprint& f) {
  return {FilterColorChannel<0>(f), FilterColorChannel<10>(f), FilterColorChannel<20>(f)};
}

// code * 2^(exponent - 24) of 9-bit channels (TexelFormat::radiance): the weight of a texel times
// its power of two, which is exact.
HWY_INLINE VF RadianceWeight(VU texel, VF weight) {
  const UintTag du;
  constexpr uint32_t kBias = 127 - 24;
  const VU exponent = hn::Add(hn::ShiftRight<27>(texel), hn::Set(du, kBias));
  return hn::Mul(weight, hn::BitCast(FloatTag(), hn::ShiftLeft<23>(exponent)));
}
HWY_INLINE V3 FilterRadiance(Footprint f) {
  f.w00 = RadianceWeight(f.t00, f.w00);
  f.w10 = RadianceWeight(f.t10, f.w10);
  f.w01 = RadianceWeight(f.t01, f.w01);
  f.w11 = RadianceWeight(f.t11, f.w11);
  return {FilterChannel(f, [](VU texel) HWY_ATTR { return CodeOf<0, 511>(texel); }),
          FilterChannel(f, [](VU texel) HWY_ATTR { return CodeOf<9, 511>(texel); }),
          FilterChannel(f, [](VU texel) HWY_ATTR { return CodeOf<18, 511>(texel); })};
}

// code / 255 of an 8-bit channel (TexelFormat::data).
template <int kShift>
HWY_INLINE VF FilterDataChannel(const Footprint& f) {
  const VF sum = FilterChannel(f, [](VU texel) HWY_ATTR { return CodeOf<kShift, 255>(texel); });
  return hn::Mul(sum, hn::Set(FloatTag(), 1.0f / 255.0f));
}
HWY_INLINE V3 FilterData3(const Footprint& f) {
  return {FilterDataChannel<0>(f), FilterDataChannel<8>(f), FilterDataChannel<16>(f)};
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
