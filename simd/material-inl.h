// Materials at surfels, by the names of their records' members; media along rays and at the
// surfaces that they meet. A ray travels in a stack of nested dielectrics: four bytes of an
// integer, each a medium's number, the one entered last in the low byte, 0 for none. Overlaps are
// settled by priority (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images").
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
  return hn::Load(IntTag(), reinterpret_cast<const int32_t*>(surfels.material) + i);
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
    return {r.x, hn::BitCast(du, r.y), hn::BitCast(du, r.z), hn::BitCast(IntTag(), r.w)};
  }
  HWY_INLINE NumberLanes Roughness() const {
    static_assert(offsetof(R, roughnessMap) == offsetof(R, roughness) + 4);
    const V4 r = records_.template Load4<offsetof(R, roughness)>();
    return {r.x, hn::BitCast(IntTag(), r.y)};
  }
  HWY_INLINE NumberLanes Coverage() const {
    static_assert(offsetof(R, coverage) == offsetof(R, roughness) + 8);
    const V4 r = records_.template Load4<offsetof(R, roughness), offsetof(R, coverageMap)>();
    return {r.z, hn::BitCast(IntTag(), r.w)};
  }

 private:
  using R = MaterialRecord;

  // The color at `kFirst`, and the number behind it.
  template <size_t kFirst, size_t kLast = kFirst + 3 * sizeof(float)>
  HWY_INLINE ColorLanes At() const {
    const V4 r = records_.template Load4<kFirst, kLast>();
    return {{r.x, r.y, r.z}, hn::BitCast(IntTag(), r.w)};
  }

  SharedRecords<MaterialRecord> records_;
};

// (1 - c)^5 (Schlick 1994).
HWY_INLINE VF SchlickTerm(VF c) {
  const VF m = hn::Sub(hn::Set(FloatTag(), 1.0f), c);
  const VF m2 = hn::Mul(m, m);
  return hn::Mul(hn::Mul(m2, m2), m);
}

// The mirror's reflectance at the surfels from i on; `byMaps`: the frame has Feature::mirrorMaps,
// `cosine`: between viewer and normal.
HWY_INLINE V3 MirrorReflectance(const MaterialLanes& material, const SurfelColumns& s, bool byMaps,
                                VF cosine, size_t i) {
  V3 normal = material.Mirror().color;
  if (byMaps) normal = Mul3(normal, Load3(s.mirror, i));
  return MulAdd3(Sub3(material.MirrorGrazing(), normal), SchlickTerm(cosine), normal);
}

// The lanes in which a word of flags has some of `bits`.
HWY_INLINE MF HasFlags(VU flags, uint32_t bits) {
  const UintTag du;
  return hn::RebindMask(FloatTag(), hn::Ne(hn::And(flags, hn::Set(du, bits)), hn::Zero(du)));
}

// Lanes of surfaces that are there: no misses, and none inside a dielectric of higher priority,
// where media are `nested`.
HWY_INLINE MF SurfaceLanes(const SurfelColumns& surfels, bool nested, size_t i) {
  const UintTag du;
  const VU material = hn::Load(du, surfels.material + i);
  const MF hit = hn::RebindMask(FloatTag(), hn::Ne(material, hn::Set(du, kMiss)));
  return nested ? hn::AndNot(HasFlags(hn::Load(du, surfels.flags + i), kHidden), hit) : hit;
}

// Moves the start of a shadow ray above its facet. Above the facet, the smooth surface alone
// decides what lies behind the horizon (Hanika 2021).
HWY_INLINE void LiftStart(const SurfelColumns& surfels, size_t i, V3& start, MF& front) {
  const V3 lift = Load3(surfels.lift, i);
  front = hn::Or(front, hn::Gt(MaxComponent(Abs3(lift)), hn::Zero(FloatTag())));
  start = Add3(start, lift);
}

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
  return GatherMember<offsetof(MediumRecord, priority)>(std::span(tables.media),
                                                        hn::BitCast(IntTag(), medium));
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

