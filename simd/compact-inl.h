// Compaction: the live lanes of vectors, stored one after the other.
#if defined(WHIT_SIMD_COMPACT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_COMPACT_INL_H_
#undef WHIT_SIMD_COMPACT_INL_H_
#else
#define WHIT_SIMD_COMPACT_INL_H_
#endif

#include <array>

#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// AVX-512 has an instruction for it, used in registers: storing straight to memory takes Zen 4 some
// 100 cycles. Elsewhere Highway 1.0.3 looks its permutation up in a table that GCC copies to the
// stack for every vector, which took three quarters of the light kernel's time; here the
// permutation is fetched once and serves all columns.
#define WHIT_COMPACT_BY_TABLE (HWY_TARGET != HWY_SCALAR && HWY_TARGET > HWY_AVX3)

// For each mask of up to eight lanes, the numbers of its live lanes, in order.
using CompactOrders = std::array<std::array<uint8_t, 8>, 256>;

constexpr CompactOrders makeCompactOrders() {
  CompactOrders orders{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    unsigned next = 0;
    for (unsigned lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1u) != 0) orders[mask][next++] = static_cast<uint8_t>(lane);
    }
  }
  return orders;
}

alignas(64) inline constexpr CompactOrders kCompactOrder = makeCompactOrders();

// Writes whole vectors; what lies behind the live lanes is overwritten by the next one.
class Compactor {
 public:
#if WHIT_COMPACT_BY_TABLE
  HWY_INLINE explicit Compactor(MF live) : order_(OrderOf(live)) {
    const FloatTag d;
    count_ = hn::CountTrue(d, live);
  }
  HWY_INLINE void Store(VF v, float* to) const {
    hn::StoreU(hn::TableLookupLanes(v, order_), FloatTag(), to);
  }
  HWY_INLINE void Store(VU v, uint32_t* to) const {
    const UintTag du;
    const FloatTag d;
    hn::StoreU(hn::BitCast(du, hn::TableLookupLanes(hn::BitCast(d, v), order_)), du, to);
  }
#else
  HWY_INLINE explicit Compactor(MF live) : live_(live) {
    const FloatTag d;
    count_ = hn::CountTrue(d, live);
  }
  HWY_INLINE void Store(VF v, float* to) const {
    hn::StoreU(hn::Compress(v, live_), FloatTag(), to);
  }
  HWY_INLINE void Store(VU v, uint32_t* to) const {
    const UintTag du;
    hn::StoreU(hn::Compress(v, hn::RebindMask(du, live_)), du, to);
  }
#endif
  HWY_INLINE void Store(const V3& v, float* x, float* y, float* z, size_t at) const {
    Store(v.x, x + at);
    Store(v.y, y + at);
    Store(v.z, z + at);
  }
  HWY_INLINE size_t Count() const { return count_; }

 private:
#if WHIT_COMPACT_BY_TABLE
  using Order = decltype(hn::IndicesFromVec(FloatTag(), VI()));
  static HWY_INLINE Order OrderOf(MF live) {
    const FloatTag d;
    const IntTag di;
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, live, bits);
    const hn::Rebind<uint8_t, IntTag> d8;
    return hn::IndicesFromVec(d, hn::PromoteTo(di, hn::LoadU(d8, kCompactOrder[bits[0]].data())));
  }
  Order order_;
#else
  MF live_;
#endif
  size_t count_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
