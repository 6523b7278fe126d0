// Shadow rays whose verdict is known (stages/verdict_view.h) need not be traced.
#include <atomic>

#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/decide_shadows.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/compact-inl.h"
#include "simd/surface-inl.h"
#include "stages/verdict_view.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

HWY_INLINE VI GatherWord(const uint32_t* words, VI at) {
  return hn::GatherIndex(IntTag(), reinterpret_cast<const int32_t*>(words), at);
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

// The hits of the rays' surfels. Mostly rays of a vector belong to slots that follow one another.
struct HitWords {
  VI triangle, instance;
  VF u, v;
};

HWY_INLINE HitWords LoadHitWords(const Chunk& c, MF live, VI slot, uint32_t first) {
  const FloatTag d;
  const IntTag di;
  const bool instances = c.has(Feature::instances);
  const VI row = hn::Iota(di, static_cast<int32_t>(first));
  const MF apart = hn::AndNot(hn::RebindMask(d, hn::Eq(slot, row)), live);
  if (HWY_LIKELY(hn::AllFalse(d, apart))) {
    const auto load = [&](const uint32_t* words) HWY_ATTR {
      return hn::LoadU(di, reinterpret_cast<const int32_t*>(words) + first);
    };
    return {load(c.hits.triangle), instances ? load(c.hits.instance) : hn::Set(di, -1),
            hn::LoadU(d, c.hits.u + first), hn::LoadU(d, c.hits.v + first)};
  }
  return {GatherWord(c.hits.triangle, slot),
          instances ? GatherWord(c.hits.instance, slot) : hn::Set(di, -1),
          hn::GatherIndex(d, c.hits.u, slot), hn::GatherIndex(d, c.hits.v, slot)};
}

// A vector of rays of a chunk, from `i` on.
struct RayLanes {
  MF live;
  VI slot;
  HitWords hits;
};

HWY_INLINE RayLanes LoadRays(const Chunk& c, size_t i, size_t end) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const uint32_t* const slots = c.shadows.slot + i;
  RayLanes rays;
  rays.live = hn::FirstN(d, end - i);
  rays.slot =
      hn::IfThenElseZero(hn::RebindMask(di, rays.live), hn::BitCast(di, hn::Load(du, slots)));
  rays.hits = LoadHitWords(c, rays.live, rays.slot, slots[0]);
  return rays;
}

// Where a ray with these weights starts on a triangle with this word of VerdictView::first.
HWY_INLINE StartLanes FindStarts(VI word, const HitWords& hits) {
  const FloatTag d;
  const IntTag di;
  const VF one = hn::Set(d, 1.0f);
  StartLanes s;
  const MF divided = hn::RebindMask(d, hn::Ne(word, hn::Set(di, static_cast<int32_t>(kNoParts))));
  const VI power = hn::And(word, hn::Set(di, (1 << kPartBits) - 1));
  const VF rim = hn::Mul(PowerOfTwo(hn::Neg(power)), hn::Set(d, kVerdictRim));
  const VF least = hn::Min(hn::Min(hits.u, hits.v), hn::Sub(hn::Sub(one, hits.u), hits.v));
  s.live = hn::And(divided, hn::Ge(least, rim));
  const VF u = hn::IfThenElseZero(s.live, hits.u), v = hn::IfThenElseZero(s.live, hits.v);
  const VF side = PowerOfTwo(power), cells = hn::Set(d, static_cast<float>(kCellsASide));
  const VF partU = hn::Mul(u, side), partV = hn::Mul(v, side);
  const VI column = hn::ConvertTo(di, partU), row = hn::ConvertTo(di, partV);
  s.cell = hn::ConvertTo(di, hn::Mul(hn::Sub(partU, hn::ConvertTo(d, column)), cells));
  s.row = hn::ConvertTo(di, hn::Mul(hn::Sub(partV, hn::ConvertTo(d, row)), cells));
  const VI before =
      hn::ConvertTo(di, hn::MulAdd(hn::ConvertTo(d, row), side, hn::ConvertTo(d, column)));
  s.part = hn::Add(hn::ShiftRight<kPartBits>(word), before);
  return s;
}

