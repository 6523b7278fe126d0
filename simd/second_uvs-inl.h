// Maps that are looked up with a material's second texture coordinates.
#if defined(WHIT_SIMD_SECOND_UVS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_SECOND_UVS_INL_H_
#undef WHIT_SIMD_SECOND_UVS_INL_H_
#else
#define WHIT_SIMD_SECOND_UVS_INL_H_
#endif

#include "core/effects.h"
#include "simd/surface-inl.h"
#include "simd/surface_maps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// What variants of interpolateSurfels are compiled for.
constexpr uint32_t kSmooth = EffectSet::bit(Effect::smoothNormals);
constexpr uint32_t kTextured = EffectSet::bit(Effect::textures);
constexpr uint32_t kNormalMapped = EffectSet::bit(Effect::normalMaps);

// What it takes to look maps up by either set of coordinates, of scenes that have two.
struct MapHits {
  UvLanes first;
  VI triangle, material;
  MF live;
  Weights weights;
  V3 edge1, edge2;
  VF coneWidth, cosine;
};

// The second coordinates where the flags of the lane's material have `bySecond`.
inline HWY_NOINLINE UvLanes UvsOfMap(const ShadingTables& tables, const MapHits& hits,
                                     uint32_t bySecond) {
  const UintTag du;
  const TableReader reader(tables.materials.data(), kMaterialStride, hits.material, hits.live);
  const VU flags = hn::And(hn::BitCast(du, reader.Columns4(12).z), hn::Set(du, bySecond));
  const MF second = hn::And(hits.live, hn::RebindMask(FloatTag(), hn::Ne(flags, hn::Zero(du))));
  const UvLanes& a = hits.first;
  if (hn::AllFalse(FloatTag(), second)) return a;
  const UvLanes b = LoadSecondUvs(tables, hits.triangle);
  const auto select = [&](VF yes, VF no) HWY_ATTR { return hn::IfThenElse(second, yes, no); };
  return {select(b.u0, a.u0), select(b.v0, a.v0), select(b.u1, a.u1),
          select(b.v1, a.v1), select(b.u2, a.u2), select(b.v2, a.v2)};
}

HWY_INLINE TexturePoints PointsAt(const ShadingTables& tables, const MapHits& hits,
                                  const UvLanes& uv) {
  const Weights& w = hits.weights;
  TexturePoints at{Interpolate(w, uv.u0, uv.u1, uv.u2), Interpolate(w, uv.v0, uv.v1, uv.v2),
                   hn::Zero(FloatTag())};
  if (tables.shading.textureFilter == TextureFilter::trilinear) {
    at.footprint = TextureFootprint(uv, hits.edge1, hits.edge2, hits.coneWidth, hits.cosine);
  }
  return at;
}

inline HWY_NOINLINE void QueueEmissionByOwnUvs(const ShadingTables& tables, const MapHits& hits,
                                               VF mapBits, size_t slot, BlockTextures& block) {
  const UvLanes uv = UvsOfMap(tables, hits, kMaterialEmissionBySecondUvs);
  QueueMap(tables, mapBits, hits.live, PointsAt(tables, hits, uv), slot, block.emission);
}

// As modelled, and the sign that turns it towards the viewer.
struct NormalSpace {
  V3 ns;
  VF handedness, flip;
};

inline HWY_NOINLINE void QueueNormalByOwnUvs(const ShadingTables& tables, const MapHits& hits,
                                             VF mapBits, const NormalSpace& space, size_t slot,
                                             BlockTextures& block) {
  const UvLanes uv = UvsOfMap(tables, hits, kMaterialNormalBySecondUvs);
  const TangentFrame frame =
      FindTangentFrame(uv, hits.edge1, hits.edge2, space.ns, space.handedness);
  QueueMap(tables, mapBits, hn::And(hits.live, frame.good), PointsAt(tables, hits, uv), slot,
           block.normal);
  StoreFrame(frame, space.flip, slot, block);
}

// Of scenes with second texture coordinates: what has been queued by the first ones, where the
// material asks for its own, once more. Not inlined, and from the start: other frames shall not
// carry it along.
template <uint32_t kBits>
HWY_NOINLINE void QueueByOwnUvs(const ShadingTables& tables, EffectSet effects,
                                const RayColumns& rays, const HitColumns& hits, size_t i,
                                size_t slot, BlockTextures& block, const SurfelColumns& surfels) {
  const FloatTag d;
  const auto [valid, triangle] = LoadHits(hits, i);
  if (hn::AllFalse(d, valid)) return;
  const TriangleLanes t = LoadTriangles(tables, triangle);
  const Weights w = LoadWeights(hits, i);
  Surface s = InterpolateSurface<(kBits & kSmooth) != 0>(tables, t, triangle, w);
  if (effects.has(Effect::instances)) CarryToWorld(tables, hits, valid, i, s);
  const VF cosine = Dot(Load3(rays.dirX, rays.dirY, rays.dirZ, i), s.ng);
  const VF width = surfels.cone ? hn::Load(d, surfels.cone + i) : hn::Zero(d);
  const MapHits map{t.uv, triangle, t.material, valid, w, s.edge1, s.edge2, width, cosine};
  const TableReader material(tables.materials.data(), kMaterialStride, t.material, valid);
  if constexpr ((kBits & kNormalMapped) != 0) {
    const VF normalMap = material.Columns4(8).w;
    if (!hn::AllFalse(d, MappedLanes(normalMap, valid))) {
      const VF flip = TurnToViewer(hn::Lt(cosine, hn::Zero(d)));
      QueueNormalByOwnUvs(tables, map, normalMap, NormalSpace{s.ns, s.handedness, flip}, slot,
                          block);
    }
  }
  if constexpr ((kBits & kTextured) != 0) {
    if (surfels.emissionR) {
      QueueEmissionByOwnUvs(tables, map, material.Columns4(12).w, slot, block);
    }
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
