// Second half of findIntersections: from hits to surfels.
#include "simd/kernel_variants.h"
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/interpolate_surfels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/crossing-inl.h"
#include "simd/second_uvs-inl.h"
#include "simd/surface-inl.h"
#include "simd/surface_maps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

constexpr uint32_t kInstanced = EffectSet::bit(Effect::instances);
constexpr uint32_t kColored = EffectSet::bit(Effect::vertexColors);
constexpr uint32_t kGlossy = EffectSet::bit(Effect::glossy);
constexpr uint32_t kTransmission = EffectSet::bit(Effect::transmission);
constexpr uint32_t kAbsorption = EffectSet::bit(Effect::absorption);

// What vertex colors multiply, as the flags of the lanes' materials say.
struct Tints {
  V3 diffuse, specular, emission;
};

HWY_INLINE Tints FindTints(const V3& color, VF flagBits) {
  const FloatTag d;
  const UintTag du;
  const VU flags = hn::BitCast(du, flagBits);
  const auto has = [&](uint32_t flag) HWY_ATTR {
    return hn::RebindMask(d, hn::Ne(hn::And(flags, hn::Set(du, flag)), hn::Zero(du)));
  };
  const VF one = hn::Set(d, 1.0f);
  const V3 white{one, one, one};
  const MF emission = has(kMaterialTintsEmission);
  return {Select3(emission, white, color), Select3(has(kMaterialTintsSpecular), color, white),
          Select3(emission, color, white)};
}

// No maps wait there yet.
template <uint32_t kBits>
HWY_INLINE void ClearSlot(size_t slot, BlockTextures& block) {
  if constexpr ((kBits & kTextured) != 0) {
    block.diffuse.level.any[slot] = block.specular.level.any[slot] = false;
    block.emission.level.any[slot] = false;
  }
  if constexpr ((kBits & kNormalMapped) != 0) block.normal.level.any[slot] = false;
}

HWY_INLINE void QueueNormal(const ShadingTables& tables, VF map, const UvLanes& uv, MF valid,
                            const Surface& s, VF flip, const TexturePoints& at, size_t slot,
                            BlockTextures& block) {
  const MF mapped = MappedLanes(map, valid);
  if (hn::AllFalse(FloatTag(), mapped)) return;
  const TangentFrame frame = FindTangentFrame(uv, s.edge1, s.edge2, s.ns, s.handedness);
  QueueMap(tables, map, hn::And(mapped, frame.good), at, slot, block.normal);
  StoreFrame(frame, flip, slot, block);
}

template <uint32_t kBits>
HWY_INLINE void StoreEmission(const ShadingTables& tables, const V3& tint, VF map, MF valid,
                              const TexturePoints& at, size_t slot, BlockTextures& block, size_t i,
                              const SurfelColumns& surfels) {
  Store3(tint, surfels.emissionR, surfels.emissionG, surfels.emissionB, i);
  if constexpr ((kBits & kTextured) != 0) {
    QueueMap(tables, map, valid, at, slot, block.emission);
  }
}