// Rays that are looked up together. A look-up is a chain of three loads that mostly miss the
// nearest cache: a link is followed for all rays before the next one, so that they wait together.
struct LookUps {
  static constexpr size_t kRays = 256;
  HWY_ALIGN int32_t part[kRays];  // of a ray without parts, or in the rim: -1
  HWY_ALIGN int32_t row[kRays], cell[kRays];
  // One after the other: VerdictView::first, ::parts, a Verdict.
  HWY_ALIGN int32_t word[kRays];
};

HWY_INLINE void LookUpTriangles(const Chunk& c, const VerdictView& view, size_t begin, size_t end,
                                LookUps& looked) {
  const IntTag di;
  const VI none = hn::Set(di, static_cast<int32_t>(kNoParts));
  for (size_t i = begin; i < end; i += hn::Lanes(di)) {
    const RayLanes rays = LoadRays(c, i, end);
    const auto world =
        hn::And(hn::RebindMask(di, rays.live), hn::Eq(rays.hits.instance, hn::Set(di, -1)));
    const VI word = GatherWord(view.first, hn::IfThenElseZero(world, rays.hits.triangle));
    hn::Store(hn::IfThenElse(world, word, none), di, looked.word + (i - begin));
  }
}

HWY_INLINE void FindParts(const Chunk& c, size_t begin, size_t end, LookUps& looked) {
  const IntTag di;
  for (size_t i = begin; i < end; i += hn::Lanes(di)) {
    const size_t at = i - begin;
    const StartLanes s = FindStarts(hn::Load(di, looked.word + at), LoadRays(c, i, end).hits);
    const auto live = hn::RebindMask(di, s.live);
    hn::Store(hn::IfThenElse(live, s.part, hn::Set(di, -1)), di, looked.part + at);
    hn::Store(hn::IfThenElseZero(live, s.row), di, looked.row + at);
    hn::Store(hn::IfThenElseZero(live, s.cell), di, looked.cell + at);
  }
}

HWY_INLINE void LookUpParts(const VerdictView& view, size_t count, LookUps& looked) {
  const IntTag di;
  const VI zero = hn::Zero(di), mixed = hn::Set(di, static_cast<int32_t>(Verdict::mixed));
  for (size_t at = 0; at < count; at += hn::Lanes(di)) {
    const VI part = hn::Load(di, looked.part + at);
    const VI word = GatherWord(view.parts, hn::Max(part, zero));
    hn::Store(hn::IfThenElse(hn::Lt(part, zero), mixed, word), di, looked.word + at);
  }
}

HWY_INLINE void LookUpCells(const VerdictView& view, size_t count, LookUps& looked) {
  const IntTag di;
  const UintTag du;
  const VI three = hn::Set(di, 3);
  for (size_t at = 0; at < count; at += hn::Lanes(di)) {
    const VI word = hn::Load(di, looked.word + at);
    const auto divided = hn::Gt(word, three);
    if (hn::AllFalse(di, divided)) continue;
    const VI place = hn::Sub(hn::ShiftRight<2>(word), hn::Set(di, 1));
    const VI row = hn::Add(hn::Mul(place, hn::Set(di, kCellsASide)), hn::Load(di, looked.row + at));
    const VU bits = hn::BitCast(du, GatherWord(view.cells, hn::IfThenElseZero(divided, row)));
    const VI cell = hn::Load(di, looked.cell + at);
    const VI verdict =
        hn::And(hn::BitCast(di, hn::Shr(bits, hn::BitCast(du, hn::Add(cell, cell)))), three);
    hn::Store(hn::IfThenElse(divided, verdict, word), di, looked.word + at);
  }
}

// Whether rays start as near to the points of their weights as verdicts allow (kVerdictReach).
HWY_INLINE MF StartsNear(const Chunk& c, MF live, const HitWords& hits, const V3& start) {
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
  return hn::Le(away, hn::Mul(size, hn::Set(d, kVerdictReach)));
}

// Parts that rays have missed: all, or those that are unknown. Mostly neighbors miss the same.
HWY_INLINE void NoteWanted(const VerdictView& view, const LookUps& looked, size_t count) {
  constexpr auto kUnknown = static_cast<int32_t>(Verdict::unknown);
  uint8_t* const wanted = view.wanted;
  int32_t last = -1;
  for (size_t i = 0; i < count; ++i) {
    const int32_t part = looked.part[i];
    if (part < 0 || part == last || !(view.empty || looked.word[i] == kUnknown)) continue;
    last = part;
    std::atomic_ref<uint8_t>(wanted[part]).store(1, std::memory_order_relaxed);
  }
}

