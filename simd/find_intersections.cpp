// Surfels from hits.
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/find_intersections.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/material-inl.h"
#include "simd/surface-inl.h"
#include "simd/surface_maps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Prefetches the records, of `stride` floats each, of all hits of a block before the first of them
// is read.
template <class Record>
HWY_INLINE void PrefetchRecords(const Record* table, size_t stride, const uint32_t* hit,
                                size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    hwy::Prefetch(reinterpret_cast<const float*>(table) + (hit[i] == kMiss ? 0 : hit[i]) * stride);
  }
}

// The factors by which vertex colors multiply each color of a material, according to its flags.
struct Tints {
  V3 diffuse, specular, emission;
};

HWY_INLINE Tints FindTints(const V3& color, VU flags) {
  const VF one = Set(1.0f);
  const V3 white{one, one, one};
  const MF emission = HasFlags(flags, kMaterialTintsEmission);
  return {Select3(emission, white, color),
          Select3(HasFlags(flags, kMaterialTintsSpecular), color, white),
          Select3(emission, color, white)};
}

// Marks the slot's map queues as empty.
HWY_INLINE void ClearSlot(size_t slot, BlockTextures& block) {
  for (MapQueue* queue : {&block.diffuse, &block.specular, &block.emission, &block.normal}) {
    queue->level.any[slot] = false;
  }
}

HWY_INLINE void QueueNormal(const SurfelJob& job, VI map, const UvLanes& uv, MF valid,
                            const Surface& s, VF flip, const TexturePoints& at, size_t slot,
                            BlockTextures& block) {
  const MF mapped = MappedLanes(map, valid);
  if (AllFalse(mapped)) return;
  const TangentFrame frame = FindTangentFrame(uv, s.edge1, s.edge2, s.ns, s.handedness);
  QueueMap(job, map, And(mapped, frame.good), at, slot, block.normal);
  StoreFrame(frame, flip, slot, block);
}

// The highest number of a map of the lane's material; negative if it has none.
HWY_INLINE VI HighestMap(const SurfelJob& job, const MaterialLanes& material) {
  VI map = material.Diffuse().map;
  if (job.normalMaps) map = Max(map, material.NormalMap());
  if (job.emissionFactors) map = Max(map, material.Lobe().emissionMap);
  if (job.glossy) map = Max(map, material.Specular().map);
  return map;
}

