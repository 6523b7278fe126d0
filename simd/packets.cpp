// The kernels around Embree in findIntersections and checkShadows: rays into packets, and what
// comes back out of packets.
#include <type_traits>

#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/packets.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// The tag of vectors that lie in one packet.
template <size_t kWidth>
using PacketTag = hn::CappedTag<float, kWidth>;

template <size_t kWidth>
HWY_INLINE float* WordsOf(const PacketWords& packets, size_t ray) {
  return packets.first + ray / kWidth * packets.stride + ray % kWidth;
}

// The columns that packets read for either kind of rays; tFar is null where rays have no end.
struct RaySource {
  Columns3 org, dir;
  const float* tFar;
};

// One sum tests all coordinates, because nearly all rays are fine. A direction of 0 belongs to a
// pixel that sees nothing.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> Traceable(D d, V ox, V oy, V oz, V dx, V dy, V dz, float reach) {
  const V org = Add(Add(Abs(ox), Abs(oy)), Abs(oz));
  const V direction = Add(Add(Abs(dx), Abs(dy)), Abs(dz));
  return And(Le(Add(org, direction), Set(d, reach)), Gt(direction, Zero(d)));
}

template <size_t kWidth>
HWY_INLINE void Pack(const RaySource& from, size_t n, float reach, const PacketWords& to) {
  const PacketTag<kWidth> d;
  const size_t end = (n + kWidth - 1) / kWidth * kWidth;

  for (size_t i = 0; i < end; i += Lanes(d)) {
    const auto load = [&](const float* column) HWY_ATTR { return LoadU(d, column + i); };
    const auto store = [&](auto v, size_t column)
                           HWY_ATTR { StoreU(v, d, WordsOf<kWidth>(to, i) + column * kWidth); };

    auto ox = load(from.org.x), oy = load(from.org.y), oz = load(from.org.z);
    auto dx = load(from.dir.x), dy = load(from.dir.y), dz = load(from.dir.z);
    auto tFar = from.tFar ? load(from.tFar) : hn::Inf(d);

    const auto there = hn::FirstN(d, i < n ? n - i : 0);
    const auto good = And(there, Traceable(d, ox, oy, oz, dx, dy, dz, reach));

    if (HWY_UNLIKELY(!AllTrue(d, good))) {
      // Other lanes become empty rays, which hit nothing. Those of bad rays start where no scene
      // can be, because Embree reads their coordinates where it splits a packet wider than the CPU.
      const auto place = IfThenElseZero(there, Set(d, 0.25f * reach));
      ox = IfThenElse(good, ox, place);
      oy = IfThenElse(good, oy, place);
      oz = IfThenElse(good, oz, place);
      dx = IfThenElseZero(good, dx);
      dy = IfThenElseZero(good, dy);
      dz = IfThenElse(good, dz, Set(d, 1.0f));
      tFar = IfThenElse(good, tFar, Set(d, -1.0f));
    }

    store(ox, packet_column::orgX);
    store(oy, packet_column::orgY);
    store(oz, packet_column::orgZ);
    store(dx, packet_column::dirX);
    store(dy, packet_column::dirY);
    store(dz, packet_column::dirZ);
    store(tFar, packet_column::tFar);
  }
}

// Passes the width to `call` as a constant.
template <class Call>
HWY_INLINE void ForWidth(size_t width, const Call& call) {
  switch (width) {
    case 16:
      call(std::integral_constant<size_t, 16>());
      break;
    case 8:
      call(std::integral_constant<size_t, 8>());
      break;
    default:
      call(std::integral_constant<size_t, 4>());
      break;
  }
}

void PackRays(const RayColumns& rays, size_t n, float reach, const PacketWords& to) {
  const RaySource from{rays.org, rays.dir, nullptr};
  ForWidth(to.width, [&](auto width) HWY_ATTR { Pack<width()>(from, n, reach, to); });
}

void PackShadowRays(const ShadowColumns& rays, size_t n, float reach, const PacketWords& to) {
  const RaySource from{rays.org, rays.dir, rays.tFar};
  ForWidth(to.width, [&](auto width) HWY_ATTR { Pack<width()>(from, n, reach, to); });
}

