// Second half of findIntersections: from hits to surfels.
#include "simd/kernel_variants.h"
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/interpolate_surfels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep

#include "hwy/contrib/math/math-inl.h"
#include "simd/media-inl.h"
#include "simd/surface_maps-inl.h"
#include "simd/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

constexpr uint32_t kSmooth = EffectSet::bit(Effect::smoothNormals);
constexpr uint32_t kTextured = EffectSet::bit(Effect::textures);
constexpr uint32_t kNormalMapped = EffectSet::bit(Effect::normalMaps);
constexpr uint32_t kInstanced = EffectSet::bit(Effect::instances);
constexpr uint32_t kColoured = EffectSet::bit(Effect::vertexColours);
constexpr uint32_t kGlossy = EffectSet::bit(Effect::glossy);
constexpr uint32_t kTransmission = EffectSet::bit(Effect::transmission);
constexpr uint32_t kAbsorption = EffectSet::bit(Effect::absorption);

// Media on both sides of the surface, and whether it is there at all.
HWY_INLINE void StoreMedia(const ShadingTables& tables, const RayColumns& rays, VF mediumBits,
                           MF entering, size_t i, const SurfelColumns& surfels) {
  const UintTag du;
  const VU stack = hn::Load(du, rays.media + i);
  const VU medium = hn::BitCast(du, mediumBits);
  const auto dielectric = hn::Ne(medium, hn::Zero(du));
  const auto enters = hn::RebindMask(du, entering);
  VU behind = hn::IfThenElse(enters, PushMedium(stack, medium), RemoveMedium(stack, medium));
  behind = hn::IfThenElse(dielectric, behind, stack);
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
  const Records records = RecordsAt(tables.media.data(), kMediumStride, medium);
  const V4 record = LoadColumns4(records, 0);
  const VF t = hn::Load(d, hits.t + i);
  const auto transmittance = [&](VF sigma) HWY_ATTR {
    // 88 is past where exp underflows to zero; the limit keeps infinity out of the polynomial.
    const VF depth = hn::Min(hn::Mul(sigma, t), hn::Set(d, 104.0f));
    const VF hit = hn::IfThenElseZero(hn::Lt(depth, hn::Set(d, 87.0f)), hn::Exp(d, hn::Neg(depth)));
    const VF through = hn::IfThenElseZero(valid, hit);
    return hn::IfThenElse(hn::Gt(sigma, hn::Zero(d)), through, hn::Set(d, 1.0f));
  };
  const V3 factor{transmittance(record.y), transmittance(record.z), transmittance(record.w)};
  const V3 weight = Load3(rays.weightR, rays.weightG, rays.weightB, i);
  Store3(Mul3(weight, factor), rays.weightR, rays.weightG, rays.weightB, i);
  const VF throughput = hn::Load(d, rays.throughput + i);
  hn::Store(hn::Mul(throughput, MaxComponent(factor)), d, rays.throughput + i);
}

// What vertex colours multiply, as the flags of the lanes' materials say.
struct Tints {
  V3 diffuse, specular, emission;
};

HWY_INLINE Tints FindTints(const V3& colour, VF flagBits) {
  const FloatTag d;
  const UintTag du;
  const VU flags = hn::BitCast(du, flagBits);
  const auto has = [&](uint32_t flag) HWY_ATTR {
    return hn::RebindMask(d, hn::Ne(hn::And(flags, hn::Set(du, flag)), hn::Zero(du)));
  };
  const VF one = hn::Set(d, 1.0f);
  const V3 white{one, one, one};
  const MF emission = has(kMaterialTintsEmission);
  return {Select3(emission, white, colour), Select3(has(kMaterialTintsSpecular), colour, white),
          Select3(emission, colour, white)};
}

