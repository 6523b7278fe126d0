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
// rounding takes s - floor(s) to exactly 1 (hard case H69). Texels beyond the borders are
// stored in the strips (kTexelStrip in scene/texture.h).
HWY_INLINE AxisTexels FootprintAt(VF held, VF size) {
  const VF x = MulThenSub(held, size, Set(0.5f));
  const VF floored = Floor(x);
  return {Add(floored, Set(1.0f)), Sub(x, floored)};
}

HWY_INLINE AxisTexels WrapAxis(VF s, VF size, VI mode) {
  const FloatTag d;
  const IntTag di;

  // Nearly all textures repeat.
  const VF repeated = Sub(s, Floor(s));
  const auto repeats = Eq(mode, Zero(di));
  if (HWY_LIKELY(AllTrue(di, repeats))) return FootprintAt(repeated, size);

  // A mirrored texture has period 2 and runs backwards in the second half of it.
  const VF half = Mul(s, Set(0.5f));
  const VF phase = Mul(Sub(half, Floor(half)), Set(2.0f));
  const VF mirrored = Min(phase, Sub(Set(2.0f), phase));
  const VF clamped = Clamped01(s);
  const MF mirrors = RebindMask(d, Eq(mode, Set(1)));
  const VF held = IfThenElse(mirrors, mirrored, clamped);
  return FootprintAt(IfThenElse(RebindMask(d, repeats), repeated, held), size);
}

// Texture coordinates that are not finite, or so large that no fraction of a texel is left, count
// as 0 (H68).
HWY_INLINE VF CoordinateOrZero(VF s) { return IfThenElseZero(Le(Abs(s), Set(1048576.0f)), s); }

// The lookups of a block of rays. Texels are prefetched when they are queued and read when the
// whole block is queued, so that the cache misses of many rays overlap.
struct TexelQueue {
  static constexpr size_t kRays = 64;
  HWY_ALIGN int32_t texel[kRays];                      // the first of a footprint, or the nearest
  HWY_ALIGN float fractionX[kRays], fractionY[kRays];  // X below 0: no texture
  bool any[kRays];                                     // at the first lane of each vector
};

HWY_INLINE MF QueuedLanes(const TexelQueue& queue, size_t slot) {
  return Ge(Load(queue.fractionX, slot), Zero());
}

// Converts whole numbers from 0 to 2^23 without the care for other numbers: the result is the low
// bits of the sum with 2^23.
HWY_INLINE VI IndexOf(VF whole) {
  const IntTag di;
  const VF shifted = Add(whole, Set(0x1p23f));
  return Sub(BitCast(di, shifted), BitCast(di, Set(0x1p23f)));
}

// The first texel of a footprint, counted from the first of its texture. The strip is floor(x /
// kTexelCells) of whole numbers up to kTextureSideLimit, half a step away from where rounding
// matters.
HWY_INLINE VI TexelOf(VF footprintX, VF footprintY, VI height) {
  constexpr float kPerCell = 1.0f / kTexelCells;
  const VF strip = Floor(MulThenAdd(footprintX, Set(kPerCell), Set(kPerCell / 2)));
  const VF inStrip = NegMulThenAdd(strip, Set(float{kTexelCells}), footprintX);
  const VI rows = Add(height, Set(kTexelBorder));
  const VI row = Add(Mul(IndexOf(strip), rows), IndexOf(footprintY));
  return Add(Mul(row, Set(kTexelStrip)), IndexOf(inStrip));
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
  return {BitCast(di, r.x), BitCast(di, r.z), ConvertTo(d, BitCast(di, r.y)), BitCast(di, r.w)};
}

// Returns the fraction, but in the lanes of `snaps` that of the nearer texel: 0 or 1.
HWY_INLINE VF Snapped(VF fraction, MF snaps) {
  const VF one = Set(1.0f);
  const VF nearer = IfThenElseZero(Ge(fraction, Set(0.5f)), one);
  return IfThenElse(snaps, nearer, fraction);
}

