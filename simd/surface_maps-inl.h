// Textures and normal maps on surfels: queued for a block of rays, then applied.
#if defined(WHIT_SIMD_SURFACE_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_SURFACE_MAPS_INL_H_
#undef WHIT_SIMD_SURFACE_MAPS_INL_H_
#else
#define WHIT_SIMD_SURFACE_MAPS_INL_H_
#endif

#include "simd/material-inl.h"
#include "simd/surface-inl.h"
#include "simd/texture-inl.h"
#include "stages/chunk.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Copies of a chunk's members for interpolateSurfels: the compiler would read members of the chunk
// again after each store to its columns.
struct SurfelJob {
  const Chunk& chunk;
  const ShadingTables& tables = chunk.tables();
  ShadingChoices shading = chunk.options().shading;
  float coneSpread = static_cast<float>(pixelCone(chunk.frame->camera).spread);
  RayColumns rays = chunk.rays;
  HitColumns hits = chunk.hits;
  SurfelColumns surfels = chunk.surfels;
  bool absorption = chunk.has(Feature::absorption), cones = chunk.has(Feature::cones);
  bool emissionFactors = chunk.has(Feature::emissionFactors);
  bool coplanar = chunk.has(Feature::coplanar), glossy = chunk.has(Feature::glossy);
  bool lobes = chunk.has(Feature::lobes);
  bool instances = chunk.has(Feature::instances), normalMaps = chunk.has(Feature::normalMaps);
  bool radianceMaps = tables.radianceMaps, secondUvs = chunk.has(Feature::secondUvs);
  bool smooth = chunk.has(Feature::smoothNormals), spheres = chunk.has(Feature::spheres);
  bool textures = chunk.has(Feature::textures), transmission = chunk.has(Feature::transmission);
  bool vertexColors = chunk.has(Feature::vertexColors);
};

// Distances from corner 0 to corners 1 and 2 along one axis of texture space. A power of two brings
// them to the order of 1, as in GeometricNormal, because products of tiny spans would vanish.
struct TextureSpans {
  VF to1, to2;
};

HWY_INLINE TextureSpans UnitSpans(VF c0, VF c1, VF c2) {
  const VF to1 = Sub(c1, c0), to2 = Sub(c2, c0);
  const VF largest = Max(Abs(to1), Abs(to2));
  const VF scale = InverseExponent(Min(largest, Set(0x1p126f)));
  return {Mul(to1, scale), Mul(to2, scale)};
}

// The frame that the texture coordinates span about `ns`: T along u, B along v. `good` masks the
// lanes whose coordinates span one.
struct TangentFrame {
  V3 tangent, bitangent;
  MF good;
};

HWY_INLINE TangentFrame FindTangentFrame(const UvLanes& t, const V3& edge1, const V3& edge2,
                                         const V3& ns, VF handedness) {
  // The determinant of the texture-space edges tells whether the coordinates are mirrored.
  const auto [du1, du2] = UnitSpans(t.u0, t.u1, t.u2);
  const auto [dv1, dv2] = UnitSpans(t.v0, t.v1, t.v2);
  const VF det = DifferenceOfProducts(du1, dv2, du2, dv1);
  const VF sign = CopySign(Set(1.0f), det);

  // The tangent is the direction of growing u, made perpendicular to the normal.
  const VF largest = Max(MaxComponent(Abs3(edge1)), MaxComponent(Abs3(edge2)));
  const VF scale = Mul(InverseExponent(largest), sign);
  const V3 along = Scale3(Sub3(Scale3(edge1, dv2), Scale3(edge2, dv1)), scale);

  const V3 none{Zero(), Zero(), Zero()};
  const V3 unitAlong = NormalizeOr(along, none);
  const V3 tangent = NormalizeOr(MulAdd3(ns, Neg(Dot(ns, unitAlong)), unitAlong), none);

  // The bitangent keeps the handedness of the texture coordinates and of the instance.
  const V3 bitangent = Scale3(Cross(ns, tangent), Mul(sign, handedness));

  const MF good = And(Ne(det, Zero()), Gt(Dot(tangent, tangent), Set(0.5f)));
  return {tangent, bitangent, good};
}

