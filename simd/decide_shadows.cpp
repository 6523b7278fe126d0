// Removes the shadow rays that the shadow cache decides (stages/shadow_cache_view.h), which need
// not be traced.
#include <atomic>
#include <bit>

#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/decide_shadows.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/new_rays-inl.h"
#include "simd/surface-inl.h"
#include "stages/shadow_cache_view.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

HWY_INLINE VI GatherWord(const uint32_t* words, VI at) {
  return hn::GatherIndex(IntTag(), reinterpret_cast<const int32_t*>(words), at);
}

// first, first + 1 ...: the part that is constant stays in a register.
HWY_INLINE VI RowFrom(uint32_t first) {
  const IntTag di;
  return hn::Add(hn::Iota(di, 0), hn::Set(di, static_cast<int32_t>(first)));
}

// 2^(power), of whole numbers.
HWY_INLINE VF PowerOfTwo(VI power) {
  return hn::BitCast(FloatTag(), hn::ShiftLeft<23>(hn::Add(power, hn::Set(IntTag(), 127))));
}

// Where a lane's ray starts.
struct StartLanes {
  MF live;             // has parts, and does not lie in the rim
  VI part, cell, row;  // the number of its part, and column and row of the cell in it
};

// A vector of rays of a chunk, with the hits of their surfels.
struct RayLanes {
  MF live;
  VI slot, triangle, instance;
  VF u, v;
};

// Loads the rays from `i` on. Mostly rays of a vector belong to slots that follow one another.
HWY_INLINE RayLanes LoadRays(const Chunk& c, size_t i, size_t end) {
  const FloatTag d;
  const IntTag di;
  const bool instances = c.has(Feature::instances);
  const uint32_t* const slots = c.shadows.slot + i;
  const uint32_t first = slots[0];
  RayLanes rays;
  rays.live = hn::FirstN(d, end - i);
  rays.slot = hn::IfThenElseZero(hn::RebindMask(di, rays.live),
                                 hn::BitCast(di, hn::Load(UintTag(), slots)));
  rays.instance = hn::Set(di, -1);
  const MF apart = hn::AndNot(hn::RebindMask(d, hn::Eq(rays.slot, RowFrom(first))), rays.live);
  if (HWY_LIKELY(hn::AllFalse(d, apart))) {
    const auto load = [&](const uint32_t* words) HWY_ATTR {
      return hn::LoadU(di, reinterpret_cast<const int32_t*>(words) + first);
    };
    rays.triangle = load(c.hits.triangle);
    if (instances) rays.instance = load(c.hits.instance);
    rays.u = hn::LoadU(d, c.hits.u + first);
    rays.v = hn::LoadU(d, c.hits.v + first);
  } else {
    rays.triangle = GatherWord(c.hits.triangle, rays.slot);
    if (instances) rays.instance = GatherWord(c.hits.instance, rays.slot);
    rays.u = hn::GatherIndex(d, c.hits.u, rays.slot);
    rays.v = hn::GatherIndex(d, c.hits.v, rays.slot);
  }
  return rays;
}

// Where a ray with these weights starts on a triangle with this word of ShadowCacheView::first.
HWY_INLINE StartLanes FindStarts(VI word, VF hitU, VF hitV) {
  const FloatTag d;
  const IntTag di;
  const VF one = hn::Set(d, 1.0f);
  StartLanes s;
  const MF divided = hn::RebindMask(d, hn::Ne(word, hn::Set(di, static_cast<int32_t>(kNoParts))));
  const VI power = hn::And(word, hn::Set(di, (1 << kPartBits) - 1));
  const VF rim = hn::Mul(PowerOfTwo(hn::Neg(power)), hn::Set(d, kShadowRim));
  const VF least = hn::Min(hn::Min(hitU, hitV), hn::Sub(hn::Sub(one, hitU), hitV));
  s.live = hn::And(divided, hn::Ge(least, rim));
  const VF u = hn::IfThenElseZero(s.live, hitU), v = hn::IfThenElseZero(s.live, hitV);
  const VF side = PowerOfTwo(power), cells = hn::Set(d, static_cast<float>(kCellsASide));
  const VF partU = hn::Mul(u, side), partV = hn::Mul(v, side);
  const VI column = hn::ConvertTo(di, partU), row = hn::ConvertTo(di, partV);
  s.cell = hn::ConvertTo(di, hn::Mul(hn::Sub(partU, hn::ConvertTo(d, column)), cells));
  s.row = hn::ConvertTo(di, hn::Mul(hn::Sub(partV, hn::ConvertTo(d, row)), cells));
  const VI before =
      hn::ConvertTo(di, MulThenAdd(hn::ConvertTo(d, row), side, hn::ConvertTo(d, column)));
  s.part = hn::Add(hn::ShiftRight<kPartBits>(word), before);
  return s;
}

