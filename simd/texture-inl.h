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

// Texel coordinates along one axis: lower and upper index, and the fraction between them.
struct AxisTexels {
  VI lower, upper;
  VF fraction;
};

// `s` in texture coordinates, `size` in texels. Indices are in range for every finite s, also where
// rounding takes s - floor(s) to exactly 1 (hard case H69).
HWY_INLINE AxisTexels RepeatAxis(VF s, VF size) {
  const FloatTag d;
  const IntTag di;
  const VF wrapped = hn::Sub(s, hn::Floor(s));
  const VF x = hn::MulSub(wrapped, size, hn::Set(d, 0.5f));
  const VF floored = hn::Floor(x);
  const VI last = hn::Sub(hn::ConvertTo(di, size), hn::Set(di, 1));
  const VI lower = hn::ConvertTo(di, floored);
  const VI upper = hn::Add(lower, hn::Set(di, 1));
  return {hn::IfThenElse(hn::Lt(lower, hn::Zero(di)), last, lower),
          hn::IfThenZeroElse(hn::Gt(upper, last), upper), hn::Sub(x, floored)};
}

// Mirrored or clamped coordinates never wrap: indices are clamped at the border.
HWY_INLINE AxisTexels ClampedAxis(VF s, VF size) {
  const FloatTag d;
  const IntTag di;
  const VF x = hn::MulSub(s, size, hn::Set(d, 0.5f));
  const VF floored = hn::Floor(x);
  const VI last = hn::Sub(hn::ConvertTo(di, size), hn::Set(di, 1));
  const VI lower = hn::ConvertTo(di, floored);
  const VI upper = hn::Add(lower, hn::Set(di, 1));
  return {hn::Max(lower, hn::Zero(di)), hn::Min(upper, last), hn::Sub(x, floored)};
}

HWY_INLINE AxisTexels WrapAxis(VF s, VF size, VI mode) {
  const FloatTag d;
  const IntTag di;
  const AxisTexels repeated = RepeatAxis(s, size);
  const auto repeats = hn::Eq(mode, hn::Zero(di));
  if (HWY_LIKELY(hn::AllTrue(di, repeats))) return repeated;
  const VF half = hn::Mul(s, hn::Set(d, 0.5f));
  const VF phase = hn::Mul(hn::Sub(half, hn::Floor(half)), hn::Set(d, 2.0f));
  const VF mirrored = hn::Min(phase, hn::Sub(hn::Set(d, 2.0f), phase));
  const VF clamped = hn::Min(hn::Max(s, hn::Zero(d)), hn::Set(d, 1.0f));
  const MF mirrors = hn::RebindMask(d, hn::Eq(mode, hn::Set(di, 1)));
  const AxisTexels held = ClampedAxis(hn::IfThenElse(mirrors, mirrored, clamped), size);
  const MF repeatsFloat = hn::RebindMask(d, repeats);
  return {hn::IfThenElse(repeats, repeated.lower, held.lower),
          hn::IfThenElse(repeats, repeated.upper, held.upper),
          hn::IfThenElse(repeatsFloat, repeated.fraction, held.fraction)};
}

// Texture coordinates that are not finite, or so large that no fraction of a texel is left, count
// as 0 (H68).
HWY_INLINE VF TameCoordinate(VF s) {
  const FloatTag d;
  return hn::IfThenElseZero(hn::Le(hn::Abs(s), hn::Set(d, 1048576.0f)), s);
}

// Where a block of rays looks textures up. Texels are asked for when they are queued and read when
// the whole block has been: so the cache misses of many rays overlap.
struct TexelQueue {
  static constexpr size_t kRays = 64;
  HWY_ALIGN int32_t texel00[kRays], texel10[kRays], texel01[kRays], texel11[kRays];
  HWY_ALIGN float fractionX[kRays], fractionY[kRays];  // X below 0: no texture
  bool any[kRays];                                     // by the first lane of a vector
};

HWY_INLINE MF QueuedLanes(const TexelQueue& queue, size_t slot) {
  const FloatTag d;
  return hn::Ge(hn::Load(d, queue.fractionX + slot), hn::Zero(d));
}

// The nearer of the two indices, alone.
HWY_INLINE AxisTexels Nearest(const AxisTexels& axis) {
  const FloatTag d;
  const auto upper = hn::RebindMask(IntTag(), hn::Ge(axis.fraction, hn::Set(d, 0.5f)));
  const VI index = hn::IfThenElse(upper, axis.upper, axis.lower);
  return {index, index, hn::Zero(d)};
}

// What a row or a column of texels adds to the index of the first (kTexelTile).
HWY_INLINE VI TileRow(VI y, VI rowOfTiles) {
  const IntTag di;
  const VI within = hn::And(y, hn::Set(di, kTexelTile - 1));
  return hn::Add(hn::Mul(hn::ShiftRight<2>(y), rowOfTiles), hn::ShiftLeft<2>(within));
}
HWY_INLINE VI TileColumn(VI x) {
  const IntTag di;
  const VI within = hn::And(x, hn::Set(di, kTexelTile - 1));
  return hn::Add(hn::ShiftLeft<2>(hn::Sub(x, within)), within);
}