// Everything but textures, which are queued, for the vector of rays at i; returns the flags of
// their materials.
template <uint32_t kBits>
HWY_INLINE VU InterpolateVector(const ShadingTables& tables, EffectSet effects,
                                const RayColumns& rays, const HitColumns& hits, size_t i,
                                size_t slot, float coneSpread, BlockTextures& block,
                                const SurfelColumns& surfels) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const VF one = hn::Set(d, 1.0f);
  if constexpr ((kBits & kTextured) != 0) {
    block.diffuse.level.any[slot] = block.specular.level.any[slot] = false;
    block.emission.level.any[slot] = false;
  }
  if constexpr ((kBits & kNormalMapped) != 0) block.normal.level.any[slot] = false;
  const VU hit = hn::Load(du, hits.triangle + i);
  const MF valid = hn::RebindMask(d, hn::Ne(hit, hn::Set(du, kMiss)));
  if ((effects.bits() & kAbsorption) != 0) Absorb(tables, rays, hits, valid, i);
  if (hn::AllFalse(d, valid)) {
    hn::Store(hn::Set(du, kMiss), du, surfels.material + i);
    return hn::Zero(du);
  }
  const VI triangle = hn::IfThenElseZero(hn::RebindMask(di, valid), hn::BitCast(di, hit));
  const TriangleLanes t = LoadTriangles(tables, triangle);
  const VF u = hn::Load(d, hits.u + i), v = hn::Load(d, hits.v + i);
  const Weights w{hn::Sub(hn::Sub(one, u), v), u, v};
  V3 edge1 = Sub3(t.p1, t.p0), edge2 = Sub3(t.p2, t.p0);
  V3 position = Interpolate3(w, t.p0, t.p1, t.p2);
  V3 ng = GeometricNormal(edge1, edge2, tables.shading.reciprocal);
  V3 ns = ng;
  if constexpr ((kBits & kSmooth) != 0) ns = SmoothNormal(tables, triangle, w, ng);
  // Rounding error of the interpolated point: at most gamma(7) times this sum a component
  // (pbrt-v4, section 6.8.5); 32 ulps along the normal also cover Embree's own arithmetic.
  const Weights wa{hn::Abs(w.w0), hn::Abs(w.w1), hn::Abs(w.w2)};
  V3 magnitude = Interpolate3(wa, Abs3(t.p0), Abs3(t.p1), Abs3(t.p2));
  VF handedness = one;
  if ((effects.bits() & kInstanced) != 0) {
    const VI instance = hn::Load(di, reinterpret_cast<const int32_t*>(hits.instance) + i);
    const MF placed = hn::And(valid, hn::RebindMask(d, NonNegative(instance)));
    if (!hn::AllFalse(d, placed)) {
      const TableReader reader(tables.instances.data(), kInstanceStride, instance, placed);
      const InstanceLanes m{reader.Columns4(0), reader.Columns4(4), reader.Columns4(8)};
      const InstanceLanes normal{reader.Columns4(12), reader.Columns4(16), reader.Columns4(20)};
      const V3 origin{m.row0.w, m.row1.w, m.row2.w};
      const InstanceLanes abs{{hn::Abs(m.row0.x), hn::Abs(m.row0.y), hn::Abs(m.row0.z), one},
                              {hn::Abs(m.row1.x), hn::Abs(m.row1.y), hn::Abs(m.row1.z), one},
                              {hn::Abs(m.row2.x), hn::Abs(m.row2.y), hn::Abs(m.row2.z), one}};
      magnitude = Select3(placed, Add3(TransformVector(abs, magnitude), Abs3(origin)), magnitude);
      position = Select3(placed, Add3(TransformVector(m, position), origin), position);
      edge1 = Select3(placed, TransformVector(m, edge1), edge1);
      edge2 = Select3(placed, TransformVector(m, edge2), edge2);
      ng = Select3(placed, NormalizeOr(TransformVector(normal, ng), ng), ng);
      ns = Select3(placed, NormalizeOr(TransformVector(normal, ns), ng), ns);
      handedness = hn::IfThenElse(placed, reader.Columns4(24).x, one);
    }
  }
  const TableReader material(tables.materials.data(), kMaterialStride, t.material, valid);
  const V4 diffuse = material.Columns4(0);
  TexturePoints at{Interpolate(w, t.uv.u0, t.uv.u1, t.uv.u2),
                   Interpolate(w, t.uv.v0, t.uv.v1, t.uv.v2), hn::Zero(d)};
  const V3 direction = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
  const VF cosine = Dot(direction, ng);
  if (surfels.cone) {
    const VF width =
        hn::MulAdd(hn::Set(d, coneSpread), hn::Load(d, hits.t + i), hn::Load(d, rays.cone + i));
    hn::Store(width, d, surfels.cone + i);
    at.footprint = TextureFootprint(t.uv, edge1, edge2, width, cosine);
  }
  // A copy: what others have the address of does not stay in registers.
  const auto mapHits = [&]() HWY_ATTR {
    const VF width = surfels.cone ? hn::Load(d, surfels.cone + i) : hn::Zero(d);
    return MapHits{t.uv, triangle, t.material, valid, w, edge1, edge2, width, cosine};
  };
  const MF entering = hn::Lt(cosine, hn::Zero(d));
  const VF flip = hn::IfThenElse(entering, one, hn::Set(d, -1.0f));
  if constexpr ((kBits & kTextured) != 0) {
    QueueMap(tables, diffuse.w, valid, at, slot, block.diffuse);
  }
  if constexpr ((kBits & kNormalMapped) != 0) {
    const VF map = material.Columns4(8).w;
    const MF mapped = hn::And(valid, hn::RebindMask(d, NonNegative(hn::BitCast(di, map))));
    if (!hn::AllFalse(d, mapped)) {
      if (HWY_UNLIKELY(tables.secondUvs != nullptr)) {
        QueueNormalByOwnUvs(tables, mapHits(), map, NormalSpace{ns, handedness, flip}, slot, block);
      } else {
        const TangentFrame frame = FindTangentFrame(t.uv, edge1, edge2, ns, handedness);
        QueueMap(tables, map, hn::And(mapped, frame.good), at, slot, block.normal);
        StoreFrame(frame, flip, slot, block);
      }
    }
  }
  Store3(position, surfels.posX, surfels.posY, surfels.posZ, i);
  Store3(Scale3(ng, flip), surfels.ngX, surfels.ngY, surfels.ngZ, i);
  Store3(Scale3(ns, flip), surfels.nsX, surfels.nsY, surfels.nsZ, i);
  const VF sum = hn::Add(hn::Add(magnitude.x, magnitude.y), magnitude.z);
  hn::Store(hn::Mul(sum, hn::Set(d, 0x1p-19f)), d, surfels.offset + i);
  const V4 lobe = material.Columns4(12);
  Tints tints{{one, one, one}, {one, one, one}, {one, one, one}};
  const bool coloured = (effects.bits() & kColoured) != 0;
  V3 scattered{diffuse.x, diffuse.y, diffuse.z};
  if (coloured) {
    tints = FindTints(VertexColour(tables, triangle, u, v), lobe.z);
    scattered = Mul3(scattered, tints.diffuse);
  }
  Store3(scattered, surfels.diffuseR, surfels.diffuseG, surfels.diffuseB, i);
  if (surfels.emissionR) {
    Store3(tints.emission, surfels.emissionR, surfels.emissionG, surfels.emissionB, i);
    if constexpr ((kBits & kTextured) != 0) {
      if (HWY_UNLIKELY(tables.secondUvs != nullptr)) {
        QueueEmissionByOwnUvs(tables, mapHits(), lobe.w, slot, block);
      } else {
        QueueMap(tables, lobe.w, valid, at, slot, block.emission);
      }
    }
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
    if (coloured) f0 = Mul3(f0, tints.specular);
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
      ApplyColour(tables, block.emission, slot, surfels.emissionR, surfels.emissionG,
                  surfels.emissionB, i);
    }
    ApplyColour(tables, block.diffuse, slot, surfels.diffuseR, surfels.diffuseG, surfels.diffuseB,
                i);
    if ((effects.bits() & kGlossy) != 0) {
      ApplyColour(tables, block.specular, slot, surfels.specularR, surfels.specularG,
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
  for (size_t i = begin; i < end; ++i) {
    const uint32_t triangle = hits.triangle[i];
    if (triangle == kMiss) continue;
    hwy::Prefetch(tables.triangles + triangle);
    if constexpr ((kBits & kSmooth) != 0) {
      hwy::Prefetch(reinterpret_cast<const float*>(tables.normals) +
                    triangle * static_cast<size_t>(tables.normalStride));
    }
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