template <size_t kWidth>
HWY_INLINE void UnpackHitsOf(const PacketWords& from, size_t n, const uint32_t* triangleBase,
                             const HitColumns& hits) {
  const PacketTag<kWidth> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToSigned<decltype(d)> di;
  const auto miss = Set(du, kMiss);

  for (size_t i = 0; i < n; i += Lanes(d)) {
    const float* const words = WordsOf<kWidth>(from, i);
    const auto load = [&](size_t column) HWY_ATTR { return LoadU(d, words + column * kWidth); };

    StoreU(load(packet_column::tFar), d, hits.t + i);
    StoreU(load(packet_column::u), d, hits.u + i);
    StoreU(load(packet_column::v), d, hits.v + i);

    // A geometry holds the triangles of one class, numbered one after the other from the class's
    // base.
    const auto geometry = BitCast(du, load(packet_column::geometry));
    const auto primitive = BitCast(du, load(packet_column::primitive));
    auto base = Set(du, triangleBase[0]);
    if (hits.instance) {
      // Placement 0 is the world, which all other ids of Embree stand for; instances follow.
      const auto id = BitCast(di, load(packet_column::instance));
      const auto before = Set(di, static_cast<int32_t>(kFirstInstanceId) - 1);
      const auto placed = Max(Sub(id, before), Zero(di));
      const auto instance = Sub(placed, Set(di, 1));
      StoreU(BitCast(du, instance), du, hits.instance + i);

      static_assert(kTriangleClasses == 4);
      const auto ofClass = And(BitCast(di, geometry), Set(di, 3));
      const auto* const bases = reinterpret_cast<const int32_t*>(triangleBase);
      const auto index = Add(hn::ShiftLeft<2>(placed), ofClass);
      base = BitCast(du, GatherIndex(di, bases, index));
    } else {
      for (uint32_t c = 1; c < kTriangleClasses; ++c) {
        const auto ofClass = Eq(geometry, Set(du, c));
        base = IfThenElse(ofClass, Set(du, triangleBase[c]), base);
      }
    }

    const auto missed = Eq(geometry, miss);
    StoreU(IfThenElse(missed, miss, Add(base, primitive)), du, hits.triangle + i);
  }
}

void UnpackHits(const PacketWords& from, size_t n, const uint32_t* triangleBase,
                const HitColumns& hits) {
  ForWidth(from.width,
           [&](auto width) HWY_ATTR { UnpackHitsOf<width()>(from, n, triangleBase, hits); });
}

template <size_t kWidth>
HWY_INLINE void UnpackVisibilityOf(const PacketWords& from, size_t n, const uint32_t* slot,
                                   float* visible) {
  const PacketTag<kWidth> d;
  const size_t lanes = Lanes(d);
  HWY_ALIGN float clear[16];

  for (size_t i = 0; i < n; i += lanes) {
    // Embree marks an occluded ray with a tFar of minus infinity.
    const auto tFar = LoadU(d, WordsOf<kWidth>(from, i) + packet_column::tFar * kWidth);
    Store(IfThenElseZero(Ge(tFar, Zero(d)), Set(d, 1.0f)), d, clear);

    // Results go back to the slots that the shadow rays came from.
    const size_t count = n - i < lanes ? n - i : lanes;
    for (size_t lane = 0; lane < count; ++lane) visible[slot[i + lane]] = clear[lane];
  }
}

void UnpackVisibility(const PacketWords& from, size_t n, const uint32_t* slot, float* visible) {
  ForWidth(from.width,
           [&](auto width) HWY_ATTR { UnpackVisibilityOf<width()>(from, n, slot, visible); });
}

// Corner 0 of a triangle relative to the ray's start, and the edges from there.
struct SeenTriangle {
  V3 corner, edge1, edge2;
};

HWY_INLINE void CarryToWorld(const HitTables& tables, const HitColumns& hits, MF valid, size_t i,
                             const V3& corner, const V3& origin, SeenTriangle& t) {
  const auto [placed, instance] = LoadInstances(hits, tables.instanceCount, valid, i);
  if (AllFalse(FloatTag(), placed)) return;

  const PlacementLanes p = LoadPlacements(tables.instances, instance, placed);
  const MatrixLanes& m = p.toWorld;

  // The origins are subtracted first, so that instances far from the world's origin lose no bits.
  const V3 from = Sub3(p.origin, origin);

  t.corner = Select3(placed, Add3(TransformVector(m, corner), from), t.corner);
  t.edge1 = Select3(placed, TransformVector(m, t.edge1), t.edge1);
  t.edge2 = Select3(placed, TransformVector(m, t.edge2), t.edge2);
}

struct HitPoint {
  VF t, u, v;
};

