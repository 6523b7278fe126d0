// Materials at surfels, by the names of their records' members.
#if defined(WHIT_SIMD_MATERIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_MATERIAL_INL_H_
#undef WHIT_SIMD_MATERIAL_INL_H_
#else
#define WHIT_SIMD_MATERIAL_INL_H_
#endif

#include "simd/records-inl.h"
#include "stages/shading_tables.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Each group is one load of four floats.
struct DiffuseLanes {
  V3 diffuse;
  VI diffuseMap;
};
struct SpecularLanes {
  V3 specular;
  VI specularMap;
};
struct EmissionLanes {
  V3 emission;
  VI normalMap;
};
struct LobeLanes {
  VF alpha;
  VU medium, flags;
  VI emissionMap;
};
struct RoughnessLanes {
  VF roughness;
  VI roughnessMap;
};
struct CoverageLanes {
  VF coverage;
  VI coverageMap;
};

class MaterialLanes {
 public:
  HWY_INLINE MaterialLanes(const ShadingTables& tables, VI material, MF live)
      : records_(tables.materials.data(), material, live) {}

  HWY_INLINE DiffuseLanes Diffuse() const {
    const V4 r = records_.template Load4<offsetof(MaterialRecord, diffuse),
                                         offsetof(MaterialRecord, diffuseMap)>();
    return {{r.x, r.y, r.z}, hn::BitCast(IntTag(), r.w)};
  }
  HWY_INLINE SpecularLanes Specular() const {
    const V4 r = records_.template Load4<offsetof(MaterialRecord, specular),
                                         offsetof(MaterialRecord, specularMap)>();
    return {{r.x, r.y, r.z}, hn::BitCast(IntTag(), r.w)};
  }
  HWY_INLINE EmissionLanes Emission() const {
    const V4 r = records_.template Load4<offsetof(MaterialRecord, emission),
                                         offsetof(MaterialRecord, normalMap)>();
    return {{r.x, r.y, r.z}, hn::BitCast(IntTag(), r.w)};
  }
  HWY_INLINE LobeLanes Lobe() const {
    constexpr size_t kAlpha = offsetof(MaterialRecord, alpha);
    static_assert(offsetof(MaterialRecord, medium) == kAlpha + 4 &&
                  offsetof(MaterialRecord, flags) == kAlpha + 8);
    const V4 r = records_.template Load4<kAlpha, offsetof(MaterialRecord, emissionMap)>();
    const UintTag du;
    return {r.x, hn::BitCast(du, r.y), hn::BitCast(du, r.z), hn::BitCast(IntTag(), r.w)};
  }
  HWY_INLINE RoughnessLanes Roughness() const {
    static_assert(offsetof(MaterialRecord, roughnessMap) ==
                  offsetof(MaterialRecord, roughness) + 4);
    const V4 r = records_.template Load4<offsetof(MaterialRecord, roughness)>();
    return {r.x, hn::BitCast(IntTag(), r.y)};
  }
  HWY_INLINE CoverageLanes Coverage() const {
    static_assert(offsetof(MaterialRecord, coverage) == offsetof(MaterialRecord, roughness) + 8);
    const V4 r = records_.template Load4<offsetof(MaterialRecord, roughness),
                                         offsetof(MaterialRecord, coverageMap)>();
    return {r.z, hn::BitCast(IntTag(), r.w)};
  }
  HWY_INLINE V3 Mirror() const {
    const V4 r = records_.template Load4<offsetof(MaterialRecord, mirror)>();
    return {r.x, r.y, r.z};
  }
  HWY_INLINE V3 GrazingMinusMirror() const {
    const V4 r = records_.template Load4<offsetof(MaterialRecord, grazingMinusMirror)>();
    return {r.x, r.y, r.z};
  }
  HWY_INLINE V3 Transmission() const {
    const V4 r = records_.template Load4<offsetof(MaterialRecord, transmission)>();
    return {r.x, r.y, r.z};
  }

 private:
  SharedRecords<MaterialRecord> records_;
};

// The lanes in which a word of flags has some of `bits`.
HWY_INLINE MF HasFlags(VU flags, uint32_t bits) {
  const UintTag du;
  return hn::RebindMask(FloatTag(), hn::Ne(hn::And(flags, hn::Set(du, bits)), hn::Zero(du)));
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
