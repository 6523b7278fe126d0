// Second half of findIntersections: from hits to surfels.
#include "simd/kernel_variants.h"
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/interpolate_surfels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep

#include "hwy/contrib/math/math-inl.h"
#include "simd/media-inl.h"
#include "simd/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

constexpr uint32_t kSmooth = EffectSet::bit(Effect::smoothNormals);
constexpr uint32_t kTextured = EffectSet::bit(Effect::textures);
constexpr uint32_t kNormalMapped = EffectSet::bit(Effect::normalMaps);
constexpr uint32_t kInstanced = EffectSet::bit(Effect::instances);
constexpr uint32_t kGlossy = EffectSet::bit(Effect::glossy);
constexpr uint32_t kTransmission = EffectSet::bit(Effect::transmission);
constexpr uint32_t kAbsorption = EffectSet::bit(Effect::absorption);

// The corners and texture coordinates of each lane's triangle, and what follows from them.
struct TriangleLanes {
  V3 p0, p1, p2;
  VF u0, v0, u1, v1, u2, v2;
  VI material;
};

HWY_INLINE TriangleLanes LoadTriangles(const ShadingTables& tables, VI triangle) {
  const Records records = RecordsAt(tables.triangles, 16, triangle);
  const V4 a = LoadColumns4(records, 0), b = LoadColumns4(records, 4);
  const V4 c = LoadColumns4(records, 8), e = LoadColumns4(records, 12);
  return {{a.x, a.y, a.z},           {a.w, b.x, b.y}, {b.z, b.w, c.x}, c.y, c.z, c.w, e.x, e.y, e.z,
          hn::BitCast(IntTag(), e.w)};
}

// Barycentric weights of the corners.
struct Weights {
  VF w0, w1, w2;
};

HWY_INLINE VF Interpolate(const Weights& w, VF a, VF b, VF c) {
  return hn::MulAdd(a, w.w0, hn::MulAdd(b, w.w1, hn::Mul(c, w.w2)));
}
HWY_INLINE V3 Interpolate3(const Weights& w, const V3& a, const V3& b, const V3& c) {
  return {Interpolate(w, a.x, b.x, c.x), Interpolate(w, a.y, b.y, c.y),
          Interpolate(w, a.z, b.z, c.z)};
}

// Unit geometric normal. Edges are brought to the order of 1 by a power of two first, so that the
// products of tiny or huge edges stay in range and scaling a scene by 2^k changes no bit.
HWY_INLINE V3 GeometricNormal(const V3& edge1, const V3& edge2) {
  const VF largest = hn::Max(MaxComponent(Abs3(edge1)), MaxComponent(Abs3(edge2)));
  const VF scale = InverseExponent(largest);
  const V3 unit{hn::Zero(FloatTag()), hn::Zero(FloatTag()), hn::Set(FloatTag(), 1.0f)};
  return NormalizeOr(Cross(Scale3(edge1, scale), Scale3(edge2, scale)), unit);
}

HWY_INLINE V3 SmoothNormal(const ShadingTables& tables, VI triangle, const Weights& w,
                           const V3& ng) {
  const Records records =
      RecordsAt(tables.normals, static_cast<size_t>(tables.normalStride), triangle);
  // The last fetch starts at 5, not 8: a record ends after nine floats.
  const V4 a = LoadColumns4(records, 0), b = LoadColumns4(records, 4);
  const V4 c = LoadColumns4(records, 5);
  return NormalizeOr(Interpolate3(w, {a.x, a.y, a.z}, {a.w, b.x, b.y}, {b.z, b.w, c.w}), ng);
}

struct InstanceLanes {
  V4 row0, row1, row2;
};

HWY_INLINE V3 TransformVector(const InstanceLanes& m, const V3& v) {
  return {Dot({m.row0.x, m.row0.y, m.row0.z}, v), Dot({m.row1.x, m.row1.y, m.row1.z}, v),
          Dot({m.row2.x, m.row2.y, m.row2.z}, v)};
}

// The frame that the texture coordinates span about `ns`: T along u, B along v. False where they
// span none.
struct TangentFrame {
  V3 tangent, bitangent;
  MF good;
};