// The area of texture space, of which a repeat is 1, that a cone of this width covers (the scalar
// reference, with its source: find_intersections.h). Lengths are brought to the order of the edges
// by a power of two first, as for GeometricNormal.
HWY_INLINE VF TextureFootprint(const UvLanes& t, const V3& edge1, const V3& edge2, VF coneWidth,
                               VF cosine) {
  const VF inTexture =
      Abs(DifferenceOfProducts(Sub(t.u1, t.u0), Sub(t.v2, t.v0), Sub(t.u2, t.u0), Sub(t.v1, t.v0)));

  const VF largest = Max(MaxComponent(Abs3(edge1)), MaxComponent(Abs3(edge2)));
  const VF scale = InverseExponent(largest);
  const V3 area = Cross(Scale3(edge1, scale), Scale3(edge2, scale));
  const VF inWorld = Sqrt(Dot(area, area));

  // The cone's section by the plane is longer by 1 / cosine, and counts as if it were as wide.
  const VF across = Div(Mul(coneWidth, scale), Abs(cosine));
  return Mul(Div(inTexture, inWorld), Mul(across, across));
}

// The lookups of one map by a block of rays. Mip maps are looked up at the level above, too, whose
// weight is `between`.
struct MapQueue {
  TexelQueue level, above;
  HWY_ALIGN float between[TexelQueue::kRays];
};

// The texture lookups of one block of rays that wait for their texels.
struct BlockTextures {
  MapQueue diffuse, specular, emission, normal;
  HWY_ALIGN float frame[6][TexelQueue::kRays];  // of the normal map: tangent, then bitangent

  Columns3 Tangent() { return {frame[0], frame[1], frame[2]}; }
  Columns3 Bitangent() { return {frame[3], frame[4], frame[5]}; }
};

HWY_INLINE void StoreFrame(const TangentFrame& frame, VF flip, size_t slot, BlockTextures& block) {
  Store3(Scale3(frame.tangent, flip), block.Tangent(), slot);
  Store3(Scale3(frame.bitangent, flip), block.Bitangent(), slot);
}

// The texture coordinates of a vector of rays, and the footprints where mip levels are mixed.
struct TexturePoints {
  VF u, v, footprint;
};

// The level at which one texel is as large as `texels` of the full texture; 0 where that is NaN.
HWY_INLINE VF MipLevel(VF texels) {
  const FloatTag d;
  const VF one = Set(1.0f);
  const VF area = IfThenElse(Gt(texels, one), texels, one);
  const VF held = Min(area, Set(kLargestArea));
  const VF level = Mul(hn::Log2(d, held), Set(0.5f));
  return Min(Max(level, Zero()), Set(float{kMipLevels - 1}));
}

inline HWY_NOINLINE void QueueLevels(const ShadingTables& tables, VI map, MF live,
                                     const TexturePoints& at, size_t slot, MapQueue& queue) {
  const FloatTag d;
  const IntTag di;

  queue.level.any[slot] = !AllFalse(live);
  if (!queue.level.any[slot]) return;

  const TextureRecord* levels = tables.mipLevels.data();
  const VI full = IfThenElseZero(RebindMask(di, live), Mul(map, Set(kMipStride)));
  const auto [first, height, width, wrap] = LoadTextures(levels, full, live);

  // Trilinear filtering mixes the levels below and above by the fraction between them.
  const VF level = MipLevel(Mul(Mul(at.footprint, width), ConvertTo(d, height)));
  const VF whole = Floor(level);
  const VF between = IfThenElseZero(live, Sub(level, whole));
  const VI lower = Add(full, ConvertTo(di, whole));

  const auto queueAt = [&](VI index, TexelQueue& to) HWY_ATTR {
    QueueTexels(TextureFilter::bilinear, levels, tables.texels.get(), index, live, at.u, at.v, slot,
                to);
  };
  queueAt(lower, queue.level);

  // Where textures are magnified the level above has no weight.
  queue.above.any[slot] = false;
  if (AllTrue(Eq(between, Zero()))) return;

  queueAt(Add(lower, Set(1)), queue.above);
  Store(between, queue.between, slot);
}

HWY_INLINE MF MappedLanes(VI map, MF valid) {
  return And(valid, RebindMask(FloatTag(), NonNegative(map)));
}

HWY_INLINE void QueueMap(const SurfelJob& job, VI map, MF live, const TexturePoints& at,
                         size_t slot, MapQueue& queue) {
  const ShadingTables& tables = job.tables;
  const MF mapped = MappedLanes(map, live);

  if (HWY_LIKELY(job.shading.textureFilter == TextureFilter::trilinear)) {
    QueueLevels(tables, map, mapped, at, slot, queue);
    return;
  }

  QueueTexels(job.shading.textureFilter, tables.textures.data(), tables.texels.get(), map, mapped,
              at.u, at.v, slot, queue.level);
}