// Queues the four texels around (u, v) for the lanes of `live`; in these, `texture` is an index
// into `records`.
HWY_INLINE void QueueTexels(TextureFilter filter, const void* records, const uint32_t* texels,
                            VI texture, MF live, VF u, VF v, size_t slot, TexelQueue& queue) {
  const FloatTag d;
  const IntTag di;
  queue.any[slot] = !hn::AllFalse(d, live);
  if (!queue.any[slot]) return;
  const TableReader reader(records, 4, texture, live);
  const V4 record = reader.Columns4(0);
  const VI first = hn::BitCast(di, record.x);
  const VI width = hn::BitCast(di, record.y);
  const VF widthF = hn::ConvertTo(d, width);
  const VF heightF = hn::ConvertTo(d, hn::BitCast(di, record.z));
  const VI wrap = hn::BitCast(di, record.w);
  const VI wrapU = hn::And(wrap, hn::Set(di, 0xFF));
  const VI wrapV = hn::ShiftRight<8>(wrap);
  // Image rows run downwards, v upwards.
  AxisTexels x = WrapAxis(TameCoordinate(u), widthF, wrapU);
  AxisTexels y = WrapAxis(hn::Sub(hn::Set(d, 1.0f), TameCoordinate(v)), heightF, wrapV);
  if (filter == TextureFilter::nearest) x = Nearest(x), y = Nearest(y);
  const VI filled = TileColumn(hn::Add(width, hn::Set(di, kTexelTile - 1)));
  const VI rowOfTiles = hn::And(filled, hn::Set(di, -kTexelTile * kTexelTile));
  const VI row0 = hn::Add(first, TileRow(y.lower, rowOfTiles));
  const VI row1 = hn::Add(first, TileRow(y.upper, rowOfTiles));
  const VI column0 = TileColumn(x.lower), column1 = TileColumn(x.upper);
  const auto liveInt = hn::RebindMask(di, live);
  const auto store = [&](VI row, VI column, int32_t* to) HWY_ATTR {
    hn::Store(hn::IfThenElseZero(liveInt, hn::Add(row, column)), di, to + slot);
  };
  store(row0, column0, queue.texel00);
  store(row0, column1, queue.texel10);
  store(row1, column0, queue.texel01);
  store(row1, column1, queue.texel11);
  hn::Store(hn::IfThenElse(live, x.fraction, hn::Set(d, -1.0f)), d, queue.fractionX + slot);
  hn::Store(y.fraction, d, queue.fractionY + slot);
  for (size_t lane = slot; lane < slot + hn::Lanes(d); ++lane) {
    hwy::Prefetch(texels + queue.texel00[lane]);
    hwy::Prefetch(texels + queue.texel11[lane]);  // all of them but at the corners of tiles
  }
}

// Four texels and their weights.
struct Footprint {
  VU t00, t10, t01, t11;
  VF w00, w10, w01, w11;
};

HWY_INLINE Footprint FetchTexels(TextureFilter filter, const uint32_t* texels,
                                 const TexelQueue& queue, size_t slot) {
  const FloatTag d;
  const IntTag di;
  const auto gather = [&](const int32_t* index) HWY_ATTR {
    return hn::BitCast(UintTag(), hn::GatherIndex(di, reinterpret_cast<const int32_t*>(texels),
                                                  hn::Load(di, index + slot)));
  };
  const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  if (filter == TextureFilter::nearest) {
    const VU texel = gather(queue.texel00);
    return {texel, texel, texel, texel, one, zero, zero, zero};
  }
  const VF fx = hn::Load(d, queue.fractionX + slot), fy = hn::Load(d, queue.fractionY + slot);
  const VF gx = hn::Sub(one, fx), gy = hn::Sub(one, fy);
  return {gather(queue.texel00), gather(queue.texel10), gather(queue.texel01),
          gather(queue.texel11), hn::Mul(gx, gy),       hn::Mul(fx, gy),
          hn::Mul(gx, fy),       hn::Mul(fx, fy)};
}

// (code / 1023)^2: linear light of a 10-bit channel (TexelFormat::colour).
template <int kShift>
HWY_INLINE VF SquaredCode(VU texel) {
  const UintTag du;
  const VU code = hn::And(hn::ShiftRight<kShift>(texel), hn::Set(du, 1023u));
  const VF value = hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), code));
  return hn::Mul(value, value);
}
template <int kShift>
HWY_INLINE VF FilterColourChannel(const Footprint& f) {
  VF sum = hn::Mul(SquaredCode<kShift>(f.t00), f.w00);
  sum = hn::MulAdd(SquaredCode<kShift>(f.t10), f.w10, sum);
  sum = hn::MulAdd(SquaredCode<kShift>(f.t01), f.w01, sum);
  sum = hn::MulAdd(SquaredCode<kShift>(f.t11), f.w11, sum);
  return hn::Mul(sum, hn::Set(FloatTag(), 1.0f / (1023.0f * 1023.0f)));
}
HWY_INLINE V3 FilterColour(const Footprint& f) {
  return {FilterColourChannel<0>(f), FilterColourChannel<10>(f), FilterColourChannel<20>(f)};
}

// code / 255 of an 8-bit channel (TexelFormat::data).
template <int kShift>
HWY_INLINE VF Code(VU texel) {
  const UintTag du;
  const VU code = hn::And(hn::ShiftRight<kShift>(texel), hn::Set(du, 255u));
  return hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), code));
}
template <int kShift>
HWY_INLINE VF FilterDataChannel(const Footprint& f) {
  VF sum = hn::Mul(Code<kShift>(f.t00), f.w00);
  sum = hn::MulAdd(Code<kShift>(f.t10), f.w10, sum);
  sum = hn::MulAdd(Code<kShift>(f.t01), f.w01, sum);
  sum = hn::MulAdd(Code<kShift>(f.t11), f.w11, sum);
  return hn::Mul(sum, hn::Set(FloatTag(), 1.0f / 255.0f));
}
HWY_INLINE V3 FilterData3(const Footprint& f) {
  return {FilterDataChannel<0>(f), FilterDataChannel<8>(f), FilterDataChannel<16>(f)};
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
