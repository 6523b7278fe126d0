// Rays that leave surfaces: where they start (the scalar reference: src/reference/world.h), and
// compaction, which stores those of the live lanes one after the other.
#if defined(WHIT_SIMD_NEW_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_NEW_RAYS_INL_H_
#undef WHIT_SIMD_NEW_RAYS_INL_H_
#else
#define WHIT_SIMD_NEW_RAYS_INL_H_
#endif

#include <array>

#include "core/shading_choices.h"
#include "simd/vec3-inl.h"
#include "stages/columns.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// AVX-512 has an instruction for compaction, used in registers: storing straight to memory takes
// Zen 4 some 100 cycles. Elsewhere Highway 1.0.3 looks its permutation up in a table that GCC
// copies to the stack for every vector, which took three quarters of the light kernel's time; here
// the permutation is fetched once and serves all columns.
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

// Writes whole vectors. The next vector overwrites what lies behind the live lanes.
class Compactor {
 public:
  HWY_INLINE explicit Compactor(MF live)
      : order_(OrderOf(live)), count_(hn::CountTrue(FloatTag(), live)) {}

  HWY_INLINE void Store(VF v, float* to) const { StoreU(Compacted(v), FloatTag(), to); }

  HWY_INLINE void Store(VU v, uint32_t* to) const {
    const UintTag du;
    StoreU(BitCast(du, Compacted(BitCast(FloatTag(), v))), du, to);
  }

  HWY_INLINE void Store(const V3& v, const Columns3& to, size_t at) const {
    Store(v.x, to.x + at);
    Store(v.y, to.y + at);
    Store(v.z, to.z + at);
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
    return hn::IndicesFromVec(d, PromoteTo(di, LoadU(d8, kCompactOrder[bits[0]].data())));
  }

  HWY_INLINE VF Compacted(VF v) const { return hn::TableLookupLanes(v, order_); }
#else
  using Order = MF;

  static HWY_INLINE Order OrderOf(MF live) { return live; }
  HWY_INLINE VF Compacted(VF v) const { return hn::Compress(v, order_); }
#endif
  Order order_;
  size_t count_;
};

// Appends the shadow rays of the live lanes to the first `count` ones.
HWY_INLINE void AppendShadowRays(const ShadowColumns& rays, MF live, const V3& origin,
                                 const V3& direction, VF tFar, VU slot, size_t& count) {
  const Compactor compactor(live);

  compactor.Store(origin, rays.org, count);
  compactor.Store(direction, rays.dir, count);
  compactor.Store(tFar, rays.tFar + count);
  compactor.Store(slot, rays.slot + count);

  count += compactor.Count();
}

// Moves one coordinate by 256 ulps times the normal's component, near the origin by 1/65536 of it
// (Waechter and Binder 2019).
HWY_INLINE VF MovedByUlps(VF p, VF n) {
  const FloatTag d;
  const IntTag di;

  // Integers step through floats away from zero, so negative coordinates step the other way.
  const VI ulps = ConvertTo(di, Mul(n, Set(256.0f)));
  const VI away = IfThenElse(RebindMask(di, Lt(p, Zero())), Sub(Zero(di), ulps), ulps);
  const VF far = BitCast(d, Add(BitCast(di, p), away));
  const VF near = MulThenAdd(n, Set(1.0f / 65536), p);
  return IfThenElse(Lt(Abs(p), Set(1.0f / 32)), near, far);
}

// Distances from a surfel to the starts of its rays (SurfelColumns).
struct Clearance {
  VF offset, viewOffset;
};

HWY_INLINE Clearance LoadClearance(const SurfelColumns& surfels, size_t i) {
  return {Load(surfels.offset, i), Load(surfels.viewOffset, i)};
}

// `side` is 1 for the viewer's side of the surface and -1 for the other one; `direction` is that of
// the viewer's ray.
HWY_INLINE V3 RayOrigin(OffsetMethod method, const V3& position, const V3& ng, const V3& direction,
                        const Clearance& clearance, float side) {
  const VF sign = Set(side);
  if (method == OffsetMethod::wachterBinder) {
    const V3 n = Scale3(ng, sign);
    return {MovedByUlps(position.x, n.x), MovedByUlps(position.y, n.y),
            MovedByUlps(position.z, n.z)};
  }

  // The way that the viewer's ray has come is clear, so on that side the ray also starts a little
  // back along it.
  if (method == OffsetMethod::bound && side > 0) {
    return MulAdd3(ng, clearance.offset, MulAdd3(direction, Neg(clearance.viewOffset), position));
  }

  const VF offset = method == OffsetMethod::fixed ? Set(kFixedOffset) : clearance.offset;
  return MulAdd3(ng, Mul(offset, sign), position);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