constexpr auto kMixed = static_cast<int32_t>(ShadowState::mixed);

constexpr int ShiftFor(int powerOfTwo) {
  return std::countr_zero(static_cast<unsigned>(powerOfTwo));
}

// The states of the cells in the lanes whose part is divided.
HWY_INLINE VI LookUpCells(const ShadowCacheView& view, hn::Mask<IntTag> divided, VI word,
                          const StartLanes& s) {
  const IntTag di;
  const UintTag du;
  constexpr int kPlaceShift = ShiftFor(kWordsAPlace), kRowShift = ShiftFor(kWordsARow),
                kCellShift = ShiftFor(kCellsAWord);
  const VI place = hn::Sub(hn::ShiftRight<2>(word), hn::Set(di, 1));
  const VI rows = hn::Add(hn::ShiftLeft<kPlaceShift>(place), hn::ShiftLeft<kRowShift>(s.row));
  const VI index = hn::Add(rows, hn::ShiftRight<kCellShift>(s.cell));
  const VU bits = hn::BitCast(du, GatherWord(view.cells, hn::IfThenElseZero(divided, index)));
  const VI inWord = hn::And(s.cell, hn::Set(di, kCellsAWord - 1));
  const VI state = hn::BitCast(di, hn::Shr(bits, hn::BitCast(du, hn::Add(inWord, inWord))));
  return hn::And(state, hn::Set(di, kMixed));
}

// Counts the requests of rays whose parts are unknown.
HWY_INLINE void NoteWanted(const ShadowCacheView& view, hn::Mask<IntTag> unknown, VI part) {
  const IntTag di;
  if (HWY_LIKELY(hn::AllFalse(di, unknown))) return;
  HWY_ALIGN int32_t parts[16];
  hn::Store(hn::IfThenElse(unknown, part, hn::Set(di, -1)), di, parts);
  for (size_t lane = 0; lane < hn::Lanes(di); ++lane) {
    if (parts[lane] < 0) continue;
    const std::atomic_ref<uint8_t> wanted(view.wanted[parts[lane]]);
    const uint8_t rays = wanted.load(std::memory_order_relaxed);
    if (rays < UINT8_MAX) {
      wanted.store(static_cast<uint8_t>(rays + 1), std::memory_order_relaxed);
    }
  }
}

// The ShadowState of each ray; mixed for those that the tables say nothing of.
HWY_INLINE VI LookUp(const ShadowCacheView& view, const RayLanes& rays) {
  const IntTag di;
  const VI mixed = hn::Set(di, kMixed);
  const auto world = hn::And(hn::RebindMask(di, rays.live), hn::Eq(rays.instance, hn::Set(di, -1)));
  const VI first = GatherWord(view.first, hn::IfThenElseZero(world, rays.triangle));
  const VI noParts = hn::Set(di, static_cast<int32_t>(kNoParts));
  const StartLanes s = FindStarts(hn::IfThenElse(world, first, noParts), rays.u, rays.v);
  const auto live = hn::RebindMask(di, s.live);
  const VI part = hn::IfThenElseZero(live, s.part);
  VI word = hn::IfThenElse(live, GatherWord(view.parts, part), mixed);
  const auto divided = hn::Gt(word, mixed);
  if (!hn::AllFalse(di, divided)) {
    word = hn::IfThenElse(divided, LookUpCells(view, divided, word, s), word);
  }
  NoteWanted(view, hn::Eq(word, hn::Zero(di)), part);
  return word;
}

