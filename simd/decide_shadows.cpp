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

// Where a lane's ray starts: its triangle, weights and the word of the triangle's parts.
struct StartLanes {
  MF live;  // has parts, and does not lie in the rim
  VI triangle;
  VF u, v;
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

HWY_INLINE StartLanes FindStarts(const VerdictView& view, MF live, const HitWords& hits) {
  const FloatTag d;
  const IntTag di;
  const VF one = hn::Set(d, 1.0f);
  StartLanes s;
  live = hn::And(live, hn::RebindMask(d, hn::Eq(hits.instance, hn::Set(di, -1))));
  s.triangle = hits.triangle;
  s.triangle = hn::IfThenElseZero(hn::RebindMask(di, live), s.triangle);
  const VI word = GatherWord(view.first, s.triangle);
  live =
      hn::And(live, hn::RebindMask(d, hn::Ne(word, hn::Set(di, static_cast<int32_t>(kNoParts)))));
  s.u = hits.u;
  s.v = hits.v;
  const VI power = hn::And(word, hn::Set(di, (1 << kPartBits) - 1));
  const VF rim = hn::Mul(PowerOfTwo(hn::Neg(power)), hn::Set(d, kVerdictRim));
  const VF least = hn::Min(hn::Min(s.u, s.v), hn::Sub(hn::Sub(one, s.u), s.v));
  s.live = hn::And(live, hn::Ge(least, rim));
  const VF u = hn::IfThenElseZero(s.live, s.u), v = hn::IfThenElseZero(s.live, s.v);
  const VF side = PowerOfTwo(power), cells = hn::Set(d, static_cast<float>(kCellsASide));
  const VF partU = hn::Mul(u, side), partV = hn::Mul(v, side);
  const VI column = hn::ConvertTo(di, partU), row = hn::ConvertTo(di, partV);
  s.cell = hn::ConvertTo(di, hn::Mul(hn::Sub(partU, hn::ConvertTo(d, column)), cells));
  s.row = hn::ConvertTo(di, hn::Mul(hn::Sub(partV, hn::ConvertTo(d, row)), cells));
  const VI before =
      hn::ConvertTo(di, hn::MulAdd(hn::ConvertTo(d, row), side, hn::ConvertTo(d, column)));
  s.part = hn::IfThenElseZero(hn::RebindMask(di, s.live),
                              hn::Add(hn::ShiftRight<kPartBits>(word), before));
  return s;
}

// Verdicts as numbers.
HWY_INLINE VI LookUp(const VerdictView& view, const StartLanes& s) {
  const IntTag di;
  const UintTag du;
  const VI three = hn::Set(di, 3);
  const VI part = hn::IfThenElseZero(hn::RebindMask(di, s.live), GatherWord(view.parts, s.part));
  const auto divided = hn::Gt(part, three);
  if (hn::AllFalse(di, divided)) return part;
  const VI place = hn::Sub(hn::ShiftRight<2>(part), hn::Set(di, 1));
  const VI word =
      hn::IfThenElseZero(divided, hn::Add(hn::Mul(place, hn::Set(di, kCellsASide)), s.row));
  const VU row = hn::BitCast(du, GatherWord(view.cells, word));
  const VU shift = hn::BitCast(du, hn::IfThenElseZero(divided, hn::Add(s.cell, s.cell)));
  const VI cell = hn::And(hn::BitCast(di, hn::Shr(row, shift)), three);
  return hn::IfThenElse(divided, cell, part);
}

// Whether rays start as near to the points of their weights as verdicts allow (kVerdictReach).
HWY_INLINE MF StartsNear(const Chunk& c, const StartLanes& s, size_t i) {
  using R = TriangleRecord;
  const FloatTag d;
  const SharedRecords<R> records(c.tables().triangles, s.triangle, s.live);
  const V4 a = records.Load4<offsetof(R, position[0]), offsetof(R, position[3])>();
  const V4 b = records.Load4<offsetof(R, position[4]), offsetof(R, position[7])>();
  const V4 e = records.Load4<offsetof(R, position[8]), offsetof(R, uv[2])>();
  const V3 p0{a.x, a.y, a.z}, p1{a.w, b.x, b.y}, p2{b.z, b.w, e.x};
  const Weights w{hn::Sub(hn::Sub(hn::Set(d, 1.0f), s.u), s.v), s.u, s.v};
  const VF size = SumOf(Interpolate3(w, Abs3(p0), Abs3(p1), Abs3(p2)));
  const V3 start = Load3(c.shadows.orgX, c.shadows.orgY, c.shadows.orgZ, i);
  const VF away = MaxComponent(Abs3(Sub3(start, Interpolate3(w, p0, p1, p2))));
  return hn::Le(away, hn::Mul(size, hn::Set(d, kVerdictReach)));
}

// Parts that rays have missed.
HWY_NOINLINE void NoteWanted(const VerdictView& view, MF missed, VI part) {
  const IntTag di;
  HWY_ALIGN int32_t parts[16];
  hn::Store(hn::IfThenElse(hn::RebindMask(di, missed), part, hn::Set(di, -1)), di, parts);
  for (size_t lane = 0; lane < hn::Lanes(di); ++lane) {
    if (parts[lane] < 0) continue;
    const std::atomic_ref<uint8_t> wanted(view.wanted[parts[lane]]);
    const uint8_t before = wanted.load(std::memory_order_relaxed);
    if (before < 255) wanted.store(static_cast<uint8_t>(before + 1), std::memory_order_relaxed);
  }
}

void DecideShadows(Chunk& c) noexcept {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  if (!c.frame->verdicts) return;
  const VerdictView& view = c.frame->verdicts[c.lightNumber];
  if (!view.serves()) return;
  const ShadowColumns rays = c.shadows;
  const size_t n = c.shadowCount, lanes = hn::Lanes(d);
  uint64_t lit = 0, dark = 0;
  size_t count = 0;
  for (size_t i = 0; i < n; i += lanes) {
    const MF live = hn::FirstN(d, n - i);
    const VI slot =
        hn::IfThenElseZero(hn::RebindMask(di, live), hn::BitCast(di, hn::Load(du, rays.slot + i)));
    const StartLanes starts = FindStarts(view, live, LoadHitWords(c, live, slot, rays.slot[i]));
    const VI verdict = LookUp(view, starts);
    const MF unknown = hn::And(starts.live, hn::RebindMask(d, hn::Eq(verdict, hn::Zero(di))));
    if (HWY_UNLIKELY(!hn::AllFalse(d, unknown))) NoteWanted(view, unknown, starts.part);
    const auto is = [&](Verdict which) HWY_ATTR {
      return hn::And(starts.live,
                     hn::RebindMask(d, hn::Eq(verdict, hn::Set(di, static_cast<int32_t>(which)))));
    };
    MF isLit = is(Verdict::lit), isDark = is(Verdict::dark);
    if (hn::AllFalse(d, hn::Or(isLit, isDark))) {
      if (count == i) {  // all of them stay, where they are
        count += hn::CountTrue(d, live);
        continue;
      }
    } else {
      const MF near = StartsNear(c, starts, i);
      isLit = hn::And(isLit, near);
      isDark = hn::And(isDark, near);
      HWY_ALIGN uint32_t slots[16];
      HWY_ALIGN float clear[16];
      hn::Store(hn::BitCast(du, slot), du, slots);
      hn::Store(hn::IfThenElseZero(isLit, hn::Set(d, 1.0f)), d, clear);
      for (size_t lane = 0; lane < lanes; ++lane) {
        if (clear[lane] > 0) c.unshadowed.visible[slots[lane]] = 1;
      }
      lit += hn::CountTrue(d, isLit);
      dark += hn::CountTrue(d, isDark);
    }
    // Rays are written no further on than they were read.
    const V3 origin = Load3(rays.orgX, rays.orgY, rays.orgZ, i);
    const V3 way = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
    const VF tFar = hn::Load(d, rays.tFar + i);
    const Compactor rest(hn::AndNot(hn::Or(isLit, isDark), live));
    rest.Store(origin, rays.orgX, rays.orgY, rays.orgZ, count);
    rest.Store(way, rays.dirX, rays.dirY, rays.dirZ, count);
    rest.Store(tFar, rays.tFar + count);
    rest.Store(hn::BitCast(du, slot), rays.slot + count);
    count += rest.Count();
  }
  c.shadowCount = count;
  c.meter->shadows.lit += lit;
  c.meter->shadows.dark += dark;
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