// Everything but textures, which are queued, for the vector of rays at i; returns the flags of
// their materials.
HWY_INLINE VU InterpolateVector(const SurfelJob& job, size_t i, size_t slot, BlockTextures& block) {
  const FloatTag d;
  const UintTag du;
  const ShadingTables& tables = job.tables;
  const RayColumns& rays = job.rays;
  const HitColumns& hits = job.hits;
  const SurfelColumns& surfels = job.surfels;
  const VF one = Set(1.0f);
  ClearSlot(slot, block);

  const auto [valid, triangle] = LoadHits(hits, tables.triangleCount, i);
  if (job.absorption) Absorb(tables, rays, hits, valid, i);
  if (AllFalse(valid)) {
    Store(Set(kMiss), surfels.material, i);
    return Zero(du);
  }

  // The surface is interpolated from the corners, on spheres computed, and carried to the world.
  TriangleLanes t = LoadTriangles(tables, triangle);
  Weights w = LoadWeights(hits, i);
  Surface s = SurfaceAt(job, valid, triangle, job.smooth, i, t, w);
  if (job.instances) CarryToWorld(tables, hits, valid, i, s);

  const VU others = job.coplanar ? Load(hits.alsoCrossed, i) : Zero(du);
  if (job.coplanar) {
    const auto shared = Ne(And(others, Set(kSharesPlace)), Zero(du));
    s.inDoubt = Or(s.inDoubt, RebindMask(d, shared));
  }

  const MaterialLanes material(tables, t.material, valid);
  const auto [diffuse, diffuseMap] = material.Diffuse();
  TexturePoints at{Interpolate(w, t.uv.u0, t.uv.u1, t.uv.u2),
                   Interpolate(w, t.uv.v0, t.uv.v1, t.uv.v2), Zero()};
  const VF cosine = Dot(DirectionAt(rays, i), s.ng);

  if (job.cones) {
    const VF width = MulThenAdd(Set(job.coneSpread), Load(hits.t, i), Load(rays.cone, i));
    Store(width, surfels.cone, i);
    if (!AllFalse(MappedLanes(HighestMap(job, material), valid))) {
      at.footprint = TextureFootprint(t.uv, s.edge1, s.edge2, width, cosine);
    }
  }

  const MF entering = Lt(cosine, Zero());
  const VF flip = TurnToViewer(entering);

  if (job.textures) {
    QueueMap(job, diffuseMap, valid, at, slot, block.diffuse);
  }
  if (job.normalMaps) {
    QueueNormal(job, material.NormalMap(), t.uv, valid, s, flip, at, slot, block);
  }

  const VF distance = Load(hits.t, i);
  FollowRay(t, rays, distance, i, s);
  StoreSurface(s, distance, flip, i, surfels);

  // Vertex colors tint the material, and textures are queued for what it has.
  const LobeLanes lobe = material.Lobe();
  Tints tints{{one, one, one}, {one, one, one}, {one, one, one}};
  V3 scattered = diffuse;
  if (job.vertexColors) {
    tints = FindTints(VertexColor(tables, triangle, w.w1, w.w2), lobe.flags);
    scattered = Mul3(scattered, tints.diffuse);
  }

  Store3(scattered, surfels.diffuse, i);
  if (job.emissionFactors) {
    Store3(tints.emission, surfels.emission, i);
    if (job.textures) {
      QueueMap(job, lobe.emissionMap, valid, at, slot, block.emission);
    }
  }

  const VU materialOrMiss = IfThenElse(RebindMask(du, valid), BitCast(du, t.material), Set(kMiss));
  Store(materialOrMiss, surfels.material, i);

  if (job.glossy) {
    const auto [specular, specularMap] = material.Specular();
    if (job.textures) {
      QueueMap(job, specularMap, valid, at, slot, block.specular);
    }
    const V3 f0 = job.vertexColors ? Mul3(specular, tints.specular) : specular;
    Store3(f0, surfels.specular, i);
    Store(lobe.alpha, surfels.alpha, i);
  }

  // FindLayers overwrites the share of layered materials.
  if (job.lobes) {
    Store3(Zero3(), surfels.lobe, i);
  }

  if (job.transmission) {
    StoreMedia(tables, rays, lobe.medium, entering, others, i, surfels);
  }

  return IfThenElseZero(RebindMask(du, valid), lobe.flags);
}

// Applies the textures that the vector at i has queued.
HWY_INLINE void ApplyTextures(const SurfelJob& job, BlockTextures& block, size_t slot, size_t i) {
  const SurfelColumns& surfels = job.surfels;
  if (job.textures) {
    if (job.emissionFactors && HWY_UNLIKELY(job.radianceMaps)) {
      ApplyRadianceMaps(job, block.emission, slot, i);
    } else if (job.emissionFactors) {
      ApplyColor(job, block.emission, slot, surfels.emission, i);
    }
    ApplyColor(job, block.diffuse, slot, surfels.diffuse, i);
    if (job.glossy) {
      ApplyColor(job, block.specular, slot, surfels.specular, i);
    }
  }
  if (job.normalMaps) ApplyNormalMap(job, block, slot, i);
}

void InterpolateSurfels(Chunk& c) {
  const UintTag du;
  const size_t lanes = Lanes(du), n = c.n;
  const SurfelJob job{c};
  VU flags = Zero(du);
  BlockTextures block;
  for (size_t begin = 0; begin < n; begin += TexelQueue::kRays) {
    const size_t end = begin + TexelQueue::kRays < n ? begin + TexelQueue::kRays : n;
    if (job.smooth) {
      const auto stride = static_cast<size_t>(job.tables.normalStride);
      PrefetchRecords(job.tables.normals, stride, job.hits.triangle, begin, end);
    }
    for (size_t i = begin; i < end; i += lanes) {
      flags = Or(flags, InterpolateVector(job, i, i - begin, block));
      if (HWY_UNLIKELY(job.secondUvs)) QueueBySecondUvs(job, i, i - begin, block);
    }
    if (job.textures || job.normalMaps) {
      for (size_t i = begin; i < end; i += lanes) ApplyTextures(job, block, i - begin, i);
    }
  }
  HWY_ALIGN uint32_t perLane[16];
  Store(flags, du, perLane);
  c.materialFlags = 0;
  for (size_t lane = 0; lane < lanes; ++lane) c.materialFlags |= perLane[lane];
}

