// Tests triangles against the shadow rays of a receiver, which takes most of the time of filling
// the shadow cache.
#include "simd/meet_casters.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/meet_casters.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/product-inl.h"
#include "stages/shadow_cache_view.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using MD = hn::Mask<Doubles>;
static_assert(CasterBlock::kCasters == 8);

HWY_INLINE VD All(double x) { return hn::Set(Doubles(), x); }
HWY_INLINE D3 All3(const Vec3d& v) { return {All(v.x), All(v.y), All(v.z)}; }
HWY_INLINE D3 Load3(const CasterBlock::Row (&rows)[3], size_t i) {
  const Doubles d;
  return {hn::Load(d, rows[0] + i), hn::Load(d, rows[1] + i), hn::Load(d, rows[2] + i)};
}
HWY_INLINE void Store3(const D3& v, CasterBlock::Row (&rows)[3], size_t i) {
  const Doubles d;
  hn::Store(v.x, d, rows[0] + i);
  hn::Store(v.y, d, rows[1] + i);
  hn::Store(v.z, d, rows[2] + i);
}
HWY_INLINE VD Length3(const D3& v) { return hn::Sqrt(Dot3(v, v)); }

HWY_INLINE unsigned BitsOf(MD mask) {
  const Doubles d;
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0] & ((1u << hn::Lanes(d)) - 1);
}
HWY_INLINE MD Both(MD a, MD b) { return hn::And(a, b); }
HWY_INLINE MD Either(MD a, MD b) { return hn::Or(a, b); }

// ---- boxes

unsigned MeetBoxes(const RoundedShaft& shaft, const BoxBlock& boxes) {
  constexpr float kRounding = 0x1p-20f;
  const hn::CappedTag<float, BoxBlock::kBoxes> d;
  unsigned met = 0;
  for (size_t k = 0; k < BoxBlock::kBoxes; k += hn::Lanes(d)) {
    const auto x = hn::Load(d, boxes.center[0] + k), y = hn::Load(d, boxes.center[1] + k),
               z = hn::Load(d, boxes.center[2] + k);
    const auto hx = hn::Load(d, boxes.half[0] + k), hy = hn::Load(d, boxes.half[1] + k),
               hz = hn::Load(d, boxes.half[2] + k);
    // A sum's rounding grows with the boxes' own distance from the origin.
    const auto sum =
        hn::Add(hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z)), hn::Add(hn::Add(hx, hy), hz));
    const auto size = hn::Mul(hn::Set(d, kRounding), sum);
    const auto beside = [&](int axis, auto at, auto half) HWY_ATTR {
      const auto from = hn::Abs(hn::Sub(at, hn::Set(d, shaft.middle[axis])));
      return hn::Sub(hn::Sub(from, half), hn::Set(d, shaft.width[axis]));
    };
    auto far = hn::Max(beside(0, x, hx), hn::Max(beside(1, y, hy), beside(2, z, hz)));
    for (size_t i = 0; i < shaft.count; ++i) {
      const float *o = shaft.outward[i], *e = shaft.size[i];
      const auto center =
          MulThenAdd(hn::Set(d, o[2]), z,
                     MulThenAdd(hn::Set(d, o[1]), y,
                                MulThenSub(hn::Set(d, o[0]), x, hn::Set(d, shaft.offset[i]))));
      const auto away = NegMulThenAdd(
          hn::Set(d, e[2]), hz,
          NegMulThenAdd(hn::Set(d, e[1]), hy, NegMulThenAdd(hn::Set(d, e[0]), hx, center)));
      far = hn::Max(far, away);
    }
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Not(hn::Gt(far, size)), bytes);
    met |= (bytes[0] & ((1u << hn::Lanes(d)) - 1)) << k;
  }
  return met;
}

// ---- casters

