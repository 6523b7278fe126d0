// The surface at hits: what follows from the records of triangles, interpolated between their
// corners, and carried from the space of an instance to the world; and what exact spheres
// (bake/sphere.h) say in the place of a triangle.
#if defined(WHIT_SIMD_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_SURFACE_INL_H_
#undef WHIT_SIMD_SURFACE_INL_H_
#else
#define WHIT_SIMD_SURFACE_INL_H_
#endif

#include "bake/sphere.h"
#include "simd/material-inl.h"
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
  using R = TriangleRecord;
  const Records<R> records(tables.triangles, triangle);
  const V4 a = records.Load4<offsetof(R, position[0]), offsetof(R, position[3])>();
  const V4 b = records.Load4<offsetof(R, position[4]), offsetof(R, position[7])>();
  const V4 c = records.Load4<offsetof(R, position[8]), offsetof(R, uv[2])>();
  const V4 e = records.Load4<offsetof(R, uv[3]), offsetof(R, material)>();
  return {{a.x, a.y, a.z},
          {a.w, b.x, b.y},
          {b.z, b.w, c.x},
          {c.y, c.z, c.w, e.x, e.y, e.z},
          BitCast(IntTag(), e.w)};
}

HWY_INLINE UvLanes LoadSecondUvs(const ShadingTables& tables, VI triangle) {
  const Records<UvRecord> records(tables.secondUvs, triangle);
  // The last load starts at 2, not 4: a record ends after six floats.
  const V4 a = records.Load4<offsetof(UvRecord, uv[0])>();
  const V4 b = records.Load4<offsetof(UvRecord, uv[2])>();
  return {a.x, a.y, a.z, a.w, b.z, b.w};
}

// The triangles of a vector of hits, and the lanes that hit one.
struct HitLanes {
  MF valid;
  VI triangle;  // any triangle in the other lanes
};

HWY_INLINE HitLanes LoadHits(const HitColumns& hits, size_t triangleCount, size_t i) {
  const IntTag di;
  const VU hit = Load(hits.triangle, i);
  const MF valid = RebindMask(FloatTag(), Ne(hit, Set(kMiss)));
  const VI triangle = Clamped(BitCast(di, hit), triangleCount);
  return {valid, IfThenElseZero(RebindMask(di, valid), triangle)};
}

// The lanes whose number is a triangle's and not a sphere's. Highway compares no unsigned numbers,
// so both are moved by half of their range.
HWY_INLINE MF AreTriangles(VI number, uint32_t firstSphere) {
  const UintTag du;
  const VU half = Set(0x80000000u);
  const VI moved = BitCast(IntTag(), Xor(BitCast(du, number), half));
  const VI first = Set(static_cast<int32_t>(firstSphere ^ 0x80000000u));
  return RebindMask(FloatTag(), Lt(moved, first));
}

// Barycentric weights of the corners.
struct Weights {
  VF w0, w1, w2;
};

HWY_INLINE Weights LoadWeights(const HitColumns& hits, size_t i) {
  const VF u = Load(hits.u, i), v = Load(hits.v, i);
  return {Sub(Sub(Set(1.0f), u), v), u, v};
}

HWY_INLINE VF Interpolate(const Weights& w, VF a, VF b, VF c) {
  return MulThenAdd(a, w.w0, MulThenAdd(b, w.w1, Mul(c, w.w2)));
}

HWY_INLINE V3 Interpolate3(const Weights& w, const V3& a, const V3& b, const V3& c) {
  return {Interpolate(w, a.x, b.x, c.x), Interpolate(w, a.y, b.y, c.y),
          Interpolate(w, a.z, b.z, c.z)};
}

