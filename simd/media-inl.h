// The stack of nested dielectrics that a ray travels in: four bytes of an integer, each a medium's
// number, the one entered last in the low byte, 0 for none. Overlaps are settled by priority
// (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images").
#if defined(WHIT_SIMD_MEDIA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_MEDIA_INL_H_
#undef WHIT_SIMD_MEDIA_INL_H_
#else
#define WHIT_SIMD_MEDIA_INL_H_
#endif

#include "simd/records-inl.h"
#include "stages/shading_tables.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

HWY_INLINE VU PushMedium(VU stack, VU medium) { return hn::Or(hn::ShiftLeft<8>(stack), medium); }

// Drops the lowest byte equal to `medium` (not 0) and closes the gap; unchanged if there is none.
HWY_INLINE VU RemoveMedium(VU stack, VU medium) {
  const UintTag du;
  const auto byteIs = [&](VU shifted)
                          HWY_ATTR { return hn::Eq(hn::And(shifted, hn::Set(du, 0xFFu)), medium); };
  const VU above = hn::ShiftRight<8>(stack);
  const auto without = [&](uint32_t keep) HWY_ATTR {
    return hn::Or(hn::And(stack, hn::Set(du, keep)), hn::And(above, hn::Set(du, ~keep)));
  };
  VU result = stack;
  result = hn::IfThenElse(byteIs(hn::ShiftRight<24>(stack)), without(0x00FFFFFFu), result);
  // The byte that moves down from beyond the top is zero.
  result = hn::IfThenElse(byteIs(hn::ShiftRight<16>(stack)), without(0x0000FFFFu), result);
  result = hn::IfThenElse(byteIs(above), without(0x000000FFu), result);
  return hn::IfThenElse(byteIs(stack), above, result);
}

HWY_INLINE VF PriorityOf(const ShadingTables& tables, VU medium) {
  const IntTag di;
  const VI index =
      hn::Add(hn::Mul(hn::BitCast(di, medium), hn::Set(di, kMediumStride)), hn::Set(di, 4));
  return hn::GatherIndex(FloatTag(), reinterpret_cast<const float*>(tables.media.data()), index);
}

// The medium that counts: highest priority, entered last among equals; 0 outside everything.
HWY_INLINE VU CurrentMedium(const ShadingTables& tables, VU stack) {
  const UintTag du;
  const FloatTag d;
  const VU byte = hn::Set(du, 0xFFu);
  VU best = hn::And(stack, byte);
  if (tables.samePriority) return best;
  VF bestPriority = PriorityOf(tables, best);
  const auto consider = [&](VU candidate) HWY_ATTR {
    const VF priority = PriorityOf(tables, candidate);
    const auto filled = hn::RebindMask(d, hn::Ne(candidate, hn::Zero(du)));
    const auto wins = hn::And(filled, hn::Gt(priority, bestPriority));
    best = hn::IfThenElse(hn::RebindMask(du, wins), candidate, best);
    bestPriority = hn::IfThenElse(wins, priority, bestPriority);
  };
  consider(hn::And(hn::ShiftRight<8>(stack), byte));
  consider(hn::And(hn::ShiftRight<16>(stack), byte));
  consider(hn::ShiftRight<24>(stack));
  return best;
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
