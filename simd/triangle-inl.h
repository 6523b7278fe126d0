// What follows from a hit triangle's record: corners, normals, and what lies between them.
#if defined(WHIT_SIMD_TRIANGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_TRIANGLE_INL_H_
#undef WHIT_SIMD_TRIANGLE_INL_H_
#else
#define WHIT_SIMD_TRIANGLE_INL_H_
#endif

#include "simd/records-inl.h"
#include "stages/columns.h"
#include "stages/shading_tables.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Texture coordinates of the corners of each lane's triangle.
struct UvLanes {
  VF u0, v0, u1, v1, u2, v2;
};

struct TriangleLanes {
  V3 p0, p1, p2;
  UvLanes uv;
  VI material;
};

HWY_INLINE TriangleLanes LoadTriangles(const ShadingTables& tables, VI triangle) {
  const Records records = RecordsAt(tables.triangles, 16, triangle);
  const V4 a = LoadColumns4(records, 0), b = LoadColumns4(records, 4);
  const V4 c = LoadColumns4(records, 8), e = LoadColumns4(records, 12);
  return {{a.x, a.y, a.z},
          {a.w, b.x, b.y},
          {b.z, b.w, c.x},
          {c.y, c.z, c.w, e.x, e.y, e.z},
          hn::BitCast(IntTag(), e.w)};
}

HWY_INLINE UvLanes LoadSecondUvs(const ShadingTables& tables, VI triangle) {
  const Records records = RecordsAt(tables.secondUvs, sizeof(UvRecord) / sizeof(float), triangle);
  // The last fetch starts at 2, not 4: a record ends after six floats.
  const V4 a = LoadColumns4(records, 0), b = LoadColumns4(records, 2);
  return {a.x, a.y, a.z, a.w, b.z, b.w};
}

// What the hits are of.
struct HitLanes {
  MF valid;
  VI triangle;  // some triangle where nothing was hit
};

HWY_INLINE HitLanes LoadHits(const HitColumns& hits, size_t i) {
  const UintTag du;
  const IntTag di;
  const VU hit = hn::Load(du, hits.triangle + i);
  const MF valid = hn::RebindMask(FloatTag(), hn::Ne(hit, hn::Set(du, kMiss)));
  return {valid, hn::IfThenElseZero(hn::RebindMask(di, valid), hn::BitCast(di, hit))};
}

// Barycentric weights of the corners.
struct Weights {
  VF w0, w1, w2;
};

HWY_INLINE Weights LoadWeights(const HitColumns& hits, size_t i) {
  const FloatTag d;
  const VF u = hn::Load(d, hits.u + i), v = hn::Load(d, hits.v + i);
  return {hn::Sub(hn::Sub(hn::Set(d, 1.0f), u), v), u, v};
}

HWY_INLINE VF Interpolate(const Weights& w, VF a, VF b, VF c) {
  return hn::MulAdd(a, w.w0, hn::MulAdd(b, w.w1, hn::Mul(c, w.w2)));
}
HWY_INLINE V3 Interpolate3(const Weights& w, const V3& a, const V3& b, const V3& c) {
  return {Interpolate(w, a.x, b.x, c.x), Interpolate(w, a.y, b.y, c.y),
          Interpolate(w, a.z, b.z, c.z)};
}

// Unit geometric normal. Edges are brought to the order of 1 by a power of two first, so that the
// products of tiny or huge edges stay in range and scaling a scene by 2^k changes no bit.
HWY_INLINE V3 GeometricNormal(const V3& edge1, const V3& edge2, Reciprocal how) {
  const VF largest = hn::Max(MaxComponent(Abs3(edge1)), MaxComponent(Abs3(edge2)));
  const VF scale = InverseExponent(largest);
  const V3 unit{hn::Zero(FloatTag()), hn::Zero(FloatTag()), hn::Set(FloatTag(), 1.0f)};
  return NormalizeOr(Cross(Scale3(edge1, scale), Scale3(edge2, scale)), unit, how);
}

struct CornerNormals {
  V3 n0, n1, n2;
};

// Nine floats, three a corner.
HWY_INLINE CornerNormals LoadCorners(const void* table, int stride, VI triangle) {
  const Records records = RecordsAt(table, static_cast<size_t>(stride), triangle);
  // The last fetch starts at 5, not 8: a record ends after nine floats.
  const V4 a = LoadColumns4(records, 0), b = LoadColumns4(records, 4);
  const V4 c = LoadColumns4(records, 5);
  return {{a.x, a.y, a.z}, {a.w, b.x, b.y}, {b.z, b.w, c.w}};
}

HWY_INLINE CornerNormals LoadNormals(const ShadingTables& tables, VI triangle) {
  return LoadCorners(tables.normals, tables.normalStride, triangle);
}

// Of the vertices: the first corner's and what the others add to it, so that one color at all
// corners is that color exactly.
HWY_INLINE V3 VertexColor(const ShadingTables& tables, VI triangle, VF u, VF v) {
  const auto [c0, c1, c2] = LoadCorners(tables.colors, tables.colorStride, triangle);
  const V3 there = MulAdd3(Sub3(c2, c0), v, MulAdd3(Sub3(c1, c0), u, c0));
  const VF zero = hn::Zero(FloatTag());
  return {hn::Max(there.x, zero), hn::Max(there.y, zero), hn::Max(there.z, zero)};
}

HWY_INLINE V3 SmoothNormal(const ShadingTables& tables, VI triangle, const Weights& w,
                           const V3& ng) {
  const CornerNormals n = LoadNormals(tables, triangle);
  return NormalizeOr(Interpolate3(w, n.n0, n.n1, n.n2), ng, tables.shading.reciprocal);
}

struct InstanceLanes {
  V4 row0, row1, row2;
};

HWY_INLINE V3 TransformVector(const InstanceLanes& m, const V3& v) {
  return {Dot({m.row0.x, m.row0.y, m.row0.z}, v), Dot({m.row1.x, m.row1.y, m.row1.z}, v),
          Dot({m.row2.x, m.row2.y, m.row2.z}, v)};
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