// Everything but textures, which are queued, for the vector of rays at i; returns the flags of
// their materials.
template <uint32_t kBits>
HWY_INLINE VU InterpolateVector(const ShadingTables& tables, EffectSet effects,
                                const RayColumns& rays, const HitColumns& hits, size_t i,
                                size_t slot, float coneSpread, BlockTextures& block,
                                const SurfelColumns& surfels) {
  const FloatTag d;
  const UintTag du;
  const VF one = hn::Set(d, 1.0f);
  ClearSlot<kBits>(slot, block);
  const auto [valid, triangle] = LoadHits(hits, i);
  if ((effects.bits() & kAbsorption) != 0) Absorb(tables, rays, hits, valid, i);
  if (hn::AllFalse(d, valid)) {
    hn::Store(hn::Set(du, kMiss), du, surfels.material + i);
    return hn::Zero(du);
  }
  const TriangleLanes t = LoadTriangles(tables, triangle);
  const Weights w = LoadWeights(hits, i);
  Surface s = InterpolateSurface<(kBits & kSmooth) != 0>(tables, t, triangle, w);
  if ((effects.bits() & kInstanced) != 0) CarryToWorld(tables, hits, valid, i, s);
  const TableReader material(tables.materials.data(), kMaterialStride, t.material, valid);
  const V4 diffuse = material.Columns4(0);
  TexturePoints at{Interpolate(w, t.uv.u0, t.uv.u1, t.uv.u2),
                   Interpolate(w, t.uv.v0, t.uv.v1, t.uv.v2), hn::Zero(d)};
  const VF cosine = Dot(Load3(rays.dirX, rays.dirY, rays.dirZ, i), s.ng);
  if (surfels.cone) {
    const VF width =
        hn::MulAdd(hn::Set(d, coneSpread), hn::Load(d, hits.t + i), hn::Load(d, rays.cone + i));
    hn::Store(width, d, surfels.cone + i);
    at.footprint = TextureFootprint(t.uv, s.edge1, s.edge2, width, cosine);
  }
  const MF entering = hn::Lt(cosine, hn::Zero(d));
  const VF flip = TurnToViewer(entering);
  if constexpr ((kBits & kTextured) != 0) {
    QueueMap(tables, diffuse.w, valid, at, slot, block.diffuse);
  }
  if constexpr ((kBits & kNormalMapped) != 0) {
    QueueNormal(tables, material.Columns4(8).w, t.uv, valid, s, flip, at, slot, block);
  }
  StoreSurface(s, flip, i, surfels);
  const V4 lobe = material.Columns4(12);
  Tints tints{{one, one, one}, {one, one, one}, {one, one, one}};
  const bool colored = (effects.bits() & kColored) != 0;
  V3 scattered{diffuse.x, diffuse.y, diffuse.z};
  if (colored) {
    tints = FindTints(VertexColor(tables, triangle, w.w1, w.w2), lobe.z);
    scattered = Mul3(scattered, tints.diffuse);
  }
  Store3(scattered, surfels.diffuseR, surfels.diffuseG, surfels.diffuseB, i);
  if (surfels.emissionR) {
    StoreEmission<kBits>(tables, tints.emission, lobe.w, valid, at, slot, block, i, surfels);
  }
  const VU materialOrMiss =
      hn::IfThenElse(hn::RebindMask(du, valid), hn::BitCast(du, t.material), hn::Set(du, kMiss));
  hn::Store(materialOrMiss, du, surfels.material + i);
  if ((effects.bits() & kGlossy) != 0) {
    const V4 specular = material.Columns4(4);
    if constexpr ((kBits & kTextured) != 0) {
      QueueMap(tables, specular.w, valid, at, slot, block.specular);
    }
    V3 f0{specular.x, specular.y, specular.z};
    if (colored) f0 = Mul3(f0, tints.specular);
    Store3(f0, surfels.specularR, surfels.specularG, surfels.specularB, i);
    hn::Store(lobe.x, d, surfels.alpha + i);
  }
  if ((effects.bits() & kTransmission) != 0) StoreMedia(tables, rays, lobe.y, entering, i, surfels);
  return hn::BitCast(du, hn::IfThenElseZero(valid, lobe.z));
}

// What the vector at i has queued.
template <uint32_t kBits>
HWY_INLINE void ApplyTextures(const ShadingTables& tables, EffectSet effects,
                              const BlockTextures& block, size_t slot, const SurfelColumns& surfels,
                              size_t i) {
  if constexpr ((kBits & kTextured) != 0) {
    if (surfels.emissionR) {
      ApplyColor(tables, block.emission, slot, surfels.emissionR, surfels.emissionG,
                 surfels.emissionB, i);
    }
    ApplyColor(tables, block.diffuse, slot, surfels.diffuseR, surfels.diffuseG, surfels.diffuseB,
               i);
    if ((effects.bits() & kGlossy) != 0) {
      ApplyColor(tables, block.specular, slot, surfels.specularR, surfels.specularG,
                 surfels.specularB, i);
    }
  }
  if constexpr ((kBits & kNormalMapped) != 0) {
    ApplyNormalMap(tables, block, slot, surfels, i);
  }
}