// Queues the four texels around (u, v) for the lanes of `live`; in these, `texture` is an index
// into `table`.
HWY_INLINE void QueueTexels(TextureFilter filter, const TextureRecord* table,
                            const uint32_t* texels, VI texture, MF live, VF u, VF v, size_t slot,
                            TexelQueue& queue) {
  const FloatTag d;
  const IntTag di;

  queue.any[slot] = !AllFalse(live);
  if (!queue.any[slot]) return;

  const auto [first, height, width, wrap] = LoadTextures(table, texture, live);
  const VI wrapU = And(wrap, Set(0xFF));
  const VI wrapV = And(ShiftRight<8>(wrap), Set(0xFF));

  // Image rows run downwards, v upwards.
  AxisTexels x = WrapAxis(CoordinateOrZero(u), width, wrapU);
  AxisTexels y = WrapAxis(Sub(Set(1.0f), CoordinateOrZero(v)), ConvertTo(d, height), wrapV);

  // Textures that are not interpolated take the nearer texel along each axis.
  const auto snaps = Gt(wrap, Set(int32_t{kNearestTexel} - 1));
  if (HWY_UNLIKELY(!AllFalse(di, snaps))) {
    x.fraction = Snapped(x.fraction, RebindMask(d, snaps));
    y.fraction = Snapped(y.fraction, RebindMask(d, snaps));
  }

  // The nearest filter reads one texel of the footprint.
  VI texel = Add(first, TexelOf(x.footprint, y.footprint, height));
  if (filter == TextureFilter::nearest) {
    const auto nearer = [&](VF fraction, int32_t step) HWY_ATTR {
      const MF upper = Ge(fraction, Set(0.5f));
      return IfThenElseZero(RebindMask(di, upper), Set(step));
    };
    texel = Add(texel, Add(nearer(x.fraction, 1), nearer(y.fraction, kTexelStrip)));
  }

  Store(IfThenElseZero(RebindMask(di, live), texel), di, queue.texel + slot);
  Store(IfThenElse(live, x.fraction, Set(-1.0f)), queue.fractionX, slot);
  Store(y.fraction, queue.fractionY, slot);

  for (size_t lane = slot; lane < slot + Lanes(d); ++lane) {
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
  const IntTag di;
  const UintTag du;
  const VF one = Set(1.0f), zero = Zero();

  if (filter == TextureFilter::nearest) {
    const VI texel =
        GatherIndex(di, reinterpret_cast<const int32_t*>(texels), Load(di, queue.texel + slot));
    const VU nearest = BitCast(du, texel);
    return {nearest, nearest, nearest, nearest, one, zero, zero, zero};
  }

  const VF fx = Load(queue.fractionX, slot), fy = Load(queue.fractionY, slot);
  const VF gx = Sub(one, fx), gy = Sub(one, fy);
  const V4 t = LoadSquares(texels, kTexelStrip, queue.texel + slot);
  return {BitCast(du, t.x), BitCast(du, t.y), BitCast(du, t.z), BitCast(du, t.w),
          Mul(gx, gy),      Mul(fx, gy),      Mul(gx, fy),      Mul(fx, fy)};
}

// The bits of `kMask` from `kShift` on, as a number.
template <int kShift, uint32_t kMask>
HWY_INLINE VF CodeOf(VU texel) {
  const VU code = And(ShiftRight<kShift>(texel), Set(kMask));
  return ConvertTo(FloatTag(), BitCast(IntTag(), code));
}

template <class Decode>
HWY_INLINE VF FilterChannel(const Footprint& f, const Decode& decode) {
  VF sum = Mul(decode(f.t00), f.w00);
  sum = MulThenAdd(decode(f.t10), f.w10, sum);
  sum = MulThenAdd(decode(f.t01), f.w01, sum);
  return MulThenAdd(decode(f.t11), f.w11, sum);
}

// (code / 1023)^2: linear light of a 10-bit channel (TexelFormat::color).
template <int kShift>
HWY_INLINE VF FilterColorChannel(const Footprint& f) {
  const VF squares = FilterChannel(f, [](VU texel) HWY_ATTR {
    const VF code = CodeOf<kShift, 1023>(texel);
    return Mul(code, code);
  });
  return Mul(squares, Set(1.0f / (1023.0f * 1023.0f)));
}
HWY_INLINE V3 FilterColor(const Footprint& f) {
  return {FilterColorChannel<0>(f), FilterColorChannel<10>(f), FilterColorChannel<20>(f)};
}

// code * 2^(exponent - 24) of 9-bit channels (TexelFormat::radiance): the weight of a texel times
// its power of two, which is exact.
HWY_INLINE VF RadianceWeight(VU texel, VF weight) {
  constexpr uint32_t kBias = 127 - 24;
  const VU exponent = Add(ShiftRight<27>(texel), Set(kBias));
  return Mul(weight, BitCast(FloatTag(), hn::ShiftLeft<23>(exponent)));
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
  return Mul(sum, Set(1.0f / 255.0f));
}
HWY_INLINE V3 FilterData3(const Footprint& f) {
  return {FilterDataChannel<0>(f), FilterDataChannel<8>(f), FilterDataChannel<16>(f)};
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
