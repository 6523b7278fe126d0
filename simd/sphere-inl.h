// The surface at hits on exact spheres (scene/sphere.h), in the place of what a triangle would say.
#if defined(WHIT_SIMD_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_SPHERE_INL_H_
#undef WHIT_SIMD_SPHERE_INL_H_
#else
#define WHIT_SIMD_SPHERE_INL_H_
#endif

#include "bake/sphere.h"
#include "simd/azimuth-inl.h"
#include "simd/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

struct SphereLanes {
  MF on;
  V3 x, y, z, center;
  VF outward;
  V3 direction;  // to the point of the unit sphere, not normalized
  V3 unit;       // the point
};

// Loads the spheres of the vector of hits at i. The scalar reference of the weights is spherePoint
// in src/bake/sphere.cpp.
HWY_INLINE SphereLanes LoadSpheres(const ShadingTables& tables, const HitColumns& hits, MF valid,
                                   VI number, size_t i) {
  using R = SphereRecord;
  const FloatTag d;
  SphereLanes s;
  s.on = hn::AndNot(AreTriangles(number, tables.firstSphere), valid);
  if (hn::AllFalse(d, s.on)) return s;
  const SharedRecords<R> records(reinterpret_cast<const R*>(tables.triangles), number, s.on);
  const V4 a = records.Load4<offsetof(R, axes[0]), offsetof(R, axes[3])>();
  const V4 b = records.Load4<offsetof(R, axes[4]), offsetof(R, axes[7])>();
  const V4 c = records.Load4<offsetof(R, axes[8]), offsetof(R, center[2])>();
  s.x = {a.x, a.y, a.z}, s.y = {a.w, b.x, b.y}, s.z = {b.z, b.w, c.x};
  s.center = {c.y, c.z, c.w};
  s.outward = records.Load4<offsetof(R, outward), offsetof(R, material)>().x;
  const VF one = hn::Set(d, 1.0f), begin = hn::Set(d, static_cast<float>(kSphereWeightBegin));
  const VF scale = hn::Set(d, static_cast<float>(1 / kSphereWeightScale));
  const auto coordinate = [&](const float* weight) HWY_ATTR {
    return MulThenSub(hn::Sub(hn::Load(d, weight + i), begin), scale, one);
  };
  const VF u = coordinate(hits.u), v = coordinate(hits.v);
  const VF height = hn::Sub(hn::Sub(one, hn::Abs(u)), hn::Abs(v));
  const MF below = hn::Lt(height, hn::Zero(d));
  const VF foldedU = hn::CopySign(hn::Sub(one, hn::Abs(v)), u);
  const VF foldedV = hn::CopySign(hn::Sub(one, hn::Abs(u)), v);
  s.direction = {hn::IfThenElse(below, foldedU, u), hn::IfThenElse(below, foldedV, v), height};
  s.unit = Normalize3(s.direction);
  return s;
}

HWY_INLINE V3 FromUnit(const SphereLanes& s, const V3& v) {
  return MulAdd3(s.x, v.x, MulAdd3(s.y, v.y, Scale3(s.z, v.z)));
}

HWY_INLINE V3 SphereNormal(const SphereLanes& s) {
  const VF largest =
      hn::Max(MaxComponent(Abs3(s.x)), hn::Max(MaxComponent(Abs3(s.y)), MaxComponent(Abs3(s.z))));
  const VF scale = InverseExponent(largest);
  const V3 x = Scale3(s.x, scale), y = Scale3(s.y, scale), z = Scale3(s.z, scale);
  const V3 carried =
      MulAdd3(Cross(y, z), s.direction.x,
              MulAdd3(Cross(z, x), s.direction.y, Scale3(Cross(x, y), s.direction.z)));
  return NormalizeOr(Scale3(carried, s.outward), s.unit);
}