HWY_INLINE TangentFrame FindTangentFrame(const TriangleLanes& t, const V3& edge1, const V3& edge2,
                                         const V3& ns, VF handedness) {
  const FloatTag d;
  const VF du1 = hn::Sub(t.u1, t.u0), dv1 = hn::Sub(t.v1, t.v0);
  const VF du2 = hn::Sub(t.u2, t.u0), dv2 = hn::Sub(t.v2, t.v0);
  const VF det = DifferenceOfProducts(du1, dv2, du2, dv1);
  const VF sign = hn::CopySign(hn::Set(d, 1.0f), det);
  const VF largest = hn::Max(MaxComponent(Abs3(edge1)), MaxComponent(Abs3(edge2)));
  const VF scale = hn::Mul(InverseExponent(largest), sign);
  const V3 along = Scale3(Sub3(Scale3(edge1, dv2), Scale3(edge2, dv1)), scale);
  const V3 none{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const V3 unitAlong = NormalizeOr(along, none);
  const V3 tangent = NormalizeOr(MulAdd3(ns, hn::Neg(Dot(ns, unitAlong)), unitAlong), none);
  const V3 bitangent = Scale3(Cross(ns, tangent), hn::Mul(sign, handedness));
  const MF good =
      hn::And(hn::Ne(det, hn::Zero(d)), hn::Gt(Dot(tangent, tangent), hn::Set(d, 0.5f)));
  return {tangent, bitangent, good};
}

// What waits for texels, of one block of rays.
struct BlockTextures {
  TexelQueue diffuse, specular, normal;
  HWY_ALIGN float tangent[6][TexelQueue::kRays];  // frame of the normal map: T, then B
};

HWY_INLINE void StoreFrame(const TangentFrame& frame, VF flip, size_t slot, BlockTextures& block) {
  const V3 t = Scale3(frame.tangent, flip), b = Scale3(frame.bitangent, flip);
  Store3(t, block.tangent[0], block.tangent[1], block.tangent[2], slot);
  Store3(b, block.tangent[3], block.tangent[4], block.tangent[5], slot);
}

HWY_INLINE void QueueMap(const ShadingTables& tables, VF mapBits, MF live, VF u, VF v, size_t slot,
                         TexelQueue& queue) {
  const VI map = hn::BitCast(IntTag(), mapBits);
  const MF mapped = hn::And(live, hn::RebindMask(FloatTag(), NonNegative(map)));
  QueueTexels(tables.textures.data(), tables.texels.data(), map, mapped, u, v, slot, queue);
}

// Multiplies the columns at slot i with the texture that waits at `slot`.
HWY_INLINE void ApplyColour(const ShadingTables& tables, const TexelQueue& queue, size_t slot,
                            float* r, float* g, float* b, size_t i) {
  if (!queue.any[slot]) return;
  const V3 colour = Load3(r, g, b, i);
  const V3 texture = FilterColour(FetchTexels(tables.texels.data(), queue, slot));
  Store3(Select3(QueuedLanes(queue, slot), Mul3(colour, texture), colour), r, g, b, i);
}

// Bends the shading normals at slot i by the normal map that waits at `slot`.
HWY_INLINE void ApplyNormalMap(const ShadingTables& tables, const BlockTextures& block, size_t slot,
                               const SurfelColumns& surfels, size_t i) {
  if (!block.normal.any[slot]) return;
  const FloatTag d;
  const VF two = hn::Set(d, 2.0f), one = hn::Set(d, 1.0f);
  const V3 code = FilterData3(FetchTexels(tables.texels.data(), block.normal, slot));
  const V3 m{hn::MulSub(code.x, two, one), hn::MulSub(code.y, two, one),
             hn::MulSub(code.z, two, one)};
  const V3 tangent = Load3(block.tangent[0], block.tangent[1], block.tangent[2], slot);
  const V3 bitangent = Load3(block.tangent[3], block.tangent[4], block.tangent[5], slot);
  const V3 ns = Load3(surfels.nsX, surfels.nsY, surfels.nsZ, i);
  const V3 bent = MulAdd3(tangent, m.x, MulAdd3(bitangent, m.y, Scale3(ns, m.z)));
  Store3(Select3(QueuedLanes(block.normal, slot), NormalizeOr(bent, ns), ns), surfels.nsX,
         surfels.nsY, surfels.nsZ, i);
}

// Media on both sides of the surface, and whether it is there at all.
HWY_INLINE void StoreMedia(const ShadingTables& tables, const RayColumns& rays, VF mediumBits,
                           MF entering, size_t i, const SurfelColumns& surfels) {
  const UintTag du;
  const FloatTag d;
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
  (void)d;
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

// Everything but textures, which are queued, for the vector of rays at i; returns the flags of
// their materials.
template <uint32_t kBits>
HWY_INLINE VU InterpolateVector(const ShadingTables& tables, EffectSet effects,
                                const RayColumns& rays, const HitColumns& hits, size_t i,
                                size_t slot, BlockTextures& block, const SurfelColumns& surfels) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const VF one = hn::Set(d, 1.0f);
  if constexpr ((kBits & kTextured) != 0)
    block.diffuse.any[slot] = block.specular.any[slot] = false;
  if constexpr ((kBits & kNormalMapped) != 0) block.normal.any[slot] = false;
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
  V3 ng = GeometricNormal(edge1, edge2);
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
  const VF texU = Interpolate(w, t.u0, t.u1, t.u2), texV = Interpolate(w, t.v0, t.v1, t.v2);
  const V3 direction = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
  const MF entering = hn::Lt(Dot(direction, ng), hn::Zero(d));
  const VF flip = hn::IfThenElse(entering, one, hn::Set(d, -1.0f));
  if constexpr ((kBits & kTextured) != 0) {
    QueueMap(tables, diffuse.w, valid, texU, texV, slot, block.diffuse);
  }
  if constexpr ((kBits & kNormalMapped) != 0) {
    const VF map = material.Columns4(8).w;
    const MF mapped = hn::And(valid, hn::RebindMask(d, NonNegative(hn::BitCast(di, map))));
    if (!hn::AllFalse(d, mapped)) {
      const TangentFrame frame = FindTangentFrame(t, edge1, edge2, ns, handedness);
      QueueMap(tables, map, hn::And(mapped, frame.good), texU, texV, slot, block.normal);
      StoreFrame(frame, flip, slot, block);
    }
  }
  Store3(position, surfels.posX, surfels.posY, surfels.posZ, i);
  Store3(Scale3(ng, flip), surfels.ngX, surfels.ngY, surfels.ngZ, i);
  Store3(Scale3(ns, flip), surfels.nsX, surfels.nsY, surfels.nsZ, i);
  const VF sum = hn::Add(hn::Add(magnitude.x, magnitude.y), magnitude.z);
  hn::Store(hn::Mul(sum, hn::Set(d, 0x1p-19f)), d, surfels.offset + i);
  Store3({diffuse.x, diffuse.y, diffuse.z}, surfels.diffuseR, surfels.diffuseG, surfels.diffuseB,
         i);
  const VU materialOrMiss =
      hn::IfThenElse(hn::RebindMask(du, valid), hn::BitCast(du, t.material), hn::Set(du, kMiss));
  hn::Store(materialOrMiss, du, surfels.material + i);
  const V4 lobe = material.Columns4(12);
  if ((effects.bits() & kGlossy) != 0) {
    const V4 specular = material.Columns4(4);
    if constexpr ((kBits & kTextured) != 0) {
      QueueMap(tables, specular.w, valid, texU, texV, slot, block.specular);
    }
    Store3({specular.x, specular.y, specular.z}, surfels.specularR, surfels.specularG,
           surfels.specularB, i);
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
                                                size_t n, const SurfelColumns& surfels) {
  const UintTag du;
  const size_t lanes = hn::Lanes(du);
  VU flags = hn::Zero(du);
  BlockTextures block;
  for (size_t begin = 0; begin < n; begin += TexelQueue::kRays) {
    const size_t end = begin + TexelQueue::kRays < n ? begin + TexelQueue::kRays : n;
    PrefetchTriangles<kBits>(tables, hits, begin, end);
    for (size_t i = begin; i < end; i += lanes) {
      flags = hn::Or(flags, InterpolateVector<kBits>(tables, effects, rays, hits, i, i - begin,
                                                     block, surfels));
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
                            const HitColumns& hits, size_t n, const SurfelColumns& surfels) {
  static constexpr auto kVariants = variantTable<kInterpolateSurfels>(
      []<uint32_t kBits>() { return &InterpolateSurfelsVariant<kBits>; });
  return kVariants[kInterpolateSurfels.variantFor(effects)](tables, effects, rays, hits, n,
                                                            surfels);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(InterpolateSurfels);
std::uint32_t interpolateSurfels(const ShadingTables& tables, EffectSet effects,
                                 const RayColumns& rays, const HitColumns& hits, std::size_t n,
                                 const SurfelColumns& surfels) noexcept {
  return HWY_DYNAMIC_DISPATCH(InterpolateSurfels)(tables, effects, rays, hits, n, surfels);
}
}  // namespace whit::simd
#endif