// The largest errors by rounding, for rays whose starts have been moved as well.
HWY_INLINE void SetBounds(CasterBlock& block, size_t i, const LightPoint& light,
                          const Receiver& receiver, const D3& normal, VD longest,
                          const VD (&edgeLength)[3], const VD (&gradient)[3], VD toLight) {
  const Doubles d;
  const double spread = receiver.radius + receiver.reach;
  const Vec3d towards = light.towards(receiver.center);
  const double straight = length(towards);
  const double way = light.directional ? 1 : straight + spread;
  const double unit = kRoundings * kHalfUlp, flushed = kFlushed * (1 + way);
  const D3 from = Sub3(Load3(block.corner[0], i), All3(receiver.center));
  const VD away = hn::Add(hn::Add(Length3(from), longest), All(spread));
  const VD aside = Length3(Cross3(from, All3(towards)));
  const VD farthest = hn::Add(hn::Add(aside, hn::Mul(All(spread), toLight)),
                              hn::Mul(longest, All(straight + (light.directional ? 0 : spread))));
  const VD reach = All(receiver.reach), unitAway = hn::Mul(All(unit), away);
  for (size_t k = 0; k < 3; ++k) {
    const VD lengths = hn::Add(hn::Mul(edgeLength[k], All(way)), hn::Add(farthest, farthest));
    const VD bound =
        hn::Add(hn::Add(hn::Mul(unitAway, lengths), hn::Mul(gradient[k], reach)), All(flushed));
    hn::Store(bound, d, block.edgeBound[k] + i);
  }
  const VD area2 = Length3(normal);
  const VD turned = hn::Mul(All(unit), hn::Add(area2, hn::Mul(longest, away)));
  const VD moved = hn::Mul(area2, reach);
  const VD slope = hn::Mul(turned, All(way));
  hn::Store(hn::Add(light.directional ? slope : hn::Add(slope, moved), All(flushed)), d,
            block.slopeBound + i);
  const VD flushedAway = hn::Mul(All(kFlushed), hn::Add(All(1), away));
  hn::Store(hn::Add(hn::Add(hn::Mul(turned, away), moved), flushedAway), d, block.heightBound + i);
}

// What is linear in the ray's origin, from the corners.
void SetCasters(CasterBlock& block, const LightPoint& light, const Receiver& receiver) {
  const Doubles d;
  const D3 l = All3(light.position);
  for (size_t i = 0; i < CasterBlock::kCasters; i += hn::Lanes(d)) {
    const D3 corner[3] = {Load3(block.corner[0], i), Load3(block.corner[1], i),
                          Load3(block.corner[2], i)};
    const D3 normal = Cross3(Sub3(corner[1], corner[0]), Sub3(corner[2], corner[0]));
    Store3(normal, block.normal, i);
    const D3 lit[3] = {Sub3(corner[0], l), Sub3(corner[1], l), Sub3(corner[2], l)};
    VD edgeLength[3], gradient[3];
    for (size_t k = 0; k < 3; ++k) {
      const size_t next = (k + 1) % 3;
      const D3 edge = Sub3(corner[next], corner[k]);
      edgeLength[k] = Length3(edge);
      const D3 g = light.directional ? Cross3(edge, l) : Cross3(lit[k], lit[next]);
      gradient[k] = Length3(g);
      Store3(g, block.gradient[k], i);
    }
    const VD longest = hn::Max(hn::Max(edgeLength[0], edgeLength[1]), edgeLength[2]);
    const VD toLight = light.directional ? All(1) : Length3(lit[0]);
    const VD height = light.directional ? hn::Neg(Dot3(l, normal)) : Dot3(lit[0], normal);
    hn::Store(height, d, block.lightHeight + i);
    SetBounds(block, i, light, receiver, normal, longest, edgeLength, gradient, toLight);
  }
}

struct RangeLanes {
  VD least, most;
  HWY_INLINE void add(VD value) {
    least = hn::Min(least, value);
    most = hn::Max(most, value);
  }
  HWY_INLINE MD above(VD bound) const { return hn::Gt(least, bound); }
  HWY_INLINE MD below(VD bound) const { return hn::Lt(most, hn::Neg(bound)); }
};
HWY_INLINE RangeLanes Nothing() { return {hn::Inf(Doubles()), hn::Neg(hn::Inf(Doubles()))}; }

// Numbers linear in the ray's origin, over a receiver.
struct Extremes {
  RangeLanes heights, slopes, edges[3];
};