// The triangle that touches the sphere there, as touchingTriangle in src/bake/sphere.cpp has it,
// and the weights of its first corner.
HWY_INLINE void TouchSpheres(const SphereLanes& s, Surface& surface, TriangleLanes& t, Weights& w) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const V3& q = s.unit;
  const VF rho2 = MulThenAdd(q.x, q.x, hn::Mul(q.z, q.z));
  const MF turned = hn::Gt(rho2, hn::Set(d, 1e-30f));
  const VF rho = hn::Sqrt(rho2), inverse = hn::Div(one, hn::IfThenElse(turned, rho, one));
  const VF cosine = hn::IfThenElse(turned, hn::Mul(q.x, inverse), one);
  const VF sine = hn::IfThenElseZero(turned, hn::Mul(q.z, inverse));
  constexpr float kStep = kTouchingEdge * 3.14159265f;
  const VF step = hn::Set(d, kStep);
  const VF round = hn::Mul(hn::Set(d, 2 * kStep), hn::Max(rho, hn::Set(d, kPoleRadius)));
  const V3 along = FromUnit(s, {hn::Mul(sine, round), zero, hn::Neg(hn::Mul(cosine, round))});
  const VF fall = hn::Neg(hn::Mul(q.y, step));
  const V3 across = FromUnit(s, {hn::Mul(fall, cosine), hn::Mul(rho, step), hn::Mul(fall, sine)});
  const VF u = AzimuthFraction(hn::Neg(q.z), hn::Neg(q.x));
  const VF v = hn::Mul(AzimuthFraction(rho, q.y), hn::Set(d, 2.0f));
  const VF edge = hn::Set(d, kTouchingEdge);
  const MF mirrored = hn::Lt(s.outward, zero);
  const auto put = [&](VF value, VF& to) HWY_ATTR { to = hn::IfThenElse(s.on, value, to); };
  surface.edge1 = Select3(s.on, Select3(mirrored, across, along), surface.edge1);
  surface.edge2 = Select3(s.on, Select3(mirrored, along, across), surface.edge2);
  put(u, t.uv.u0);
  put(v, t.uv.v0);
  put(hn::Add(u, hn::IfThenElse(mirrored, zero, edge)), t.uv.u1);
  put(hn::Add(v, hn::IfThenElse(mirrored, edge, zero)), t.uv.v1);
  put(hn::Add(u, hn::IfThenElse(mirrored, edge, zero)), t.uv.u2);
  put(hn::Add(v, hn::IfThenElse(mirrored, zero, edge)), t.uv.v2);
  put(one, w.w0);
  put(zero, w.w1);
  put(zero, w.w2);
}

// True if any map is looked up by the texture coordinates of a sphere.
HWY_INLINE bool AnyMapped(const ShadingTables& tables, const SphereLanes& s,
                          const TriangleLanes& t) {
  constexpr size_t kFlags = offsetof(MaterialRecord, flags);
  const VU flags =
      hn::BitCast(UintTag(), GatherMember<kFlags>(tables.materials.data(), t.material));
  return !hn::AllFalse(FloatTag(), hn::And(s.on, HasFlags(flags, kMaterialMapped)));
}

// Before CarryToWorld. The scalar reference is placeOnSphere in
// src/reference/find_intersections.cpp.
HWY_INLINE void PutOnSpheres(const ShadingTables& tables, const HitColumns& hits, MF valid,
                             VI number, size_t i, Surface& surface, TriangleLanes& t, Weights& w) {
  const FloatTag d;
  const SphereLanes s = LoadSpheres(tables, hits, valid, number, i);
  if (hn::AllFalse(d, s.on)) return;
  const V3 q = Abs3(s.unit);
  const V3 magnitude = Add3(
      MulAdd3(Abs3(s.x), q.x, MulAdd3(Abs3(s.y), q.y, Scale3(Abs3(s.z), q.z))), Abs3(s.center));
  const V3 position = Add3(FromUnit(s, s.unit), s.center);
  const V3 normal = SphereNormal(s);
  const V3 axes = Add3(Add3(Abs3(s.x), Abs3(s.y)), Abs3(s.z));
  if (AnyMapped(tables, s, t)) TouchSpheres(s, surface, t, w);
  t.p0 = Select3(s.on, position, t.p0);
  surface.spans = Select3(s.on, Scale3(axes, hn::Set(d, kSphereSpan)), surface.spans);
  surface.position = Select3(s.on, position, surface.position);
  surface.magnitude = Select3(s.on, magnitude, surface.magnitude);
  surface.ng = Select3(s.on, normal, surface.ng);
  surface.ns = Select3(s.on, normal, surface.ns);
  surface.inDoubt = hn::AndNot(s.on, surface.inDoubt);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
