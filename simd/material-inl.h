// Materials at surfels, by the names of their records' members; media along rays and at the
// surfaces that they meet. A ray travels in a stack of nested dielectrics: four bytes of an
// integer, each a medium's number, the one entered last in the low byte, 0 for none. Overlaps are
// decided by priority (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images").
#if defined(WHIT_SIMD_MATERIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_MATERIAL_INL_H_
#undef WHIT_SIMD_MATERIAL_INL_H_
#else
#define WHIT_SIMD_MATERIAL_INL_H_
#endif

#include "simd/records-inl.h"
#include "stages/columns.h"
#include "stages/shading_tables.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

HWY_INLINE V3 DirectionAt(const RayColumns& rays, size_t i) { return Load3(rays.dir, i); }

// Numbers of materials; kMiss, where rays missed, is negative.
HWY_INLINE VI MaterialNumbers(const SurfelColumns& surfels, size_t i) {
  return Load(IntTag(), reinterpret_cast<const int32_t*>(surfels.material) + i);
}

// A color or a number of the materials, and the map that it is multiplied by.
struct ColorLanes {
  V3 color;
  VI map;
};
struct NumberLanes {
  VF number;
  VI map;
};
struct LobeLanes {
  VF alpha;
  VU medium, flags;
  VI emissionMap;
};

// Each function is one load of four floats.
class MaterialLanes {
 public:
  HWY_INLINE MaterialLanes(const ShadingTables& tables, VI material, MF live)
      : records_(tables.materials.data(), Clamped(material, tables.materials.size()), live) {}

  HWY_INLINE ColorLanes Diffuse() const {
    return At<offsetof(R, diffuse), offsetof(R, diffuseMap)>();
  }
  HWY_INLINE ColorLanes Specular() const {
    return At<offsetof(R, specular), offsetof(R, specularMap)>();
  }
  HWY_INLINE V3 Emission() const { return At<offsetof(R, emission)>().color; }
  HWY_INLINE VI NormalMap() const {
    return At<offsetof(R, emission), offsetof(R, normalMap)>().map;
  }
  HWY_INLINE ColorLanes Mirror() const { return At<offsetof(R, mirror), offsetof(R, mirrorMap)>(); }
  HWY_INLINE V3 MirrorGrazing() const { return At<offsetof(R, mirrorGrazing)>().color; }
  HWY_INLINE VI OcclusionMap() const {
    return At<offsetof(R, mirrorGrazing), offsetof(R, occlusionMap)>().map;
  }
  HWY_INLINE ColorLanes Transmission() const {
    return At<offsetof(R, transmission), offsetof(R, transmissionMap)>();
  }
  HWY_INLINE LobeLanes Lobe() const {
    constexpr size_t kAlpha = offsetof(R, alpha);
    static_assert(offsetof(R, medium) == kAlpha + 4 && offsetof(R, flags) == kAlpha + 8);
    const V4 r = records_.template Load4<kAlpha, offsetof(R, emissionMap)>();
    const UintTag du;
    return {r.x, BitCast(du, r.y), BitCast(du, r.z), BitCast(IntTag(), r.w)};
  }
  HWY_INLINE NumberLanes Roughness() const {
    static_assert(offsetof(R, roughnessMap) == offsetof(R, roughness) + 4);
    const V4 r = records_.template Load4<offsetof(R, roughness)>();
    return {r.x, BitCast(IntTag(), r.y)};
  }
  HWY_INLINE NumberLanes Coverage() const {
    static_assert(offsetof(R, coverage) == offsetof(R, roughness) + 8);
    const V4 r = records_.template Load4<offsetof(R, roughness), offsetof(R, coverageMap)>();
    return {r.z, BitCast(IntTag(), r.w)};
  }

 private:
  using R = MaterialRecord;

  // The color at `kFirst`, and the number behind it.
  template <size_t kFirst, size_t kLast = kFirst + 3 * sizeof(float)>
  HWY_INLINE ColorLanes At() const {
    const V4 r = records_.template Load4<kFirst, kLast>();
    return {{r.x, r.y, r.z}, BitCast(IntTag(), r.w)};
  }

  SharedRecords<MaterialRecord> records_;
};