// Moves hits that rounding has put beside the triangle, behind the ray's start or nowhere: returns
// nearby weights that belong to a point of the triangle, and the distance of this point.
HWY_INLINE HitPoint MoveOntoTriangle(const SeenTriangle& t, const V3& direction,
                                     const HitPoint& p) {
  const VF zero = Zero(), one = Set(1.0f), third = Set(1.0f / 3);
  const VF most = Set(0x1p60f);

  // Where the weights say nothing, the centroid stands in.
  const MF known = And(Le(Abs(p.u), most), Le(Abs(p.v), most));
  const VF u = Max(IfThenElse(known, p.u, third), zero);
  const VF v = Max(IfThenElse(known, p.v, third), zero);

  // Negative weights become 0, and the sum of all three is 1 again.
  const VF sum = Add(Add(Max(Sub(Sub(one, u), v), zero), u), v);
  const VF onU = Div(u, sum), onV = Div(v, sum);

  // The distance is that of the ray's point nearest to the moved one.
  const V3 point = MulAdd3(t.edge1, onU, MulAdd3(t.edge2, onV, t.corner));
  return {Div(Dot(point, direction), Dot(direction, direction)), onU, onV};
}

// The distance and the weights by Cramer's rule (Moeller and Trumbore 1997, "Fast, minimum storage
// ray/triangle intersection"). The scalar reference is refineHit in
// src/surfaces/intersect.cpp.
HWY_INLINE HitPoint PierceTriangle(const SeenTriangle& t, const V3& direction, MF on) {
  const FloatTag d;
  const VF zero = Zero(), one = Set(1.0f);

  const V3 normal = Cross(t.edge1, t.edge2), moment = Cross(direction, t.corner);
  const VF slope = Dot(normal, direction);
  HitPoint p{Div(Dot(normal, t.corner), slope), Div(Dot(t.edge2, moment), Neg(slope)),
             Div(Dot(t.edge1, moment), slope)};

  // Hits behind the start, or beside the triangle by more than 2^-12, are moved onto it.
  const VF least = Min(Min(p.u, p.v), Sub(Sub(one, p.u), p.v));
  const MF ahead = And(Ge(p.t, zero), Lt(p.t, hn::Inf(d)));
  const MF beside = AndNot(And(ahead, Ge(least, Set(-0x1p-12f))), on);
  if (HWY_UNLIKELY(!AllFalse(beside))) {
    const HitPoint moved = MoveOntoTriangle(t, direction, p);
    p = {IfThenElse(beside, moved.t, p.t), IfThenElse(beside, moved.u, p.u),
         IfThenElse(beside, moved.v, p.v)};
  }

  // A remainder beside the triangle comes from rounding, so the larger weight is reduced.
  const VF u = Max(p.u, zero), v = Max(p.v, zero);
  const VF excess = Max(Sub(Add(u, v), one), zero);
  const MF more = Ge(u, v);
  return {Max(p.t, zero), Sub(u, IfThenElseZero(more, excess)),
          Sub(v, hn::IfThenZeroElse(more, excess))};
}

void RefineHits(const HitTables& tables, const RayColumns& rays, size_t n, const HitColumns& hits) {
  const FloatTag d;
  constexpr size_t kStride = kFloatsOf<TriangleRecord>;

  for (size_t i = 0; i < n; i += Lanes(d)) {
    // Spheres keep the hits of their own kernel, which computes in double.
    const auto [valid, triangle] = LoadHits(hits, tables.triangleCount, i);
    const MF on = And(AreTriangles(triangle, tables.firstSphere), valid);
    if (AllFalse(on)) continue;

    const auto [c0, c1, c2] = LoadCorners(tables.triangles, kStride, triangle);
    const auto load = [&](const float* column) HWY_ATTR { return LoadU(d, column + i); };
    const V3 origin{load(rays.org.x), load(rays.org.y), load(rays.org.z)};
    const V3 direction{load(rays.dir.x), load(rays.dir.y), load(rays.dir.z)};

    SeenTriangle t{Sub3(c0, origin), Sub3(c1, c0), Sub3(c2, c0)};
    if (hits.instance) CarryToWorld(tables, hits, valid, i, c0, origin, t);

    const HitPoint p = PierceTriangle(t, direction, on);
    const auto put = [&](VF value, float* column)
                         HWY_ATTR { hn::BlendedStore(value, on, d, column + i); };
    put(p.t, hits.t);
    put(p.u, hits.u);
    put(p.v, hits.v);
  }
}

PacketKernels FindPacketKernels() {
  return {PackRays, PackShadowRays, UnpackHits, RefineHits, UnpackVisibility};
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(FindPacketKernels);
PacketKernels findPacketKernels() { return HWY_DYNAMIC_DISPATCH(FindPacketKernels)(); }
}  // namespace whit::simd
#endif
