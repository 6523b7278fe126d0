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

// Tangent-space normal, in the frame that the texture coordinates span (T along u, B along v).
HWY_INLINE V3 MappedNormal(const ShadingTables& tables, const TriangleLanes& t, const V3& edge1,
                           const V3& edge2, const V3& ns, VF handedness, VF u, VF v, VI texture,
                           MF live) {
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
  const Footprint texels =
      FindFootprint(tables.textures.data(), tables.texels.data(), texture, live, u, v);
  const VF two = hn::Set(d, 2.0f), one = hn::Set(d, 1.0f);
  const V3 code = FilterData3(texels);
  const V3 m{hn::MulSub(code.x, two, one), hn::MulSub(code.y, two, one),
             hn::MulSub(code.z, two, one)};
  const V3 bent = MulAdd3(tangent, m.x, MulAdd3(bitangent, m.y, Scale3(ns, m.z)));
  const VF tangentLength = Dot(tangent, tangent);
  const MF good =
      hn::And(live, hn::And(hn::Ne(det, hn::Zero(d)), hn::Gt(tangentLength, hn::Set(d, 0.5f))));
  return Select3(good, NormalizeOr(bent, ns), ns);
}

HWY_INLINE V3 TexturedColour(const ShadingTables& tables, const V3& colour, VI texture, MF live,
                             VF u, VF v) {
  const FloatTag d;
  const MF mapped = hn::And(live, hn::RebindMask(d, NonNegative(texture)));
  if (hn::AllFalse(d, mapped)) return colour;
  const Footprint texels =
      FindFootprint(tables.textures.data(), tables.texels.data(), texture, mapped, u, v);
  return Select3(mapped, Mul3(colour, FilterColour(texels)), colour);
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

template <uint32_t kBits>
HWY_NOINLINE uint32_t InterpolateSurfelsVariant(const ShadingTables& tables, EffectSet effects,
                                                const RayColumns& rays, const HitColumns& hits,
                                                size_t n, const SurfelColumns& surfels) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const bool instanced = (effects.bits() & kInstanced) != 0;
  const bool glossy = (effects.bits() & kGlossy) != 0;
  const bool transmission = (effects.bits() & kTransmission) != 0;
  const bool absorption = (effects.bits() & kAbsorption) != 0;
  const VF one = hn::Set(d, 1.0f);
  VU flags = hn::Zero(du);
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VU hit = hn::Load(du, hits.triangle + i);
    const MF valid = hn::RebindMask(d, hn::Ne(hit, hn::Set(du, kMiss)));
    if (absorption) Absorb(tables, rays, hits, valid, i);
    if (hn::AllFalse(d, valid)) {
      hn::Store(hn::Set(du, kMiss), du, surfels.material + i);
      continue;
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
    if (instanced) {
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
    V3 colour{diffuse.x, diffuse.y, diffuse.z};
    const VF texU = Interpolate(w, t.u0, t.u1, t.u2), texV = Interpolate(w, t.v0, t.v1, t.v2);
    if constexpr ((kBits & kTextured) != 0) {
      colour = TexturedColour(tables, colour, hn::BitCast(di, diffuse.w), valid, texU, texV);
    }
    if constexpr ((kBits & kNormalMapped) != 0) {
      const VI map = hn::BitCast(di, material.Columns4(8).w);
      const MF mapped = hn::And(valid, hn::RebindMask(d, NonNegative(map)));
      if (!hn::AllFalse(d, mapped)) {
        ns = MappedNormal(tables, t, edge1, edge2, ns, handedness, texU, texV, map, mapped);
      }
    }
    const V3 direction = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
    const MF entering = hn::Lt(Dot(direction, ng), hn::Zero(d));
    const VF flip = hn::IfThenElse(entering, one, hn::Set(d, -1.0f));
    Store3(position, surfels.posX, surfels.posY, surfels.posZ, i);
    Store3(Scale3(ng, flip), surfels.ngX, surfels.ngY, surfels.ngZ, i);
    Store3(Scale3(ns, flip), surfels.nsX, surfels.nsY, surfels.nsZ, i);
    const VF sum = hn::Add(hn::Add(magnitude.x, magnitude.y), magnitude.z);
    hn::Store(hn::Mul(sum, hn::Set(d, 0x1p-19f)), d, surfels.offset + i);
    Store3(colour, surfels.diffuseR, surfels.diffuseG, surfels.diffuseB, i);
    const VU materialOrMiss =
        hn::IfThenElse(hn::RebindMask(du, valid), hn::BitCast(du, t.material), hn::Set(du, kMiss));
    hn::Store(materialOrMiss, du, surfels.material + i);
    const V4 lobe = material.Columns4(12);
    flags = hn::Or(flags, hn::BitCast(du, hn::IfThenElseZero(valid, lobe.z)));
    if (glossy) {
      const V4 specular = material.Columns4(4);
      V3 reflectance{specular.x, specular.y, specular.z};
      if constexpr ((kBits & kTextured) != 0) {
        reflectance =
            TexturedColour(tables, reflectance, hn::BitCast(di, specular.w), valid, texU, texV);
      }
      Store3(reflectance, surfels.specularR, surfels.specularG, surfels.specularB, i);
      hn::Store(lobe.x, d, surfels.alpha + i);
    }
    if (transmission) StoreMedia(tables, rays, lobe.y, entering, i, surfels);
  }
  HWY_ALIGN uint32_t lanes[16];
  hn::Store(flags, du, lanes);
  uint32_t any = 0;
  for (size_t lane = 0; lane < hn::Lanes(du); ++lane) any |= lanes[lane];
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