// Interpolates positions as the corner of the largest weight plus the differences of the others:
// exact in a coordinate that all corners share, and more precise the nearer the point is to a
// corner.
HWY_INLINE V3 InterpolatePosition(const Weights& w, const V3& a, const V3& b, const V3& c) {
  const MF nearA = And(Ge(w.w0, w.w1), Ge(w.w0, w.w2)), nearB = Ge(w.w1, w.w2);
  const V3 near = Select3(nearA, a, Select3(nearB, b, c));
  return Add3(near, Interpolate3(w, Sub3(a, near), Sub3(b, near), Sub3(c, near)));
}

HWY_INLINE VF SumOf(const V3& v) { return Add(Add(v.x, v.y), v.z); }

struct NormalLanes {
  V3 normal;   // unit, of the triangle's plane
  MF inDoubt;  // the triangle is so narrow that rounding may have turned the normal
};

// Edges are brought to the order of 1 by a power of two first, so that the products of tiny or huge
// edges stay in range and scaling a scene by 2^k changes no bit.
HWY_INLINE NormalLanes GeometricNormal(const V3& edge1, const V3& edge2) {
  const VF largest = Max(MaxComponent(Abs3(edge1)), MaxComponent(Abs3(edge2)));
  const VF scale = InverseExponent(largest);
  const V3 unit{Zero(), Zero(), Set(1.0f)};
  const V3 a = Scale3(edge1, scale), b = Scale3(edge2, scale), area = ExactCross(a, b);

  // Where the area is tiny against the sides, rounding may turn the normal.
  const VF sides = Mul(SumOf(Abs3(a)), SumOf(Abs3(b)));
  return {NormalizeOr(area, unit), Le(SumOf(Abs3(area)), Mul(sides, Set(0x1p-14f)))};
}

// One vector for each corner of a triangle.
struct Corners {
  V3 c0, c1, c2;
};

// A record begins with nine floats, three a corner.
template <class Record>
HWY_INLINE Corners LoadCorners(const Record* table, int stride, VI triangle) {
  const Records<Record> records(table, static_cast<size_t>(stride), triangle);

  // The last load starts at 5, not 8: a record ends after nine floats.
  const V4 a = records.template Load4<0>(), b = records.template Load4<4 * sizeof(float)>();
  const V4 c = records.template Load4<5 * sizeof(float)>();
  return {{a.x, a.y, a.z}, {a.w, b.x, b.y}, {b.z, b.w, c.w}};
}

HWY_INLINE Corners LoadNormals(const ShadingTables& tables, VI triangle) {
  static_assert(sizeof(NormalRecord) == 9 * sizeof(float));
  return LoadCorners(tables.normals, tables.normalStride, triangle);
}

// Interpolates vertex colors as the first corner's color plus the differences of the others, so
// that one color at all corners is reproduced exactly.
HWY_INLINE V3 VertexColor(const ShadingTables& tables, VI triangle, VF u, VF v) {
  static_assert(sizeof(ColorRecord) == 9 * sizeof(float));
  const auto [c0, c1, c2] = LoadCorners(tables.colors, tables.colorStride, triangle);
  const V3 there = MulAdd3(Sub3(c2, c0), v, MulAdd3(Sub3(c1, c0), u, c0));
  const VF zero = Zero();
  return {Max(there.x, zero), Max(there.y, zero), Max(there.z, zero)};
}

HWY_INLINE V3 SmoothNormal(const ShadingTables& tables, VI triangle, const Weights& w,
                           const V3& ng) {
  const Corners n = LoadNormals(tables, triangle);
  return NormalizeOr(Interpolate3(w, n.c0, n.c1, n.c2), ng);
}

// The rows of one matrix for each lane.
struct MatrixLanes {
  V4 row0, row1, row2;
};

HWY_INLINE V3 TransformVector(const MatrixLanes& m, const V3& v) {
  return {Dot({m.row0.x, m.row0.y, m.row0.z}, v), Dot({m.row1.x, m.row1.y, m.row1.z}, v),
          Dot({m.row2.x, m.row2.y, m.row2.z}, v)};
}