// Filters the lookups that wait at `slot`; `filter` computes a value from a footprint.
template <class Filter>
HWY_INLINE V3 FilterMap(const SurfelJob& job, const MapQueue& queue, size_t slot,
                        const Filter& filter) {
  const TextureFilter choice = job.shading.textureFilter;
  const uint32_t* texels = job.tables.texels.get();
  const V3 value = filter(FetchTexels(choice, texels, queue.level, slot));

  if (choice != TextureFilter::trilinear || !queue.above.any[slot]) return value;
  const V3 above = filter(FetchTexels(choice, texels, queue.above, slot));
  return MulAdd3(Sub3(above, value), Load(queue.between, slot), value);
}

HWY_INLINE V3 FilterData(const SurfelJob& job, const MapQueue& queue, size_t slot) {
  return FilterMap(job, queue, slot, [](const Footprint& f) HWY_ATTR { return FilterData3(f); });
}

// Multiplies the columns at slot i with the texture that waits at `slot`.
HWY_INLINE void ApplyColor(const SurfelJob& job, const MapQueue& queue, size_t slot,
                           const Columns3& columns, size_t i) {
  if (!queue.level.any[slot]) return;

  const V3 color = Load3(columns, i);
  const V3 texture =
      FilterMap(job, queue, slot, [](const Footprint& f) HWY_ATTR { return FilterColor(f); });

  Store3(Select3(QueuedLanes(queue.level, slot), Mul3(color, texture), color), columns, i);
}

// Multiplies the emission's factors at slot i with the map that waits at `slot`, in scenes where
// some maps hold radiance. The function is not inlined, so that other frames do not pay for it.
inline HWY_NOINLINE void ApplyRadianceMaps(const SurfelJob& job, const MapQueue& queue, size_t slot,
                                           size_t i) {
  if (!queue.level.any[slot]) return;

  const SurfelColumns& to = job.surfels;
  const MF queued = QueuedLanes(queue.level, slot);
  const VI number = MaterialNumbers(to, i);
  const VU flags = MaterialLanes(job.tables, number, queued).Lobe().flags;

  // The map is decoded both as a color and as radiance; the material's flag selects one.
  const V3 color =
      FilterMap(job, queue, slot, [](const Footprint& f) HWY_ATTR { return FilterColor(f); });
  const V3 radiance =
      FilterMap(job, queue, slot, [](const Footprint& f) HWY_ATTR { return FilterRadiance(f); });
  const V3 texture = Select3(HasFlags(flags, kMaterialEmissionIsRadiance), radiance, color);

  const V3 factor = Load3(to.emission, i);
  Store3(Select3(queued, Mul3(factor, texture), factor), to.emission, i);
}

// Bends the shading normals at slot i by the normal map that waits at `slot`.
HWY_INLINE void ApplyNormalMap(const SurfelJob& job, BlockTextures& block, size_t slot, size_t i) {
  if (!block.normal.level.any[slot]) return;

  const VF two = Set(2.0f), one = Set(1.0f);
  const SurfelColumns& surfels = job.surfels;

  // Texels store the components of tangent-space normals, moved from [-1, 1] to [0, 1].
  const V3 code = FilterData(job, block.normal, slot);
  const V3 m{MulThenSub(code.x, two, one), MulThenSub(code.y, two, one),
             MulThenSub(code.z, two, one)};

  const V3 tangent = Load3(block.Tangent(), slot), bitangent = Load3(block.Bitangent(), slot);
  const V3 ns = Load3(surfels.ns, i);
  const V3 bent = MulAdd3(tangent, m.x, MulAdd3(bitangent, m.y, Scale3(ns, m.z)));
  Store3(Select3(QueuedLanes(block.normal.level, slot), NormalizeOr(bent, ns), ns), surfels.ns, i);
}

// The inputs of map lookups by either set of coordinates, in scenes that have two.
struct MapHits {
  UvLanes first;
  VI triangle, material;
  MF live;
  Weights weights;
  V3 edge1, edge2;
  VF coneWidth, cosine;
};

// Returns the surface at the hits of the `live` lanes, in the space of their geometry.
HWY_INLINE Surface SurfaceAt(const SurfelJob& job, MF live, VI triangle, bool smooth, size_t i,
                             TriangleLanes& t, Weights& w) {
  Surface s{};
  s.handedness = Set(1.0f);

  // Nothing is interpolated if all hits are on spheres.
  MF onTriangles = live;
  if (job.spheres) onTriangles = And(live, AreTriangles(triangle, job.tables.firstSphere));
  if (!AllFalse(onTriangles)) s = InterpolateSurface(job.tables, t, triangle, w, smooth);
  if (job.spheres) PutOnSpheres(job.tables, job.hits, live, triangle, i, s, t, w);
  return s;
}