// Queues the map that mapOf(materials) names for the vector at i, looked up by the first texture
// coordinates, or by the second where the material has the flag `kBySecond`.
template <uint32_t kBySecond, typename MapOf>
HWY_INLINE void QueueDataMap(const SurfelJob& job, size_t i, size_t slot, MapOf&& mapOf,
                             MapQueue& queue) {
  queue.level.any[slot] = false;
  const auto [valid, triangle] = LoadHits(job.hits, job.tables.triangleCount, i);
  if (AllFalse(valid)) return;
  TriangleLanes t = LoadTriangles(job.tables, triangle);
  const VI map = mapOf(MaterialLanes(job.tables, t.material, valid));
  const MF mapped = MappedLanes(map, valid);
  if (AllFalse(mapped)) return;

  Surface s;
  const bool smooth = false;  // the lookup needs no interpolated normal
  const MapHits at = MapHitsAt(job, valid, triangle, t, smooth, i, s);
  const bool second = kBySecond != 0 && job.secondUvs;
  const UvLanes uv = second ? UvsOfMap(job.tables, at, kBySecond) : t.uv;
  QueueMap(job, map, mapped, PointsAt(job, at, uv), slot, queue);
}

HWY_INLINE void ApplyRoughness(const SurfelJob& job, const MapQueue& queue, size_t slot, size_t i) {
  if (!queue.level.any[slot]) return;
  const MF queued = QueuedLanes(queue.level, slot);
  const VI number = MaterialNumbers(job.surfels, i);
  const VF factor = MaterialLanes(job.tables, number, queued).Roughness().number;
  const V3 map = FilterData(job, queue, slot);
  const VF roughness = Max(Mul(factor, map.y), Set(kMinRoughness));
  const VF alpha = Load(job.surfels.alpha, i);
  Store(IfThenElse(queued, Mul(roughness, roughness), alpha), job.surfels.alpha, i);
}

// apply(job, queue, slot, i) for each vector, when what mapOf(materials) names has been looked up.
template <uint32_t kBySecond = 0, typename MapOf, typename Apply>
HWY_INLINE void LookUpDataMap(const Chunk& c, MapOf&& mapOf, Apply&& apply) {
  const size_t lanes = Lanes(FloatTag()), n = c.n;
  const SurfelJob job{c};
  MapQueue queue;
  for (size_t begin = 0; begin < n; begin += TexelQueue::kRays) {
    const size_t end = begin + TexelQueue::kRays < n ? begin + TexelQueue::kRays : n;
    for (size_t i = begin; i < end; i += lanes)
      QueueDataMap<kBySecond>(job, i, i - begin, mapOf, queue);
    for (size_t i = begin; i < end; i += lanes) apply(job, queue, i - begin, i);
  }
}

// The scalar reference is findColors in src/reference/find_intersections.cpp.
void LookUpRoughness(Chunk& c) {
  LookUpDataMap(
      c, [](const MaterialLanes& m) HWY_ATTR { return m.Roughness().map; }, ApplyRoughness);
}

// Multiplies the coverage of the lanes that a map covers with the alpha of vertices. The function
// is not inlined, so that scenes without second texture coordinates do not pay for it.
inline HWY_NOINLINE VF MulVertexAlpha(const SurfelJob& job, VF coverage, MF mapped, size_t i) {
  const VI number = MaterialNumbers(job.surfels, i);
  const VU flags = MaterialLanes(job.tables, number, mapped).Lobe().flags;
  const MF byVertex = And(mapped, HasFlags(flags, kMaterialAlphaByVertex));
  if (AllFalse(byVertex)) return coverage;

  // The coordinates have what the alpha lacks of 1. Subtracted at the corners, a small alpha keeps
  // its precision.
  const VI triangle = LoadHits(job.hits, job.tables.triangleCount, i).triangle;
  const UvLanes lacks = LoadSecondUvs(job.tables, triangle);
  const VF one = Set(1.0f);
  const VF alpha = Interpolate(LoadWeights(job.hits, i), Sub(one, lacks.u0), Sub(one, lacks.u1),
                               Sub(one, lacks.u2));
  return IfThenElse(byVertex, Mul(coverage, alpha), coverage);
}

