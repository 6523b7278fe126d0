// Textures and normal maps on surfels: queued for a block of rays, then applied.
#if defined(WHIT_SIMD_SURFACE_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_SURFACE_MAPS_INL_H_
#undef WHIT_SIMD_SURFACE_MAPS_INL_H_
#else
#define WHIT_SIMD_SURFACE_MAPS_INL_H_
#endif

#include "simd/texture-inl.h"
#include "simd/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

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
  TexelQueue diffuse, specular, emission, normal;
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
  QueueTexels(tables.shading.textureFilter, tables.textures.data(), tables.texels.data(), map,
              mapped, u, v, slot, queue);
}

// Multiplies the columns at slot i with the texture that waits at `slot`.
HWY_INLINE void ApplyColour(const ShadingTables& tables, const TexelQueue& queue, size_t slot,
                            float* r, float* g, float* b, size_t i) {
  if (!queue.any[slot]) return;
  const V3 colour = Load3(r, g, b, i);
  const V3 texture =
      FilterColour(FetchTexels(tables.shading.textureFilter, tables.texels.data(), queue, slot));
  Store3(Select3(QueuedLanes(queue, slot), Mul3(colour, texture), colour), r, g, b, i);
}

// Bends the shading normals at slot i by the normal map that waits at `slot`.
HWY_INLINE void ApplyNormalMap(const ShadingTables& tables, const BlockTextures& block, size_t slot,
                               const SurfelColumns& surfels, size_t i) {
  if (!block.normal.any[slot]) return;
  const FloatTag d;
  const VF two = hn::Set(d, 2.0f), one = hn::Set(d, 1.0f);
  const V3 code = FilterData3(
      FetchTexels(tables.shading.textureFilter, tables.texels.data(), block.normal, slot));
  const V3 m{hn::MulSub(code.x, two, one), hn::MulSub(code.y, two, one),
             hn::MulSub(code.z, two, one)};
  const V3 tangent = Load3(block.tangent[0], block.tangent[1], block.tangent[2], slot);
  const V3 bitangent = Load3(block.tangent[3], block.tangent[4], block.tangent[5], slot);
  const V3 ns = Load3(surfels.nsX, surfels.nsY, surfels.nsZ, i);
  const V3 bent = MulAdd3(tangent, m.x, MulAdd3(bitangent, m.y, Scale3(ns, m.z)));
  Store3(Select3(QueuedLanes(block.normal, slot), NormalizeOr(bent, ns), ns), surfels.nsX,
         surfels.nsY, surfels.nsZ, i);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
