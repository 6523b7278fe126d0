// What the kernels of addImpulses share: the surfels that send rays on, and the children that these
// become.
#if defined(WHIT_SIMD_IMPULSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_IMPULSE_INL_H_
#undef WHIT_SIMD_IMPULSE_INL_H_
#else
#define WHIT_SIMD_IMPULSE_INL_H_
#endif

#include <limits>

#include "simd/compact-inl.h"
#include "simd/fresnel-inl.h"
#include "simd/media-inl.h"
#include "simd/random_streams-inl.h"
#include "simd/ray_origin-inl.h"
#include "stages/columns.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// What both kinds of impulse need of a vector of surfels.
struct ImpulseLanes {
  MF live;        // the surfel has an impulse of the kind in question
  MF dielectric;  // and bounds a medium
  MF hidden;      // and is not there, because a higher priority fills its place
  V3 direction, ng, ns;
  VF facing;  // cosine between viewer and geometric normal
  VF cosine;  // between viewer and shading normal, in [0, 1]
  VI material;
};

// The least sine over the surface that a child keeps, if `elevation` is what it would have without
// bent normals.
HWY_INLINE VF LeastElevation(const ShadingTables& tables, VF elevation) {
  const FloatTag d;
  if (!tables.shading.bend) return hn::Set(d, -std::numeric_limits<float>::infinity());
  return hn::Min(hn::Mul(hn::Set(d, 0.9f), elevation), hn::Set(d, 0.01f));
}

HWY_INLINE ImpulseLanes LoadImpulseLanes(const ShadingTables& tables, bool transmission,
                                         uint32_t wanted, const RayColumns& rays,
                                         const SurfelColumns& surfels, size_t i) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  ImpulseLanes lanes;
  lanes.material = hn::Load(di, reinterpret_cast<const int32_t*>(surfels.material) + i);
  lanes.live = hn::RebindMask(d, NonNegative(lanes.material));
  lanes.dielectric = lanes.hidden = hn::MaskFromVec(hn::Zero(d));
  if (hn::AllFalse(d, lanes.live)) return lanes;
  const TableReader reader(tables.materials.data(), kMaterialStride, lanes.material, lanes.live);
  const VU flags = hn::BitCast(du, reader.Columns4(12).z);
  const auto has = [&](VU word, uint32_t bits) HWY_ATTR {
    return hn::RebindMask(d, hn::Ne(hn::And(word, hn::Set(du, bits)), hn::Zero(du)));
  };
  lanes.live = hn::And(lanes.live, has(flags, wanted));
  if (hn::AllFalse(d, lanes.live)) return lanes;
  if (transmission) {
    lanes.dielectric = hn::And(lanes.live, has(flags, kMaterialTransmits));
    lanes.hidden = hn::And(lanes.dielectric, has(hn::Load(du, surfels.flags + i), kHidden));
  }
  lanes.direction = Load3(rays.dirX, rays.dirY, rays.dirZ, i);
  lanes.ng = Load3(surfels.ngX, surfels.ngY, surfels.ngZ, i);
  lanes.ns = Load3(surfels.nsX, surfels.nsY, surfels.nsZ, i);
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const VF towards = hn::Neg(Dot(lanes.direction, lanes.ns));
  lanes.cosine = hn::Min(hn::Max(towards, zero), one);
  lanes.facing = hn::Neg(Dot(lanes.direction, lanes.ng));
  return lanes;
}

HWY_INLINE Interface InterfaceOf(const ShadingTables& tables, const ImpulseLanes& lanes,
                                 const RayColumns& rays, const SurfelColumns& surfels, size_t i) {
  const IntTag di;
  const UintTag du;
  const FloatTag d;
  const auto ior = [&](VU stack) HWY_ATTR {
    const VI medium = hn::BitCast(di, CurrentMedium(tables, stack));
    const float* table = reinterpret_cast<const float*>(tables.media.data());
    return hn::GatherIndex(d, table, hn::Mul(medium, hn::Set(di, kMediumStride)));
  };
  return DielectricInterface(tables.shading.fresnel, ior(hn::Load(du, rays.media + i)),
                             ior(hn::Load(du, surfels.mediaBehind + i)), lanes.cosine);
}

struct Child {
  V3 origin, direction, weight;
  VU media, path;
  VF largest;  // of the weight, and the material's share of it, for the cutoff
  VF cone;
};

// Appends the children of the lanes that are worth tracing; returns how many.
HWY_INLINE size_t Append(const Child& child, MF live, float cutoff, const RayColumns& rays,
                         size_t i, const RayColumns& children, size_t at) {
  const FloatTag d;
  const UintTag du;
  const VF largest = child.largest;
  const VF throughput = hn::Mul(hn::Load(d, rays.throughput + i), largest);
  const MF traced =
      hn::And(live, hn::And(hn::Ge(throughput, hn::Set(d, cutoff)), hn::Gt(largest, hn::Zero(d))));
  if (hn::AllFalse(d, traced)) return 0;
  const Compactor compactor(traced);
  compactor.Store(child.origin, children.orgX, children.orgY, children.orgZ, at);
  compactor.Store(child.direction, children.dirX, children.dirY, children.dirZ, at);
  compactor.Store(child.weight, children.weightR, children.weightG, children.weightB, at);
  compactor.Store(throughput, children.throughput + at);
  if (children.media) compactor.Store(child.media, children.media + at);
  if (children.path) compactor.Store(child.path, children.path + at);
  if (children.cone) compactor.Store(child.cone, children.cone + at);
  compactor.Store(hn::Iota(du, static_cast<uint32_t>(i)), children.parent + at);
  return compactor.Count();
}

// The numbers of the paths, where there are any, and of their children.
HWY_INLINE VU StreamsAt(const RayColumns& rays, size_t i) {
  const UintTag du;
  return rays.path ? hn::Load(du, rays.path + i) : hn::Zero(du);
}
HWY_INLINE VU ChildStreamsAt(const RayColumns& rays, size_t i, uint32_t branch) {
  return rays.path ? ChildStream(StreamsAt(rays, i), branch) : hn::Zero(UintTag());
}

// Where there are cones, the children's begin as wide as their parents' end.
HWY_INLINE VF ConesAt(const SurfelColumns& surfels, size_t i) {
  const FloatTag d;
  return surfels.cone ? hn::Load(d, surfels.cone + i) : hn::Zero(d);
}

// A reflected direction, lifted where a bent normal would send it below the surface (hard case
// H32).
HWY_INLINE V3 Lifted(const V3& r, const V3& ng, VF lift, MF live) {
  const FloatTag d;
  const VF height = Dot(r, ng);
  const MF low = hn::Lt(height, lift);
  if (HWY_LIKELY(hn::AllFalse(d, hn::And(low, live)))) return r;
  return Select3(low, NormalizeOr(MulAdd3(ng, hn::Sub(lift, height), r), ng), r);
}

HWY_INLINE V3 ChildOrigin(const ShadingTables& tables, const SurfelColumns& surfels,
                          const ImpulseLanes& lanes, size_t i, float side) {
  const FloatTag d;
  const V3 position = Load3(surfels.posX, surfels.posY, surfels.posZ, i);
  return RayOrigin(tables.shading.offset, position, lanes.ng, lanes.direction,
                   hn::Load(d, surfels.offset + i), side);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