// Transforms from the space of an instance to the world.
struct PlacementLanes {
  MatrixLanes toWorld, normal;
  V3 origin;  // origin of the instance's space
  VF handedness;
};

HWY_INLINE PlacementLanes LoadPlacements(const InstanceTransform* table, VI instance, MF placed) {
  using R = InstanceTransform;
  const SharedRecords<R> records(table, instance, placed);
  PlacementLanes p;
  p.toWorld = {records.Load4<offsetof(R, toWorld[0])>(), records.Load4<offsetof(R, toWorld[4])>(),
               records.Load4<offsetof(R, toWorld[8])>()};
  p.normal = {records.Load4<offsetof(R, normal[0])>(), records.Load4<offsetof(R, normal[4])>(),
              records.Load4<offsetof(R, normal[8])>()};
  p.origin = {p.toWorld.row0.w, p.toWorld.row1.w, p.toWorld.row2.w};
  p.handedness = records.Load4<offsetof(R, handedness)>().x;
  return p;
}

// The instances that the lanes hit, and the lanes that hit one.
struct InstanceHits {
  MF placed;
  VI instance;
};

HWY_INLINE InstanceHits LoadInstances(const HitColumns& hits, size_t instanceCount, MF valid,
                                      size_t i) {
  const IntTag di;
  const VI instance = Load(di, reinterpret_cast<const int32_t*>(hits.instance) + i);
  return {And(valid, RebindMask(FloatTag(), NonNegative(instance))),
          Clamped(instance, instanceCount)};
}

struct Surface {
  V3 position, edge1, edge2;
  V3 spans;      // sum of the edges' sizes, per axis
  V3 magnitude;  // sum of the magnitudes that the position is added up from, per axis
  VF across;     // bound on the error along the surface, in units of 2^-24
  MF inDoubt;    // errors of several axes mix: all of them count for the clearance
  V3 ng, ns;     // as modelled
  VF handedness;
};

HWY_INLINE Surface InterpolateSurface(const ShadingTables& tables, const TriangleLanes& t,
                                      VI triangle, const Weights& w, bool smooth) {
  Surface s;
  s.edge1 = Sub3(t.p1, t.p0);
  s.edge2 = Sub3(t.p2, t.p0);
  s.spans = Add3(Abs3(s.edge1), Abs3(s.edge2));
  s.position = InterpolatePosition(w, t.p0, t.p1, t.p2);

  const NormalLanes found = GeometricNormal(s.edge1, s.edge2);
  s.ng = found.normal;
  s.inDoubt = found.inDoubt;
  s.ns = s.ng;
  if (smooth) s.ns = SmoothNormal(tables, triangle, w, s.ng);

  // The bound on rounding errors needs the magnitudes that the position is added up from.
  const Weights absolute{Abs(w.w0), Abs(w.w1), Abs(w.w2)};
  s.magnitude = Interpolate3(absolute, Abs3(t.p0), Abs3(t.p1), Abs3(t.p2));

  s.handedness = Set(1.0f);
  return s;
}

// The scalar reference, which explains the terms, is findStart in
// src/surfaces/surface_point.cpp.
HWY_INLINE void StoreClearance(const Surface& s, VF t, size_t i, const SurfelColumns& surfels) {
  const V3 edges = s.spans, n = Abs3(s.ng);
  const VF point = SumOf(s.magnitude), sides = SumOf(edges);

  // Where errors of several axes mix, all of them count; otherwise those along the normal.
  const VF most = MulThenAdd(point, Set(0x1p-19f), Mul(sides, Set(0x1p-20f)));
  const VF least = Mul(Add(point, sides), Set(0x1p-30f));
  const VF along = MulThenAdd(Dot(n, s.magnitude), Set(0x1p-22f),
                              MulThenAdd(Dot(n, edges), Set(0x1p-20f), least));

  // Rays start back along the viewer's ray by at most half of its way, which is known to be clear.
  const VF across = Mul(s.across, Set(0x1p-24f));
  const VF half = Set(0.5f), back = Min(Mul(most, half), Mul(t, half));
  Store(IfThenElse(s.inDoubt, most, along), surfels.offset, i);
  Store(IfThenElse(s.inDoubt, back, Min(across, back)), surfels.viewOffset, i);
}

