#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/add_impulses.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/glossy-inl.h"
#include "simd/impulse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

size_t AddReflections(const ShadingTables& tables, EffectSet effects, float cutoff,
                      const RayColumns& rays, const SurfelColumns& surfels, size_t n,
                      const RayColumns& children, size_t first) {
  const FloatTag d;
  const UintTag du;
  const bool transmission = effects.has(Effect::transmission);
  size_t count = first;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    ImpulseLanes lanes =
        LoadImpulseLanes(tables, transmission, kMaterialReflects, rays, surfels, i);
    lanes.live = hn::AndNot(lanes.hidden, lanes.live);
    if (hn::AllFalse(d, lanes.live)) continue;
    const TableReader reader(tables.materials.data(), kMaterialStride, lanes.material, lanes.live);
    const V4 mirror = reader.Columns4(16), grazing = reader.Columns4(20);
    V3 weight = MulAdd3({grazing.x, grazing.y, grazing.z}, SchlickTerm(lanes.cosine),
                        {mirror.x, mirror.y, mirror.z});
    if (transmission && !hn::AllFalse(d, lanes.dielectric)) {
      const VF f = hn::IfThenElseZero(lanes.dielectric,
                                      InterfaceOf(tables, lanes, rays, surfels, i).reflectance);
      weight = Add3(weight, {f, f, f});
    }
    // d - 2 (d.n) n
    const VF twice = hn::Mul(hn::Set(d, -2.0f), Dot(lanes.direction, lanes.ns));
    const V3 mirrored =
        Normalize3(MulAdd3(lanes.ns, twice, lanes.direction), tables.shading.reciprocal);
    const V3 r = Lifted(mirrored, lanes.ng, LeastElevation(tables, lanes.facing), lanes.live);
    const VU media = transmission ? hn::Load(du, rays.media + i) : hn::Zero(du);
    const Child child{ChildOrigin(tables, surfels, lanes, i, 1.0f),
                      r,
                      weight,
                      media,
                      ChildStreamsAt(rays, i, kMirroredBranch),
                      hn::Mul(MaxComponent(weight), mirror.w),
                      ConesAt(surfels, i)};
    count += Append(child, lanes.live, cutoff, rays, i, children, count);
  }
  return count - first;
}

size_t AddGlossyReflections(const ShadingTables& tables, EffectSet effects, float cutoff,
                            const LobeSampling& sampling, const RayColumns& rays,
                            const SurfelColumns& surfels, size_t n, const RayColumns& children,
                            size_t first) {
  const FloatTag d;
  const UintTag du;
  const bool transmission = effects.has(Effect::transmission);
  const VF one = hn::Set(d, 1.0f), share = hn::Set(d, 1.0f / static_cast<float>(sampling.count));
  size_t count = first;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    ImpulseLanes lanes =
        LoadImpulseLanes(tables, transmission, kMaterialScatters, rays, surfels, i);
    lanes.live = hn::AndNot(lanes.hidden, lanes.live);
    if (hn::AllFalse(d, lanes.live)) continue;
    const TableReader reader(tables.materials.data(), kMaterialStride, lanes.material, lanes.live);
    const VF impulseShare = reader.Columns4(16).w;
    const GlossyLobes lobes = LoadGlossyLobes(surfels, lanes.direction, lanes.ns, i);
    const VF counts = hn::IfThenElse(lobes.rough, share, one);
    const V3 origin = ChildOrigin(tables, surfels, lanes, i, 1.0f);
    const VU media = transmission ? hn::Load(du, rays.media + i) : hn::Zero(du);
    const VU path = StreamsAt(rays, i);
    const VF cone = ConesAt(surfels, i);
    // A smooth lobe is one impulse.
    for (uint32_t k = 0; k < sampling.count; ++k) {
      const MF sampled = k == 0 ? lanes.live : hn::And(lanes.live, lobes.rough);
      if (hn::AllFalse(d, sampled)) break;
      const LobeSample sample = SampleLobe(lobes, LobePoints(path, sampling, k));
      const MF live = hn::And(sampled, hn::Gt(sample.cosine, hn::Zero(d)));
      const V3 r = Lifted(sample.direction, lanes.ng, LeastElevation(tables, sample.cosine), live);
      const Child child{origin,
                        r,
                        Scale3(sample.weight, counts),
                        media,
                        ChildStream(path, kFirstGlossyBranch + k),
                        hn::Mul(MaxComponent(sample.weight), impulseShare),
                        cone};
      count += Append(child, live, cutoff, rays, i, children, count);
    }
  }
  return count - first;
}