template <bool kDirectional>
HWY_INLINE Extremes Over(const CasterBlock& block, size_t i, const LightPoint& light,
                         const Receiver& receiver) {
  const D3 corner = Load3(block.corner[0], i), normal = Load3(block.normal, i);
  const D3 gradient[3] = {Load3(block.gradient[0], i), Load3(block.gradient[1], i),
                          Load3(block.gradient[2], i)};
  RangeLanes heights = Nothing(), slopes = Nothing(), e0 = Nothing(), e1 = Nothing(),
             e2 = Nothing();
  for (size_t k = 0; k < receiver.count; ++k) {
    const D3 o = All3(receiver.corners[k]);
    const D3 away = Sub3(corner, o);
    heights.add(Dot3(away, normal));
    if (kDirectional) {
      e0.add(Dot3(away, gradient[0]));
      e1.add(Dot3(Sub3(Load3(block.corner[1], i), o), gradient[1]));
      e2.add(Dot3(Sub3(Load3(block.corner[2], i), o), gradient[2]));
    } else {
      const D3 way = All3(light.position - receiver.corners[k]);
      slopes.add(Dot3(way, normal));
      e0.add(Dot3(way, gradient[0]));
      e1.add(Dot3(way, gradient[1]));
      e2.add(Dot3(way, gradient[2]));
    }
  }
  if (kDirectional)
    slopes.least = slopes.most = hn::Neg(hn::Load(Doubles(), block.lightHeight + i));
  return {heights, slopes, {e0, e1, e2}};
}

struct MeetingLanes {
  MD never, always;
};

// Compares the linear numbers over the receiver with their bounds.
template <bool kDirectional>
HWY_INLINE MeetingLanes Meet(const CasterBlock& block, size_t i, const LightPoint& light,
                             const Receiver& receiver) {
  const Doubles d;
  const Extremes of = Over<kDirectional>(block, i, light, receiver);
  const VD slopeBound = hn::Load(d, block.slopeBound + i);
  const VD heightBound = hn::Load(d, block.heightBound + i);
  const VD lightHeight = hn::Load(d, block.lightHeight + i);
  const VD edgeBound[3] = {hn::Load(d, block.edgeBound[0] + i), hn::Load(d, block.edgeBound[1] + i),
                           hn::Load(d, block.edgeBound[2] + i)};
  const VD lightBound = hn::Add(heightBound, slopeBound);
  const MD heightAbove = of.heights.above(heightBound), heightBelow = of.heights.below(heightBound);
  MD never = Either(Both(heightAbove, hn::Gt(lightHeight, lightBound)),
                    Both(heightBelow, hn::Lt(lightHeight, hn::Neg(lightBound))));

  const MD known = Either(of.slopes.above(slopeBound), of.slopes.below(slopeBound));
  const MD up = hn::Gt(of.slopes.least, hn::Zero(d));
  const VD least = hn::Abs(of.slopes.least), most = hn::Abs(of.slopes.most);
  const VD slopeSize = hn::Max(least, most), tolerance = All(kEdgeTolerance);
  const VD zero = hn::Add(hn::Mul(tolerance, slopeSize), hn::Mul(slopeBound, tolerance));
  const VD largestEdge = hn::Max(hn::Max(edgeBound[0], edgeBound[1]), edgeBound[2]);
  const VD leastSlope = hn::Sub(hn::Min(least, most), slopeBound);
  const MD steep = Both(known, hn::Gt(leastSlope, hn::Mul(All(3), hn::Add(largestEdge, zero))));
  const VD b0 = hn::Add(edgeBound[0], zero), b1 = hn::Add(edgeBound[1], zero),
           b2 = hn::Add(edgeBound[2], zero);
  const MD above0 = of.edges[0].above(b0), above1 = of.edges[1].above(b1),
           above2 = of.edges[2].above(b2);
  const MD below0 = of.edges[0].below(b0), below1 = of.edges[1].below(b1),
           below2 = of.edges[2].below(b2);
  const MD anyAbove = Either(above0, Either(above1, above2));
  const MD anyBelow = Either(below0, Either(below1, below2));
  const MD positive = Either(Both(steep, up), anyAbove);
  const MD negative = Either(hn::AndNot(up, steep), anyBelow);
  never = Either(never, Either(Both(anyBelow, positive), Both(anyAbove, negative)));

  const MD insideUp = Both(Both(up, heightAbove), Both(above0, Both(above1, above2)));
  const MD insideDown = hn::AndNot(up, Both(heightBelow, Both(below0, Both(below1, below2))));
  MD always = Both(known, Either(insideUp, insideDown));
  if (!kDirectional) {
    const VD end = hn::Add(lightBound, hn::Mul(All(0x1p-19), slopeSize));
    const VD ahead = hn::IfThenElse(up, hn::Neg(lightHeight), lightHeight);
    always = Both(always, hn::Gt(ahead, end));
  }
  return {never, always};
}