// Transforms the surfaces of hits on instances to the world.
HWY_INLINE void CarryToWorld(const ShadingTables& tables, const HitColumns& hits, MF valid,
                             size_t i, Surface& s) {
  const auto [placed, instance] = LoadInstances(hits, tables.instances.size(), valid, i);
  if (AllFalse(placed)) return;

  const VF one = Set(1.0f);
  const PlacementLanes p = LoadPlacements(tables.instances.data(), instance, placed);
  const MatrixLanes &m = p.toWorld, &normal = p.normal;

  // Magnitudes and spans grow by the absolute values of the matrix.
  const MatrixLanes abs{{Abs(m.row0.x), Abs(m.row0.y), Abs(m.row0.z), one},
                        {Abs(m.row1.x), Abs(m.row1.y), Abs(m.row1.z), one},
                        {Abs(m.row2.x), Abs(m.row2.y), Abs(m.row2.z), one}};
  s.magnitude =
      Select3(placed, Add3(TransformVector(abs, s.magnitude), Abs3(p.origin)), s.magnitude);

  s.position = Select3(placed, Add3(TransformVector(m, s.position), p.origin), s.position);
  s.spans = Select3(placed, TransformVector(abs, s.spans), s.spans);
  s.edge1 = Select3(placed, TransformVector(m, s.edge1), s.edge1);
  s.edge2 = Select3(placed, TransformVector(m, s.edge2), s.edge2);

  s.ng = Select3(placed, NormalizeOr(TransformVector(normal, s.ng), s.ng), s.ng);
  s.ns = Select3(placed, NormalizeOr(TransformVector(normal, s.ns), s.ns), s.ns);

  s.handedness = IfThenElse(placed, p.handedness, one);
  s.inDoubt = Or(s.inDoubt, placed);
}

// On a triangle that is larger than its distance from the ray's start, the weights are less precise
// than the distance. There the position is the ray's point, moved into the plane.
HWY_INLINE void FollowRay(const TriangleLanes& t, const RayColumns& rays, VF distance, size_t i,
                          Surface& s) {
  const V3 edges = s.spans;
  const VF sides = SumOf(edges);

  const VF two = Set(2.0f), eight = Set(8.0f);
  s.across = MulThenAdd(SumOf(s.magnitude), two, sides);

  const MF large = AndNot(s.inDoubt, Lt(Mul(distance, eight), sides));
  if (HWY_LIKELY(AllFalse(large))) return;

  // The ray's point is moved along the normal into the triangle's plane.
  const V3 origin = Load3(rays.org, i);
  const V3 point = MulAdd3(DirectionAt(rays, i), distance, origin);
  const VF height = Dot(Sub3(point, t.p0), s.ng);
  s.position = Select3(large, MulAdd3(s.ng, Neg(height), point), s.position);

  const VF ofRay = MulThenAdd(distance, eight, Mul(Dot(Abs3(s.ng), edges), two));
  const VF near = MulThenAdd(SumOf(Abs3(s.position)), two, ofRay);
  s.across = IfThenElse(large, near, s.across);
}

// The sign that turns normals towards the viewer.
HWY_INLINE VF TurnToViewer(MF entering) { return IfThenElse(entering, Set(1.0f), Set(-1.0f)); }

