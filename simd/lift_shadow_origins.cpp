// Where shadow rays start above a facet, for --terminator (the scalar twin: terminatorLift in
// src/reference/surfel.cpp).
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/lift_shadow_origins.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Corners and their normals, in the world.
struct WorldCorners {
  V3 p0, p1, p2;
  CornerNormals normals;
};

HWY_INLINE void CarryToWorld(const ShadingTables& tables, VI instance, MF placed, WorldCorners& c) {
  const TableReader reader(tables.instances.data(), kInstanceStride, instance, placed);
  const InstanceLanes m{reader.Columns4(0), reader.Columns4(4), reader.Columns4(8)};
  const InstanceLanes normal{reader.Columns4(12), reader.Columns4(16), reader.Columns4(20)};
  const V3 origin{m.row0.w, m.row1.w, m.row2.w};
  for (V3* p : {&c.p0, &c.p1, &c.p2}) {
    *p = Select3(placed, Add3(TransformVector(m, *p), origin), *p);
  }
  for (V3* n : {&c.normals.n0, &c.normals.n1, &c.normals.n2}) {
    *n = Select3(placed, NormalizeOr(TransformVector(normal, *n), *n), *n);
  }
}

void LiftShadowOrigins(const ShadingTables& tables, EffectSet effects, const HitColumns& hits,
                       size_t n, const SurfelColumns& surfels) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const bool instanced = effects.has(Effect::instances);
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VU hit = hn::Load(du, hits.triangle + i);
    const MF valid = hn::RebindMask(d, hn::Ne(hit, hn::Set(du, kMiss)));
    const VI triangle = hn::IfThenElseZero(hn::RebindMask(di, valid), hn::BitCast(di, hit));
    const TriangleLanes t = LoadTriangles(tables, triangle);
    WorldCorners c{t.p0, t.p1, t.p2, LoadNormals(tables, triangle)};
    if (instanced) {
      const VI instance = hn::Load(di, reinterpret_cast<const int32_t*>(hits.instance) + i);
      const MF placed = hn::And(valid, hn::RebindMask(d, NonNegative(instance)));
      if (!hn::AllFalse(d, placed)) CarryToWorld(tables, instance, placed, c);
    }
    const VF u = hn::Load(d, hits.u + i), v = hn::Load(d, hits.v + i);
    const V3 position = Load3(surfels.posX, surfels.posY, surfels.posZ, i);
    const V3 ng = Load3(surfels.ngX, surfels.ngY, surfels.ngZ, i);
    const VF offset = hn::Load(d, surfels.offset + i);
    V3 lift{zero, zero, zero};
    const auto add = [&](const V3& corner, const V3& normal, VF weight) HWY_ATTR {
      // Corner normals point to the outside, the surfel's to the viewer.
      const V3 m = Scale3(normal, hn::CopySign(one, Dot(normal, ng)));
      const VF below = hn::Neg(hn::Add(Dot(Sub3(position, corner), m), offset));
      lift = MulAdd3(m, hn::Mul(weight, hn::Max(below, zero)), lift);
    };
    add(c.p0, c.normals.n0, hn::Sub(hn::Sub(one, u), v));
    add(c.p1, c.normals.n1, u);
    add(c.p2, c.normals.n2, v);
    Store3(lift, surfels.liftX, surfels.liftY, surfels.liftZ, i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(LiftShadowOrigins);
void liftShadowOrigins(const ShadingTables& tables, EffectSet effects, const HitColumns& hits,
                       std::size_t n, const SurfelColumns& surfels) noexcept {
  HWY_DYNAMIC_DISPATCH(LiftShadowOrigins)(tables, effects, hits, n, surfels);
}
}  // namespace whit::simd
#endif