template <uint32_t kBits>
HWY_INLINE void PrefetchTriangles(const ShadingTables& tables, const HitColumns& hits, size_t begin,
                                  size_t end) {
  // Locals: what memory may alias would be read again for every ray.
  const uint32_t* const hit = hits.triangle;
  const TriangleRecord* const triangles = tables.triangles;
  const auto* const normals = reinterpret_cast<const float*>(tables.normals);
  const auto stride = static_cast<size_t>(tables.normalStride);
  for (size_t i = begin; i < end; ++i) {
    const size_t triangle = hit[i] == kMiss ? 0 : hit[i];
    hwy::Prefetch(triangles + triangle);
    if constexpr ((kBits & kSmooth) != 0) hwy::Prefetch(normals + triangle * stride);
  }
}

template <uint32_t kBits>
HWY_NOINLINE uint32_t InterpolateSurfelsVariant(const ShadingTables& tables, EffectSet effects,
                                                const RayColumns& rays, const HitColumns& hits,
                                                size_t n, const SurfelColumns& surfels,
                                                float coneSpread) {
  const UintTag du;
  const size_t lanes = hn::Lanes(du);
  VU flags = hn::Zero(du);
  BlockTextures block;
  for (size_t begin = 0; begin < n; begin += TexelQueue::kRays) {
    const size_t end = begin + TexelQueue::kRays < n ? begin + TexelQueue::kRays : n;
    PrefetchTriangles<kBits>(tables, hits, begin, end);
    for (size_t i = begin; i < end; i += lanes) {
      flags = hn::Or(flags, InterpolateVector<kBits>(tables, effects, rays, hits, i, i - begin,
                                                     coneSpread, block, surfels));
      if constexpr ((kBits & (kTextured | kNormalMapped)) != 0) {
        if (HWY_UNLIKELY(tables.secondUvs != nullptr)) {
          QueueByOwnUvs<kBits>(tables, effects, rays, hits, i, i - begin, block, surfels);
        }
      }
    }
    if constexpr ((kBits & (kTextured | kNormalMapped)) != 0) {
      for (size_t i = begin; i < end; i += lanes) {
        ApplyTextures<kBits>(tables, effects, block, i - begin, surfels, i);
      }
    }
  }
  HWY_ALIGN uint32_t perLane[16];
  hn::Store(flags, du, perLane);
  uint32_t any = 0;
  for (size_t lane = 0; lane < lanes; ++lane) any |= perLane[lane];
  return any;
}

uint32_t InterpolateSurfels(const ShadingTables& tables, EffectSet effects, const RayColumns& rays,
                            const HitColumns& hits, size_t n, const SurfelColumns& surfels,
                            float coneSpread) {
  static constexpr auto kVariants = variantTable<kInterpolateSurfels>(
      []<uint32_t kBits>() { return &InterpolateSurfelsVariant<kBits>; });
  return kVariants[kInterpolateSurfels.variantFor(effects)](tables, effects, rays, hits, n, surfels,
                                                            coneSpread);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(InterpolateSurfels);
std::uint32_t interpolateSurfels(const ShadingTables& tables, EffectSet effects,
                                 const RayColumns& rays, const HitColumns& hits, std::size_t n,
                                 const SurfelColumns& surfels, float coneSpread) noexcept {
  return HWY_DYNAMIC_DISPATCH(InterpolateSurfels)(tables, effects, rays, hits, n, surfels,
                                                  coneSpread);
}
}  // namespace whit::simd
#endif