template <bool kDirectional>
HWY_INLINE size_t MeetAll(const CasterQuestion& question, const LightPoint& light,
                          const Receiver& receiver) {
  constexpr size_t kCasters = CasterBlock::kCasters;
  const size_t lanes = hn::Lanes(Doubles());
  const unsigned all = (1u << lanes) - 1;
  for (size_t b = 0; b < question.count; ++b) {
    const unsigned asked = question.asked[b];
    unsigned met = asked;
    for (size_t i = 0; i < kCasters; i += lanes) {
      if ((asked >> i & all) == 0) continue;
      const MeetingLanes meeting = Meet<kDirectional>(question.blocks[b], i, light, receiver);
      const unsigned hiding = (BitsOf(meeting.always) << i) & asked & question.opaque[b];
      if (hiding != 0) {
        return b * kCasters + hwy::Num0BitsBelowLS1Bit_Nonzero32(hiding);
      }
      met &= ~(BitsOf(meeting.never) << i);
    }
    question.met[b] = static_cast<CasterBits>(met);
  }
  return kNoCaster;
}

size_t MeetCasters(const CasterQuestion& question, const LightPoint& light,
                   const Receiver& receiver) {
  return light.directional ? MeetAll<true>(question, light, receiver)
                           : MeetAll<false>(question, light, receiver);
}

// ---- shafts

// Shaft::misses.
HWY_INLINE MD Passed(const CasterBlock& block, size_t i, const ShaftSides& shaft) {
  const Doubles d;
  const D3 a = Load3(block.corner[0], i), b = Load3(block.corner[1], i),
           c = Load3(block.corner[2], i);
  const VD growth = hn::Load(d, block.growth + i);
  const auto beside = [&](VD p, VD q, VD r, double lower, double upper) HWY_ATTR {
    const VD least = hn::Min(p, hn::Min(q, r)), most = hn::Max(p, hn::Max(q, r));
    return Either(hn::Gt(hn::Sub(least, growth), All(upper)),
                  hn::Lt(hn::Add(most, growth), All(lower)));
  };
  MD passed = Either(beside(a.x, b.x, c.x, shaft.lower.x, shaft.upper.x),
                     Either(beside(a.y, b.y, c.y, shaft.lower.y, shaft.upper.y),
                            beside(a.z, b.z, c.z, shaft.lower.z, shaft.upper.z)));
  for (size_t k = 0; k < shaft.count; ++k) {
    const D3 outward = All3(shaft.planes[k].outward);
    const VD bound = hn::Add(All(shaft.planes[k].offset), growth);
    const VD nearest = hn::Min(Dot3(outward, a), hn::Min(Dot3(outward, b), Dot3(outward, c)));
    passed = Either(passed, hn::Gt(nearest, bound));
  }
  return passed;
}

bool PassCasters(const CasterQuestion& question, const ShaftSides& shaft) {
  const size_t lanes = hn::Lanes(Doubles());
  const unsigned all = (1u << lanes) - 1;
  unsigned any = 0;
  for (size_t b = 0; b < question.count; ++b) {
    unsigned met = question.met[b];
    for (size_t i = 0; i < CasterBlock::kCasters; i += lanes) {
      if ((met >> i & all) == 0) continue;
      met &= ~(BitsOf(Passed(question.blocks[b], i, shaft)) << i);
    }
    question.met[b] = static_cast<CasterBits>(met);
    any |= met;
  }
  return any != 0;
}

CasterKernels FindCasterKernels() { return {MeetBoxes, SetCasters, MeetCasters, PassCasters}; }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(FindCasterKernels);
CasterKernels findCasterKernels() { return HWY_DYNAMIC_DISPATCH(FindCasterKernels)(); }
}  // namespace whit::simd
#endif