// Stores the coverage of the surfels at i. It is 1 where the ray left the scene.
HWY_INLINE void StoreCoverage(const SurfelJob& job, const MapQueue& queue, size_t slot, size_t i) {
  const FloatTag d;
  const VI number = MaterialNumbers(job.surfels, i);
  const MF live = RebindMask(d, NonNegative(number));
  VF coverage = Set(1.0f);
  if (!AllFalse(live)) {
    const VF own = MaterialLanes(job.tables, number, live).Coverage().number;
    coverage = IfThenElse(live, own, coverage);
  }
  if (queue.level.any[slot]) {
    const V3 map = FilterData(job, queue, slot);
    const VF mapped = Mul(coverage, map.x);
    const MF queued = QueuedLanes(queue.level, slot);
    coverage = IfThenElse(queued, mapped, coverage);
    if (HWY_UNLIKELY(job.secondUvs)) coverage = MulVertexAlpha(job, coverage, queued, i);
  }
  Store(coverage, job.surfels.coverage, i);
}

HWY_INLINE void StoreOnes(float* column, size_t n) {
  const FloatTag d;
  for (size_t i = 0; i < n; i += Lanes(d)) Store(Set(1.0f), column, i);
}

// The scalar reference is findColors in src/reference/find_intersections.cpp.
void LookUpCoverage(Chunk& c) {
  if ((c.materialFlags & kMaterialIsPartlyThere) == 0) {
    StoreOnes(c.surfels.coverage, c.n);
    return;
  }
  LookUpDataMap(
      c, [](const MaterialLanes& m) HWY_ATTR { return m.Coverage().map; }, StoreCoverage);
}

HWY_INLINE void StoreOcclusion(const SurfelJob& job, const MapQueue& queue, size_t slot, size_t i) {
  VF occlusion = Set(1.0f);
  if (queue.level.any[slot]) {
    const V3 map = FilterData(job, queue, slot);
    occlusion = IfThenElse(QueuedLanes(queue.level, slot), map.x, occlusion);
  }
  Store(occlusion, job.surfels.occlusion, i);
}

// The scalar reference is findColors in src/reference/find_intersections.cpp.
void LookUpOcclusion(Chunk& c) {
  if ((c.materialFlags & kMaterialIsOccluded) == 0) {
    StoreOnes(c.surfels.occlusion, c.n);
    return;
  }
  LookUpDataMap<kMaterialOcclusionBySecondUvs>(
      c, [](const MaterialLanes& m) HWY_ATTR { return m.OcclusionMap(); }, StoreOcclusion);
}

// The two colors that get factors from a map, and from vertex colors in the lanes that are tinted.
struct MirrorFactors {
  static constexpr uint32_t kVaries = kMaterialVariesMirror;
  static HWY_INLINE VI Map(const MaterialLanes& m) { return m.Mirror().map; }
  static HWY_INLINE MF Tinted(VU flags) {
    return AndNot(HasFlags(flags, kMaterialCoated), HasFlags(flags, kMaterialTintsSpecular));
  }
  static constexpr auto kColumns = &SurfelColumns::mirror;
};
struct TransmissionFactors {
  static constexpr uint32_t kVaries = kMaterialVariesTransmission;
  static HWY_INLINE VI Map(const MaterialLanes& m) { return m.Transmission().map; }
  static HWY_INLINE MF Tinted(VU flags) { return hn::Not(HasFlags(flags, kMaterialTintsEmission)); }
  static constexpr auto kColumns = &SurfelColumns::transmission;
};

template <typename Factors>
HWY_INLINE void StoreFactors(const SurfelJob& job, const MapQueue& queue, size_t slot, size_t i) {
  const VF one = Set(1.0f);
  V3 factor{one, one, one};
  if (queue.level.any[slot]) {
    const V3 map =
        FilterMap(job, queue, slot, [](const Footprint& f) HWY_ATTR { return FilterColor(f); });
    factor = Select3(QueuedLanes(queue.level, slot), map, factor);
  }

  const auto [valid, triangle] = LoadHits(job.hits, job.tables.triangleCount, i);
  if (job.vertexColors && !AllFalse(valid)) {
    const VI material = MaterialNumbers(job.surfels, i);
    const VU flags = MaterialLanes(job.tables, material, valid).Lobe().flags;
    const Weights w = LoadWeights(job.hits, i);
    const V3 tinted = Mul3(factor, VertexColor(job.tables, triangle, w.w1, w.w2));
    const MF varies = And(valid, HasFlags(flags, Factors::kVaries));
    factor = Select3(And(varies, Factors::Tinted(flags)), tinted, factor);
  }
  Store3(factor, job.surfels.*Factors::kColumns, i);
}