// (1 - c)^5 (Schlick 1994).
HWY_INLINE VF SchlickTerm(VF c) {
  const VF m = Sub(Set(1.0f), c);
  const VF m2 = Mul(m, m);
  return Mul(Mul(m2, m2), m);
}

// The reflectance at the angle of this cosine, between those along the normal and at grazing
// angles.
HWY_INLINE V3 SchlickColor(const V3& normal, const V3& grazing, VF cosine) {
  return MulAdd3(Sub3(grazing, normal), SchlickTerm(cosine), normal);
}

// The mirror's reflectance at the surfels from i on; `byMaps`: the frame has Feature::mirrorMaps,
// `cosine`: between viewer and normal.
HWY_INLINE V3 MirrorReflectance(const MaterialLanes& material, const SurfelColumns& s, bool byMaps,
                                VF cosine, size_t i) {
  V3 normal = material.Mirror().color;
  if (byMaps) normal = Mul3(normal, Load3(s.mirror, i));
  return SchlickColor(normal, material.MirrorGrazing(), cosine);
}

// The lanes in which a word of flags has some of `bits`.
HWY_INLINE MF HasFlags(VU flags, uint32_t bits) {
  const UintTag du;
  return RebindMask(FloatTag(), Ne(And(flags, Set(bits)), Zero(du)));
}

// Lanes of surfaces that are there: no misses, and none inside a dielectric of higher priority,
// where media are `nested`.
HWY_INLINE MF SurfaceLanes(const SurfelColumns& surfels, bool nested, size_t i) {
  const VU material = Load(surfels.material, i);
  const MF hit = RebindMask(FloatTag(), Ne(material, Set(kMiss)));
  return nested ? AndNot(HasFlags(Load(surfels.flags, i), kHidden), hit) : hit;
}

// Moves the start of a shadow ray above its facet. Above the facet, the smooth surface alone
// decides what lies behind the horizon (Hanika 2021).
HWY_INLINE void OffsetShadowStart(const SurfelColumns& surfels, size_t i, V3& start, MF& front) {
  const V3 offset = Load3(surfels.shadowOffset, i);
  front = Or(front, Gt(MaxComponent(Abs3(offset)), Zero()));
  start = Add3(start, offset);
}

HWY_INLINE VU PushMedium(VU stack, VU medium) { return Or(hn::ShiftLeft<8>(stack), medium); }

// Drops the lowest byte equal to `medium` (not 0) and closes the gap; unchanged if there is none.
HWY_INLINE VU RemoveMedium(VU stack, VU medium) {
  const auto byteIs = [&](VU shifted) HWY_ATTR { return Eq(And(shifted, Set(0xFFu)), medium); };
  const VU above = ShiftRight<8>(stack);
  const auto without = [&](uint32_t keep)
                           HWY_ATTR { return Or(And(stack, Set(keep)), And(above, Set(~keep))); };
  VU result = stack;
  result = IfThenElse(byteIs(ShiftRight<24>(stack)), without(0x00FFFFFFu), result);
  // The byte that moves down from beyond the top is zero.
  result = IfThenElse(byteIs(ShiftRight<16>(stack)), without(0x0000FFFFu), result);
  result = IfThenElse(byteIs(above), without(0x000000FFu), result);
  return IfThenElse(byteIs(stack), above, result);
}

HWY_INLINE VF PriorityOf(const ShadingTables& tables, VU medium) {
  return GatherMember<offsetof(MediumRecord, priority)>(std::span(tables.media),
                                                        BitCast(IntTag(), medium));
}

// The medium that counts: highest priority, entered last among equals; 0 outside everything.
HWY_INLINE VU CurrentMedium(const ShadingTables& tables, VU stack) {
  const UintTag du;
  const FloatTag d;
  const VU byte = Set(0xFFu);
  VU best = And(stack, byte);
  if (tables.samePriority) return best;
  VF bestPriority = PriorityOf(tables, best);
  const auto consider = [&](VU candidate) HWY_ATTR {
    const VF priority = PriorityOf(tables, candidate);
    const auto filled = RebindMask(d, Ne(candidate, Zero(du)));
    const auto wins = And(filled, Gt(priority, bestPriority));
    best = IfThenElse(RebindMask(du, wins), candidate, best);
    bestPriority = IfThenElse(wins, priority, bestPriority);
  };
  consider(And(ShiftRight<8>(stack), byte));
  consider(And(ShiftRight<16>(stack), byte));
  consider(ShiftRight<24>(stack));
  return best;
}