// Stores the columns that textures do not change; `flip` turns the normals towards the viewer.
HWY_INLINE void StoreSurface(const Surface& s, VF t, VF flip, size_t i,
                             const SurfelColumns& surfels) {
  Store3(s.position, surfels.pos, i);
  Store3(Scale3(s.ng, flip), surfels.ng, i);
  Store3(Scale3(s.ns, flip), surfels.ns, i);
  StoreClearance(s, t, i, surfels);
}

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
  SphereLanes s;
  s.on = AndNot(AreTriangles(number, tables.firstSphere), valid);
  if (AllFalse(s.on)) return s;

  const SharedRecords<R> records(reinterpret_cast<const R*>(tables.triangles), number, s.on);
  const V4 a = records.Load4<offsetof(R, axes[0]), offsetof(R, axes[3])>();
  const V4 b = records.Load4<offsetof(R, axes[4]), offsetof(R, axes[7])>();
  const V4 c = records.Load4<offsetof(R, axes[8]), offsetof(R, center[2])>();
  s.x = {a.x, a.y, a.z};
  s.y = {a.w, b.x, b.y};
  s.z = {b.z, b.w, c.x};
  s.center = {c.y, c.z, c.w};
  s.outward = records.Load4<offsetof(R, outward), offsetof(R, material)>().x;

  // The octahedral map is inverted: the corners of the square fold back onto the lower half.
  const VF one = Set(1.0f), begin = Set(static_cast<float>(kSphereWeightBegin));
  const VF scale = Set(static_cast<float>(1 / kSphereWeightScale));
  const auto coordinate = [&](const float* weight) HWY_ATTR {
    return MulThenSub(Sub(Load(weight, i), begin), scale, one);
  };
  const VF u = coordinate(hits.u), v = coordinate(hits.v);

  const VF height = Sub(Sub(one, Abs(u)), Abs(v));
  const MF below = Lt(height, Zero());
  const VF foldedU = CopySign(Sub(one, Abs(v)), u);
  const VF foldedV = CopySign(Sub(one, Abs(u)), v);

  s.direction = {IfThenElse(below, foldedU, u), IfThenElse(below, foldedV, v), height};
  s.unit = Normalize3(s.direction);
  return s;
}

HWY_INLINE V3 FromUnit(const SphereLanes& s, const V3& v) {
  return MulAdd3(s.x, v.x, MulAdd3(s.y, v.y, Scale3(s.z, v.z)));
}

HWY_INLINE V3 SphereNormal(const SphereLanes& s) {
  const VF largest =
      Max(MaxComponent(Abs3(s.x)), Max(MaxComponent(Abs3(s.y)), MaxComponent(Abs3(s.z))));
  const VF scale = InverseExponent(largest);
  const V3 x = Scale3(s.x, scale), y = Scale3(s.y, scale), z = Scale3(s.z, scale);

  // The cofactors of a map transform normals.
  const V3 carried =
      MulAdd3(Cross(y, z), s.direction.x,
              MulAdd3(Cross(z, x), s.direction.y, Scale3(Cross(x, y), s.direction.z)));
  return NormalizeOr(Scale3(carried, s.outward), s.unit);
}