// The scalar reference is findColors in src/reference/find_intersections.cpp.
template <typename Factors>
HWY_INLINE void LookUpFactors(Chunk& c) {
  if ((c.materialFlags & Factors::kVaries) == 0) {
    const Columns3 to = c.surfels.*Factors::kColumns;
    for (float* column : {to.x, to.y, to.z}) StoreOnes(column, c.n);
    return;
  }
  LookUpDataMap(
      c, [](const MaterialLanes& m) HWY_ATTR { return Factors::Map(m); }, StoreFactors<Factors>);
}

void LookUpMirror(Chunk& c) { LookUpFactors<MirrorFactors>(c); }
void LookUpTransmission(Chunk& c) { LookUpFactors<TransmissionFactors>(c); }

// Corners and their normals, in the world.
struct WorldCorners {
  Corners position, normal;
};

HWY_INLINE void CarryToWorld(const ShadingTables& tables, const InstanceHits& on, WorldCorners& w) {
  const PlacementLanes to = LoadPlacements(tables.instances.data(), on.instance, on.placed);
  for (V3* p : {&w.position.c0, &w.position.c1, &w.position.c2}) {
    *p = Select3(on.placed, Add3(TransformVector(to.toWorld, *p), to.origin), *p);
  }
  for (V3* n : {&w.normal.c0, &w.normal.c1, &w.normal.c2}) {
    *n = Select3(on.placed, NormalizeOr(TransformVector(to.normal, *n), *n), *n);
  }
}

// Normalizes normals that a transform has stretched; unit vectors keep their bits.
HWY_INLINE Corners UnitNormals(Corners normals) {
  const VF one = Set(1.0f), most = Set(static_cast<float>(kStretchedNormal));
  for (V3* n : {&normals.c0, &normals.c1, &normals.c2}) {
    const MF stretched = Gt(Abs(Sub(Dot(*n, *n), one)), most);
    *n = Select3(stretched, NormalizeOr(*n, *n), *n);
  }
  return normals;
}

// The scalar reference is shadowTerminatorOffset in src/reference/find_intersections.cpp.
void LiftShadowOrigins(Chunk& c) {
  const FloatTag d;
  const ShadingTables& tables = c.tables();
  const HitColumns hits = c.hits;
  const SurfelColumns surfels = c.surfels;
  const size_t n = c.n;
  const bool instanced = c.has(Feature::instances), spheres = c.has(Feature::spheres);
  const VF zero = Zero(), one = Set(1.0f);

  for (size_t i = 0; i < n; i += Lanes(d)) {
    const auto [valid, triangle] = LoadHits(hits, tables.triangleCount, i);
    const TriangleLanes t = LoadTriangles(tables, triangle);
    WorldCorners w{{t.p0, t.p1, t.p2}, UnitNormals(LoadNormals(tables, triangle))};
    if (instanced) {
      const InstanceHits on = LoadInstances(hits, tables.instances.size(), valid, i);
      if (!AllFalse(on.placed)) CarryToWorld(tables, on, w);
    }

    const VF u = Load(hits.u, i), v = Load(hits.v, i);
    const V3 position = Load3(surfels.pos, i);
    const V3 ng = Load3(surfels.ng, i);
    const VF offset = Load(surfels.offset, i);

    // The surface that the vertex normals stand for lies above the facet by the weighted depths
    // below the planes of the corners.
    V3 raised = Zero3();
    const auto add = [&](const V3& corner, const V3& normal, VF weight) HWY_ATTR {
      // Corner normals point to the outside, the surfel's to the viewer.
      const V3 m = Scale3(normal, CopySign(one, Dot(normal, ng)));
      const VF below = Neg(Add(Dot(Sub3(position, corner), m), offset));
      raised = MulAdd3(m, Mul(weight, Max(below, zero)), raised);
    };

    add(w.position.c0, w.normal.c0, Sub(Sub(one, u), v));
    add(w.position.c1, w.normal.c1, u);
    add(w.position.c2, w.normal.c2, v);

    if (spheres) {
      const MF on = LoadSpheres(tables, hits, valid, triangle, i).on;
      raised = Select3(on, Zero3(), raised);
    }

    Store3(raised, surfels.shadowOffset, i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(InterpolateSurfels)
WHIT_EXPORT_KERNEL(LookUpRoughness)
WHIT_EXPORT_KERNEL(LookUpCoverage)
WHIT_EXPORT_KERNEL(LookUpOcclusion)
WHIT_EXPORT_KERNEL(LookUpMirror)
WHIT_EXPORT_KERNEL(LookUpTransmission)
WHIT_EXPORT_KERNEL(LiftShadowOrigins)
}  // namespace whit::simd
#endif