// Computes the surface at hits on `t` again, and what lookups of maps need of it.
HWY_INLINE MapHits MapHitsAt(const SurfelJob& job, MF live, VI triangle, TriangleLanes& t,
                             bool smooth, size_t i, Surface& s) {
  Weights w = LoadWeights(job.hits, i);
  s = SurfaceAt(job, live, triangle, smooth, i, t, w);
  if (job.instances) CarryToWorld(job.tables, job.hits, live, i, s);

  const VF cosine = Dot(DirectionAt(job.rays, i), s.ng);
  const VF width = job.cones ? Load(job.surfels.cone, i) : Zero();
  return {t.uv, triangle, t.material, live, w, s.edge1, s.edge2, width, cosine};
}

// Returns the second coordinates where the flags of the lane's material have `bySecond`, and the
// first ones elsewhere.
inline HWY_NOINLINE UvLanes UvsOfMap(const ShadingTables& tables, const MapHits& hits,
                                     uint32_t bySecond) {
  const MaterialLanes material(tables, hits.material, hits.live);
  const MF second = And(hits.live, HasFlags(material.Lobe().flags, bySecond));

  const UvLanes& a = hits.first;
  if (AllFalse(second)) return a;

  const UvLanes b = LoadSecondUvs(tables, hits.triangle);
  const auto select = [&](VF yes, VF no) HWY_ATTR { return IfThenElse(second, yes, no); };
  return {select(b.u0, a.u0), select(b.v0, a.v0), select(b.u1, a.u1),
          select(b.v1, a.v1), select(b.u2, a.u2), select(b.v2, a.v2)};
}

HWY_INLINE TexturePoints PointsAt(const SurfelJob& job, const MapHits& hits, const UvLanes& uv) {
  const Weights& w = hits.weights;
  TexturePoints at{Interpolate(w, uv.u0, uv.u1, uv.u2), Interpolate(w, uv.v0, uv.v1, uv.v2),
                   Zero()};
  if (job.cones) {
    at.footprint = TextureFootprint(uv, hits.edge1, hits.edge2, hits.coneWidth, hits.cosine);
  }
  return at;
}

inline HWY_NOINLINE void QueueEmissionBySecondUvs(const SurfelJob& job, const MapHits& hits, VI map,
                                                  size_t slot, BlockTextures& block) {
  const UvLanes uv = UvsOfMap(job.tables, hits, kMaterialEmissionBySecondUvs);
  QueueMap(job, map, hits.live, PointsAt(job, hits, uv), slot, block.emission);
}

// The shading normal as modelled, and the sign that turns it towards the viewer.
struct NormalSpace {
  V3 ns;
  VF handedness, flip;
};

inline HWY_NOINLINE void QueueNormalBySecondUvs(const SurfelJob& job, const MapHits& hits, VI map,
                                                const NormalSpace& space, size_t slot,
                                                BlockTextures& block) {
  const UvLanes uv = UvsOfMap(job.tables, hits, kMaterialNormalBySecondUvs);
  const TangentFrame frame =
      FindTangentFrame(uv, hits.edge1, hits.edge2, space.ns, space.handedness);

  QueueMap(job, map, And(hits.live, frame.good), PointsAt(job, hits, uv), slot, block.normal);
  StoreFrame(frame, space.flip, slot, block);
}

// Queues maps again that the material looks up by the second texture coordinates, in scenes that
// have them. The function is not inlined and starts from the hits, so that other frames do not pay
// for it.
inline HWY_NOINLINE void QueueBySecondUvs(const SurfelJob& job, size_t i, size_t slot,
                                          BlockTextures& block) {
  const ShadingTables& tables = job.tables;
  const auto [valid, triangle] = LoadHits(job.hits, tables.triangleCount, i);
  if (AllFalse(valid)) return;

  TriangleLanes t = LoadTriangles(tables, triangle);
  Surface s;
  const MapHits map = MapHitsAt(job, valid, triangle, t, job.smooth, i, s);
  const MaterialLanes material(tables, t.material, valid);

  if (job.normalMaps) {
    const VI normalMap = material.NormalMap();
    if (!AllFalse(MappedLanes(normalMap, valid))) {
      const VF flip = TurnToViewer(Lt(map.cosine, Zero()));
      QueueNormalBySecondUvs(job, map, normalMap, NormalSpace{s.ns, s.handedness, flip}, slot,
                             block);
    }
  }

  if (job.textures && job.emissionFactors) {
    QueueEmissionBySecondUvs(job, map, material.Lobe().emissionMap, slot, block);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