size_t AddRefractions(const ShadingTables& tables, EffectSet /*effects*/, float cutoff,
                      const RayColumns& rays, const SurfelColumns& surfels, size_t n,
                      const RayColumns& children, size_t first) {
  const FloatTag d;
  const UintTag du;
  const VF one = hn::Set(d, 1.0f);
  size_t count = first;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const ImpulseLanes lanes = LoadImpulseLanes(tables, true, kMaterialTransmits, rays, surfels, i);
    if (hn::AllFalse(d, lanes.live)) continue;
    const Interface interface = InterfaceOf(tables, lanes, rays, surfels, i);
    const TableReader reader(tables.materials.data(), kMaterialStride, lanes.material, lanes.live);
    const V4 tint = reader.Columns4(24);
    const VF impulseShare = hn::IfThenElse(lanes.hidden, one, reader.Columns4(16).w);
    const VF through = hn::Sub(one, interface.reflectance);
    const V3 weight =
        Select3(lanes.hidden, {one, one, one}, Scale3({tint.x, tint.y, tint.z}, through));
    const V3 bent = MulAdd3(lanes.ns, hn::Neg(interface.bend), lanes.direction);
    V3 r = NormalizeOr(Scale3(bent, hn::Div(one, interface.eta)), lanes.direction,
                       tables.shading.reciprocal);
    const VF height = Dot(r, lanes.ng);
    // Under the geometric normal the ray would leave this steeply, if at all; normals that agree
    // change nothing.
    const VF g2 = hn::MulAdd(lanes.facing, lanes.facing, interface.k);
    const VF leaving = hn::Div(hn::Sqrt(hn::Max(g2, hn::Zero(d))), interface.eta);
    const VF lift = LeastElevation(tables, hn::IfThenElse(hn::Gt(g2, hn::Zero(d)), leaving, one));
    const MF high = hn::Gt(height, hn::Neg(lift));
    const V3 pressed =
        NormalizeOr(MulAdd3(lanes.ng, hn::Neg(hn::Add(lift, height)), r), lanes.direction);
    r = Select3(high, pressed, r);
    r = Select3(hn::Or(interface.straight, lanes.hidden), lanes.direction, r);
    const Child child{ChildOrigin(tables, surfels, lanes, i, -1.0f),
                      r,
                      weight,
                      hn::Load(du, surfels.mediaBehind + i),
                      ChildStreamsAt(rays, i, kRefractedBranch),
                      hn::Mul(MaxComponent(weight), impulseShare),
                      ConesAt(surfels, i)};
    count += Append(child, lanes.live, cutoff, rays, i, children, count);
  }
  return count - first;
}

void ReturnImpulses(const RayColumns& children, const RadianceColumns& childRadiance, size_t n,
                    const RadianceColumns& parentRadiance) {
  const FloatTag d;
  HWY_ALIGN float r[16], g[16], b[16];
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const V3 weight = Load3(children.weightR, children.weightG, children.weightB, i);
    const V3 light = Load3(childRadiance.r, childRadiance.g, childRadiance.b, i);
    Store3(Mul3(weight, light), r, g, b, 0);
    // A parent may occur twice, for its reflected and its refracted child: one after the other.
    const size_t live = HWY_MIN(hn::Lanes(d), n - i);
    for (size_t lane = 0; lane < live; ++lane) {
      const uint32_t parent = children.parent[i + lane];
      parentRadiance.r[parent] += r[lane];
      parentRadiance.g[parent] += g[lane];
      parentRadiance.b[parent] += b[lane];
    }
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(AddReflections);
HWY_EXPORT(AddGlossyReflections);
HWY_EXPORT(AddRefractions);
HWY_EXPORT(ReturnImpulses);

std::size_t addReflections(const ShadingTables& tables, EffectSet effects, float cutoff,
                           const RayColumns& rays, const SurfelColumns& surfels, std::size_t n,
                           const RayColumns& children, std::size_t first) noexcept {
  return HWY_DYNAMIC_DISPATCH(AddReflections)(tables, effects, cutoff, rays, surfels, n, children,
                                              first);
}
std::size_t addGlossyReflections(const ShadingTables& tables, EffectSet effects, float cutoff,
                                 const LobeSampling& sampling, const RayColumns& rays,
                                 const SurfelColumns& surfels, std::size_t n,
                                 const RayColumns& children, std::size_t first) noexcept {
  return HWY_DYNAMIC_DISPATCH(AddGlossyReflections)(tables, effects, cutoff, sampling, rays,
                                                    surfels, n, children, first);
}
std::size_t addRefractions(const ShadingTables& tables, EffectSet effects, float cutoff,
                           const RayColumns& rays, const SurfelColumns& surfels, std::size_t n,
                           const RayColumns& children, std::size_t first) noexcept {
  return HWY_DYNAMIC_DISPATCH(AddRefractions)(tables, effects, cutoff, rays, surfels, n, children,
                                              first);
}
void returnImpulses(const RayColumns& children, const RadianceColumns& childRadiance, std::size_t n,
                    const RadianceColumns& parentRadiance) noexcept {
  HWY_DYNAMIC_DISPATCH(ReturnImpulses)(children, childRadiance, n, parentRadiance);
}
}  // namespace whit::simd
#endif