// Puts a triangle that touches the sphere in the place of the hit triangle, with the weights of its
// first corner. The scalar reference is touchingTriangle in src/bake/sphere.cpp.
HWY_INLINE void TouchSpheres(const SphereLanes& s, Surface& surface, TriangleLanes& t, Weights& w) {
  const VF zero = Zero(), one = Set(1.0f);

  const V3& q = s.unit;

  // At a pole the azimuth about y is undefined, and any one will do.
  const VF rho2 = MulThenAdd(q.x, q.x, Mul(q.z, q.z));
  const MF turned = Gt(rho2, Set(1e-30f));
  const VF rho = Sqrt(rho2), inverse = Div(one, IfThenElse(turned, rho, one));
  const VF cosine = IfThenElse(turned, Mul(q.x, inverse), one);
  const VF sine = IfThenElseZero(turned, Mul(q.z, inverse));

  // The edges are a sphere's tangents along growing u and growing v. Near a pole the first one
  // keeps a least length.
  constexpr float kStep = kTouchingEdge * 3.14159265f;
  const VF step = Set(kStep);
  const VF round = Mul(Set(2 * kStep), Max(rho, Set(kPoleRadius)));
  const V3 along = FromUnit(s, {Mul(sine, round), zero, Neg(Mul(cosine, round))});
  const VF fall = Neg(Mul(q.y, step));
  const V3 across = FromUnit(s, {Mul(fall, cosine), Mul(rho, step), Mul(fall, sine)});

  // Texture coordinates grow by kTouchingEdge along either edge.
  const VF u = AzimuthFraction(Neg(q.z), Neg(q.x));
  const VF v = Mul(AzimuthFraction(rho, q.y), Set(2.0f));
  const VF edge = Set(kTouchingEdge);

  // A map that mirrors swaps the edges, so that their cross product still points outwards.
  const MF mirrored = Lt(s.outward, zero);
  const auto put = [&](VF value, VF& to) HWY_ATTR { to = IfThenElse(s.on, value, to); };

  surface.edge1 = Select3(s.on, Select3(mirrored, across, along), surface.edge1);
  surface.edge2 = Select3(s.on, Select3(mirrored, along, across), surface.edge2);

  put(u, t.uv.u0);
  put(v, t.uv.v0);
  put(Add(u, IfThenElse(mirrored, zero, edge)), t.uv.u1);
  put(Add(v, IfThenElse(mirrored, edge, zero)), t.uv.v1);
  put(Add(u, IfThenElse(mirrored, edge, zero)), t.uv.u2);
  put(Add(v, IfThenElse(mirrored, zero, edge)), t.uv.v2);

  put(one, w.w0);
  put(zero, w.w1);
  put(zero, w.w2);
}

// True if any map is looked up by the texture coordinates of a sphere.
HWY_INLINE bool AnyMapped(const ShadingTables& tables, const SphereLanes& s,
                          const TriangleLanes& t) {
  constexpr size_t kFlags = offsetof(MaterialRecord, flags);
  const VU flags =
      BitCast(UintTag(), GatherMember<kFlags>(std::span(tables.materials), t.material));
  return !AllFalse(And(s.on, HasFlags(flags, kMaterialMapped)));
}

// Computes the surfaces of hits on spheres, in the space of their geometry. The scalar reference is
// placementOnSphere in src/surfaces/surface_point.cpp.
HWY_INLINE void PutOnSpheres(const ShadingTables& tables, const HitColumns& hits, MF valid,
                             VI number, size_t i, Surface& surface, TriangleLanes& t, Weights& w) {
  const SphereLanes s = LoadSpheres(tables, hits, valid, number, i);
  if (AllFalse(s.on)) return;

  // The bound on rounding errors needs the magnitudes that the position is added up from.
  const V3 q = Abs3(s.unit);
  const V3 magnitude = Add3(
      MulAdd3(Abs3(s.x), q.x, MulAdd3(Abs3(s.y), q.y, Scale3(Abs3(s.z), q.z))), Abs3(s.center));

  const V3 position = Add3(FromUnit(s, s.unit), s.center);
  const V3 normal = SphereNormal(s);
  const V3 axes = Add3(Add3(Abs3(s.x), Abs3(s.y)), Abs3(s.z));

  // Only maps need texture coordinates and edges.
  if (AnyMapped(tables, s, t)) TouchSpheres(s, surface, t, w);

  t.p0 = Select3(s.on, position, t.p0);
  surface.spans = Select3(s.on, Scale3(axes, Set(kSphereSpan)), surface.spans);
  surface.position = Select3(s.on, position, surface.position);
  surface.magnitude = Select3(s.on, magnitude, surface.magnitude);
  surface.ng = Select3(s.on, normal, surface.ng);
  surface.ns = Select3(s.on, normal, surface.ns);
  surface.inDoubt = AndNot(s.on, surface.inDoubt);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