// The index of refraction of the medium on top of the stack by priority.
HWY_INLINE VF IorOf(const ShadingTables& tables, VU stack) {
  return GatherMember<offsetof(MediumRecord, ior)>(std::span(tables.media),
                                                   BitCast(IntTag(), CurrentMedium(tables, stack)));
}

// The stack behind the dielectrics whose faces share the place of the one that was crossed
// (HitColumns::alsoCrossed).
HWY_INLINE VU CrossOthers(VU stack, VU others) {
  const UintTag du;
  const VU zero = Zero(du), one = Set(1u);
  while (!AllTrue(du, Eq(others, zero))) {
    const VU other = And(others, Set((1u << kCrossedBits) - 1)), medium = ShiftRight<1>(other);
    const auto enters = Eq(And(other, one), one);
    const VU behind = IfThenElse(enters, PushMedium(stack, medium), RemoveMedium(stack, medium));
    stack = IfThenElse(Ne(medium, zero), behind, stack);
    others = ShiftRight<kCrossedBits>(others);
  }
  return stack;
}

// Media on both sides of the surface, and whether it is there at all. `others`: as CrossOthers has
// it.
HWY_INLINE void StoreMedia(const ShadingTables& tables, const RayColumns& rays, VU medium,
                           MF entering, VU others, size_t i, const SurfelColumns& surfels) {
  const UintTag du;
  const VU stack = Load(rays.media, i);
  const auto dielectric = Ne(medium, Zero(du));
  const auto enters = RebindMask(du, entering);
  VU behind = IfThenElse(enters, PushMedium(stack, medium), RemoveMedium(stack, medium));
  behind = CrossOthers(IfThenElse(dielectric, behind, stack), others);
  const auto same = Eq(CurrentMedium(tables, stack), CurrentMedium(tables, behind));
  const VU hidden = IfThenElseZero(And(dielectric, same), Set(kHidden));
  Store(Or(IfThenElseZero(enters, Set(kEntering)), hidden), surfels.flags, i);
  Store(behind, surfels.mediaBehind, i);
}

// Multiplies weight and throughput of rays by what a medium leaves of their light.
HWY_INLINE void DimRays(const RayColumns& rays, const V3& factor, size_t i) {
  const V3 weight = Load3(rays.weight, i);
  Store3(Mul3(weight, factor), rays.weight, i);
  const VF throughput = Load(rays.throughput, i);
  Store(Mul(throughput, MaxComponent(factor)), rays.throughput, i);
}

// Dims rays that crossed an absorbing medium by exp(-sigma * t).
HWY_INLINE void Absorb(const ShadingTables& tables, const RayColumns& rays, const HitColumns& hits,
                       MF valid, size_t i) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const VU stack = Load(rays.media, i);
  if (AllTrue(du, Eq(stack, Zero(du)))) return;
  const VI medium = BitCast(di, CurrentMedium(tables, stack));
  const Records<MediumRecord> records(tables.media.data(), Clamped(medium, tables.media.size()));
  const V4 record =
      records.Load4<offsetof(MediumRecord, ior), offsetof(MediumRecord, absorption[2])>();
  const VF t = Load(hits.t, i);
  const auto transmittance = [&](VF sigma) HWY_ATTR {
    // Beyond a depth of 87 the share is no normal float any more and counts as 0. The bound of 104
    // keeps infinity out of Highway's polynomial.
    const VF depth = Min(Mul(sigma, t), Set(104.0f));
    const VF hit = IfThenElseZero(Lt(depth, Set(87.0f)), hn::Exp(d, Neg(depth)));
    const VF through = IfThenElseZero(valid, hit);
    return IfThenElse(Gt(sigma, Zero()), through, Set(1.0f));
  };
  DimRays(rays, {transmittance(record.y), transmittance(record.z), transmittance(record.w)}, i);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