// The index of refraction of the medium on top of the stack by priority.
HWY_INLINE VF IorOf(const ShadingTables& tables, VU stack) {
  return GatherMember<offsetof(MediumRecord, ior)>(
      std::span(tables.media), hn::BitCast(IntTag(), CurrentMedium(tables, stack)));
}

// The stack behind the dielectrics whose faces share the place of the one that was crossed
// (HitColumns::alsoCrossed).
HWY_INLINE VU CrossOthers(VU stack, VU others) {
  const UintTag du;
  const VU zero = hn::Zero(du), one = hn::Set(du, 1u);
  while (!hn::AllTrue(du, hn::Eq(others, zero))) {
    const VU other = hn::And(others, hn::Set(du, (1u << kCrossedBits) - 1)),
             medium = hn::ShiftRight<1>(other);
    const auto enters = hn::Eq(hn::And(other, one), one);
    const VU behind =
        hn::IfThenElse(enters, PushMedium(stack, medium), RemoveMedium(stack, medium));
    stack = hn::IfThenElse(hn::Ne(medium, zero), behind, stack);
    others = hn::ShiftRight<kCrossedBits>(others);
  }
  return stack;
}

// Media on both sides of the surface, and whether it is there at all. `others`: as CrossOthers has
// it.
HWY_INLINE void StoreMedia(const ShadingTables& tables, const RayColumns& rays, VU medium,
                           MF entering, VU others, size_t i, const SurfelColumns& surfels) {
  const UintTag du;
  const VU stack = hn::Load(du, rays.media + i);
  const auto dielectric = hn::Ne(medium, hn::Zero(du));
  const auto enters = hn::RebindMask(du, entering);
  VU behind = hn::IfThenElse(enters, PushMedium(stack, medium), RemoveMedium(stack, medium));
  behind = CrossOthers(hn::IfThenElse(dielectric, behind, stack), others);
  const auto same = hn::Eq(CurrentMedium(tables, stack), CurrentMedium(tables, behind));
  const VU hidden = hn::IfThenElseZero(hn::And(dielectric, same), hn::Set(du, kHidden));
  hn::Store(hn::Or(hn::IfThenElseZero(enters, hn::Set(du, kEntering)), hidden), du,
            surfels.flags + i);
  hn::Store(behind, du, surfels.mediaBehind + i);
}

// exp(-sigma * t) into weight and throughput of rays that crossed an absorbing medium.
HWY_INLINE void Absorb(const ShadingTables& tables, const RayColumns& rays, const HitColumns& hits,
                       MF valid, size_t i) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const VU stack = hn::Load(du, rays.media + i);
  if (hn::AllTrue(du, hn::Eq(stack, hn::Zero(du)))) return;
  const VI medium = hn::BitCast(di, CurrentMedium(tables, stack));
  const Records<MediumRecord> records(tables.media.data(), Clamped(medium, tables.media.size()));
  const V4 record =
      records.Load4<offsetof(MediumRecord, ior), offsetof(MediumRecord, absorption[2])>();
  const VF t = hn::Load(d, hits.t + i);
  const auto transmittance = [&](VF sigma) HWY_ATTR {
    // 88 is past where exp underflows to zero; the limit keeps infinity out of the polynomial.
    const VF depth = hn::Min(hn::Mul(sigma, t), hn::Set(d, 104.0f));
    const VF hit = hn::IfThenElseZero(hn::Lt(depth, hn::Set(d, 87.0f)), hn::Exp(d, hn::Neg(depth)));
    const VF through = hn::IfThenElseZero(valid, hit);
    return hn::IfThenElse(hn::Gt(sigma, hn::Zero(d)), through, hn::Set(d, 1.0f));
  };
  const V3 factor{transmittance(record.y), transmittance(record.z), transmittance(record.w)};
  const V3 weight = Load3(rays.weight, i);
  Store3(Mul3(weight, factor), rays.weight, i);
  const VF throughput = hn::Load(d, rays.throughput + i);
  hn::Store(hn::Mul(throughput, MaxComponent(factor)), d, rays.throughput + i);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