// visible[slot] = 1 where rays are lit.
HWY_INLINE void ShowLit(float* visible, MF lit, VI slot, uint32_t first) {
  const FloatTag d;
  const IntTag di;
  const VI row = hn::Iota(di, static_cast<int32_t>(first));
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
  const FloatTag d;
  const UintTag du;
  const Compactor rest(kept);
  const V3 origin = Load3(rays.orgX, rays.orgY, rays.orgZ, i);
  const V3 way = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
  const VF tFar = hn::Load(d, rays.tFar + i);
  const VU slot = hn::Load(du, rays.slot + i);
  rest.Store(origin, rays.orgX, rays.orgY, rays.orgZ, count);
  rest.Store(way, rays.dirX, rays.dirY, rays.dirZ, count);
  rest.Store(tFar, rays.tFar + count);
  rest.Store(slot, rays.slot + count);
  count += rest.Count();
}

// What is decided, of the rays [begin, end); the others are written from `count` on.
HWY_INLINE void TakeDecided(Chunk& c, const VerdictView& view, size_t begin, size_t end,
                            const LookUps& looked, size_t& count) {
  const FloatTag d;
  const IntTag di;
  const ShadowColumns& columns = c.shadows;
  bool missed = false;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const VI verdict = hn::Load(di, looked.word + (i - begin));
    const auto is = [&](Verdict which) HWY_ATTR {
      return hn::RebindMask(d, hn::Eq(verdict, hn::Set(di, static_cast<int32_t>(which))));
    };
    missed = missed || !hn::AllFalse(d, is(Verdict::unknown));
    MF lit = is(Verdict::lit), dark = is(Verdict::dark), live = hn::FirstN(d, end - i);
    if (!hn::AllFalse(d, hn::Or(lit, dark))) {
      const RayLanes rays = LoadRays(c, i, end);
      const MF near = StartsNear(c, hn::Or(lit, dark), rays.hits,
                                 Load3(columns.orgX, columns.orgY, columns.orgZ, i));
      lit = hn::And(lit, near);
      dark = hn::And(dark, near);
      ShowLit(c.unshadowed.visible, lit, rays.slot, columns.slot[i]);
      c.meter->shadows.lit += hn::CountTrue(d, lit);
      c.meter->shadows.dark += hn::CountTrue(d, dark);
      live = hn::AndNot(hn::Or(lit, dark), live);
      if (!hn::AllFalse(d, live)) KeepRest(columns, live, i, count);
    } else if (count < i) {
      KeepRest(columns, live, i, count);
    } else {
      count += hn::CountTrue(d, live);  // all of them stay, where they are
    }
  }
  if (HWY_UNLIKELY(missed)) NoteWanted(view, looked, end - begin);
}

void DecideShadows(Chunk& c) noexcept {
  if (!c.frame->verdicts) return;
  const VerdictView& view = c.frame->verdicts[c.lightNumber];
  if (!view.serves()) return;
  LookUps looked;
  const size_t n = c.shadowCount;
  size_t count = 0;
  for (size_t begin = 0; begin < n; begin += LookUps::kRays) {
    const size_t end = begin + LookUps::kRays < n ? begin + LookUps::kRays : n;
    LookUpTriangles(c, view, begin, end, looked);
    FindParts(c, begin, end, looked);
    if (view.empty) {
      NoteWanted(view, looked, end - begin);
      count = end;
      continue;
    }
    LookUpParts(view, end - begin, looked);
    LookUpCells(view, end - begin, looked);
    TakeDecided(c, view, begin, end, looked, count);
  }
  c.shadowCount = count;
}

StepFunction FindDecideShadows(size_t /*index*/) { return DecideShadows; }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(FindDecideShadows);
StepFunction findDecideShadows(std::size_t index) {
  return HWY_DYNAMIC_DISPATCH(FindDecideShadows)(index);
}
}  // namespace whit::simd
#endif
