// The surface at hits: interpolated between the corners of their triangles, and carried from the
// space of an instance to the world.
#if defined(WHIT_SIMD_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_SURFACE_INL_H_
#undef WHIT_SIMD_SURFACE_INL_H_
#else
#define WHIT_SIMD_SURFACE_INL_H_
#endif

#include "simd/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

struct Surface {
  V3 position, edge1, edge2;
  V3 magnitude;  // of all that went into the position
  V3 ng, ns;     // as modelled
  VF handedness;
};

template <bool kSmoothNormals>
HWY_INLINE Surface InterpolateSurface(const ShadingTables& tables, const TriangleLanes& t,
                                      VI triangle, const Weights& w) {
  Surface s;
  s.edge1 = Sub3(t.p1, t.p0), s.edge2 = Sub3(t.p2, t.p0);
  s.position = Interpolate3(w, t.p0, t.p1, t.p2);
  s.ng = GeometricNormal(s.edge1, s.edge2, tables.shading.reciprocal);
  s.ns = s.ng;
  if constexpr (kSmoothNormals) s.ns = SmoothNormal(tables, triangle, w, s.ng);
  const Weights absolute{hn::Abs(w.w0), hn::Abs(w.w1), hn::Abs(w.w2)};
  s.magnitude = Interpolate3(absolute, Abs3(t.p0), Abs3(t.p1), Abs3(t.p2));
  s.handedness = hn::Set(FloatTag(), 1.0f);
  return s;
}

// Rounding error of the interpolated point: at most gamma(7) times the sum of what went into it
// (pbrt-v4, section 6.8.5); 32 ulps along the normal also cover Embree's own arithmetic.
HWY_INLINE VF OriginOffset(const Surface& s) {
  const VF sum = hn::Add(hn::Add(s.magnitude.x, s.magnitude.y), s.magnitude.z);
  return hn::Mul(sum, hn::Set(FloatTag(), 0x1p-19f));
}

// In the world, where the hits are on instances.
HWY_INLINE void CarryToWorld(const ShadingTables& tables, const HitColumns& hits, MF valid,
                             size_t i, Surface& s) {
  const FloatTag d;
  const IntTag di;
  const VI instance = hn::Load(di, reinterpret_cast<const int32_t*>(hits.instance) + i);
  const MF placed = hn::And(valid, hn::RebindMask(d, NonNegative(instance)));
  if (hn::AllFalse(d, placed)) return;
  const VF one = hn::Set(d, 1.0f);
  const TableReader reader(tables.instances.data(), kInstanceStride, instance, placed);
  const InstanceLanes m{reader.Columns4(0), reader.Columns4(4), reader.Columns4(8)};
  const InstanceLanes normal{reader.Columns4(12), reader.Columns4(16), reader.Columns4(20)};
  const V3 origin{m.row0.w, m.row1.w, m.row2.w};
  const InstanceLanes abs{{hn::Abs(m.row0.x), hn::Abs(m.row0.y), hn::Abs(m.row0.z), one},
                          {hn::Abs(m.row1.x), hn::Abs(m.row1.y), hn::Abs(m.row1.z), one},
                          {hn::Abs(m.row2.x), hn::Abs(m.row2.y), hn::Abs(m.row2.z), one}};
  s.magnitude = Select3(placed, Add3(TransformVector(abs, s.magnitude), Abs3(origin)), s.magnitude);
  s.position = Select3(placed, Add3(TransformVector(m, s.position), origin), s.position);
  s.edge1 = Select3(placed, TransformVector(m, s.edge1), s.edge1);
  s.edge2 = Select3(placed, TransformVector(m, s.edge2), s.edge2);
  s.ng = Select3(placed, NormalizeOr(TransformVector(normal, s.ng), s.ng), s.ng);
  s.ns = Select3(placed, NormalizeOr(TransformVector(normal, s.ns), s.ns), s.ns);
  s.handedness = hn::IfThenElse(placed, reader.Columns4(24).x, one);
}

// The sign that turns normals towards the viewer.
HWY_INLINE VF TurnToViewer(MF entering) {
  const FloatTag d;
  return hn::IfThenElse(entering, hn::Set(d, 1.0f), hn::Set(d, -1.0f));
}

// Stores all that textures do not change; `flip` turns the normals towards the viewer.
HWY_INLINE void StoreSurface(const Surface& s, VF flip, size_t i, const SurfelColumns& surfels) {
  Store3(s.position, surfels.posX, surfels.posY, surfels.posZ, i);
  Store3(Scale3(s.ng, flip), surfels.ngX, surfels.ngY, surfels.ngZ, i);
  Store3(Scale3(s.ns, flip), surfels.nsX, surfels.nsY, surfels.nsZ, i);
  hn::Store(OriginOffset(s), FloatTag(), surfels.offset + i);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