// True in lanes whose rays start as near to the points of their weights as the shadow cache
// requires (kCachedShadowReach).
HWY_INLINE MF StartsNear(const Chunk& c, MF live, const RayLanes& hits, const V3& start) {
  using R = TriangleRecord;
  const FloatTag d;
  const SharedRecords<R> records(c.tables().triangles, hits.triangle, live);
  const V4 a = records.Load4<offsetof(R, position[0]), offsetof(R, position[3])>();
  const V4 b = records.Load4<offsetof(R, position[4]), offsetof(R, position[7])>();
  const V4 e = records.Load4<offsetof(R, position[8]), offsetof(R, uv[2])>();
  const V3 p0{a.x, a.y, a.z}, p1{a.w, b.x, b.y}, p2{b.z, b.w, e.x};
  const Weights w{hn::Sub(hn::Sub(hn::Set(d, 1.0f), hits.u), hits.v), hits.u, hits.v};
  const VF size = SumOf(Interpolate3(w, Abs3(p0), Abs3(p1), Abs3(p2)));
  const VF away = MaxComponent(Abs3(Sub3(start, Interpolate3(w, p0, p1, p2))));
  return hn::Le(away, hn::Mul(size, hn::Set(d, kCachedShadowReach)));
}

// visible[slot] = 1 where rays are lit.
HWY_INLINE void ShowLit(float* visible, MF lit, VI slot, uint32_t first) {
  const FloatTag d;
  const IntTag di;
  const VI row = RowFrom(first);
  if (HWY_LIKELY(hn::AllFalse(d, hn::AndNot(hn::RebindMask(d, hn::Eq(slot, row)), lit)))) {
    hn::BlendedStore(hn::Set(d, 1.0f), lit, d, visible + first);
    return;
  }
  HWY_ALIGN int32_t slots[16];
  HWY_ALIGN float clear[16];
  hn::Store(slot, di, slots);
  hn::Store(hn::IfThenElseZero(lit, hn::Set(d, 1.0f)), d, clear);
  for (size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    if (clear[lane] > 0) visible[slots[lane]] = 1;
  }
}

// Rays are written no further on than they were read.
HWY_INLINE void KeepRest(const ShadowColumns& rays, MF kept, size_t i, size_t& count) {
  const V3 origin = Load3(rays.orgX, rays.orgY, rays.orgZ, i);
  const V3 way = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
  AppendShadowRays(rays, kept, origin, way, hn::Load(FloatTag(), rays.tFar + i),
                   hn::Load(UintTag(), rays.slot + i), count);
}

void DecideShadows(Chunk& c) {
  if (!c.frame->shadowCache) return;
  const ShadowCacheView& view = c.frame->shadowCache[c.lightNumber];
  if (!view.serves()) return;
  const FloatTag d;
  const IntTag di;
  const ShadowColumns& columns = c.shadows;
  const size_t n = c.shadowCount;
  size_t count = 0;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const RayLanes rays = LoadRays(c, i, n);
    const VI state = LookUp(view, rays);
    const auto is = [&](ShadowState which) HWY_ATTR {
      return hn::RebindMask(d, hn::Eq(state, hn::Set(di, static_cast<int32_t>(which))));
    };
    MF lit = is(ShadowState::lit), dark = is(ShadowState::dark), rest = rays.live;
    if (!hn::AllFalse(d, hn::Or(lit, dark))) {
      const MF near = StartsNear(c, hn::Or(lit, dark), rays,
                                 Load3(columns.orgX, columns.orgY, columns.orgZ, i));
      lit = hn::And(lit, near);
      dark = hn::And(dark, near);
      ShowLit(c.unshadowed.visible, lit, rays.slot, columns.slot[i]);
      c.meter->shadows.lit += hn::CountTrue(d, lit);
      c.meter->shadows.dark += hn::CountTrue(d, dark);
      rest = hn::AndNot(hn::Or(lit, dark), rest);
    }
    if (!hn::AllFalse(d, rest)) KeepRest(columns, rest, i, count);
  }
  c.shadowCount = count;
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(DecideShadows)
}  // namespace whit::simd
#endif
