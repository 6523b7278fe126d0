// Fresnel's and Snell's laws (the scalar reference, with sources: src/reference/fresnel.h), samples
// of the GGX lobe (src/reference/add_impulses.cpp), and directions drawn by their cosine to a
// normal (src/sampling/random_streams.h).
#if defined(WHIT_SIMD_LOBES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_LOBES_INL_H_
#undef WHIT_SIMD_LOBES_INL_H_
#else
#define WHIT_SIMD_LOBES_INL_H_
#endif

#include "core/shading_choices.h"
#include "sampling/ggx_lobe.h"
#include "sampling/random_streams.h"
#include "scene/material.h"
#include "simd/material-inl.h"
#include "simd/random_streams-inl.h"
#include "stages/columns.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Dielectric reflectance in factored form: no difference of nearly equal numbers, exact for ior
// ratios near and at 1 (hard cases H37-H41).
struct Interface {
  VF reflectance;  // F
  VF eta;          // ior behind over ior before
  VF k;            // eta^2 - 1
  VF bend;         // k / (c + g), the share of the normal that refraction takes off the direction
  MF straight;     // same ior on both sides: the direction does not change at all
};

// Schlick's polynomial, of the refracted ray's cosine g / eta where that is the smaller one.
HWY_INLINE VF SchlickReflectance(VF iorBefore, VF iorBehind, VF c, VF g) {
  const FloatTag d;
  const VF normal = hn::Div(hn::Sub(iorBehind, iorBefore), hn::Add(iorBehind, iorBefore));
  const VF f0 = hn::Mul(normal, normal);
  const VF refracted = hn::Mul(g, hn::Div(iorBefore, iorBehind));
  const VF cosine = hn::IfThenElse(hn::Lt(iorBehind, iorBefore), refracted, c);
  return MulThenAdd(hn::Sub(hn::Set(d, 1.0f), f0), SchlickTerm(cosine), f0);
}

// c: cosine between the viewer and the normal, in [0, 1].
HWY_INLINE Interface DielectricInterface(FresnelModel model, VF iorBefore, VF iorBehind, VF c) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const VF eta = hn::Div(iorBehind, iorBefore);
  // eta^2 - 1, factored over the iors themselves.
  const VF k = hn::Div(hn::Mul(hn::Sub(iorBehind, iorBefore), hn::Add(iorBehind, iorBefore)),
                       hn::Mul(iorBefore, iorBefore));
  const VF g2 = MulThenAdd(c, c, k);
  const MF straight = hn::Eq(k, zero);
  const MF total = hn::Or(hn::Le(g2, zero), hn::Le(c, zero));
  const VF g = hn::Sqrt(hn::Max(g2, zero));
  const VF sum = hn::Max(hn::Add(c, g), hn::Set(d, 1e-30f));
  const VF bend = hn::Div(k, sum);
  const VF rs = hn::Div(bend, sum);
  const VF etaSquaredC = hn::Mul(hn::Mul(eta, eta), c);
  const VF rp = hn::Div(hn::Mul(k, hn::Sub(c, hn::Div(one, sum))),
                        hn::Max(hn::Add(etaSquaredC, g), hn::Set(d, 1e-30f)));
  VF f = hn::Mul(hn::Set(d, 0.5f), MulThenAdd(rs, rs, hn::Mul(rp, rp)));
  if (model == FresnelModel::schlick) f = SchlickReflectance(iorBefore, iorBehind, c, g);
  f = hn::IfThenElse(total, one, hn::Min(f, one));
  f = hn::IfThenElse(straight, zero, f);
  return {f, eta, k, bend, straight};
}

// The reflectance of the lobes at grazing incidence, with the reflectance `f0` at normal incidence.
HWY_INLINE VF LobeGrazing(const ShadingTables& tables, const SurfelColumns& surfels, const V3& f0,
                          size_t i) {
  const FloatTag d;
  VF ratio = hn::Set(d, kGrazingRatio);
  if (HWY_UNLIKELY(!tables.grazingRatios.empty())) {
    const VI material = MaterialNumbers(surfels, i);
    ratio = GatherMember<0>(std::span(tables.grazingRatios), material);
  }
  return hn::Min(hn::Set(d, 1.0f), hn::Mul(ratio, MaxComponent(f0)));
}

// The values that all samples of a vector of surfels share.
struct GlossyLobes {
  V3 view;
  V3 x, y, z;  // the frame of incidence: z is the shading normal, the view lies over x
  V3 f0;
  VF f90;
  VF alpha;         // 0 where the lobe is smooth
  VF nv;            // cosine between view and normal, above 0
  VF seenX, seenZ;  // the view where the facets are a unit sphere
  MF rough;
};

// The lanes of `flat` are smooth whatever their roughness.
HWY_INLINE GlossyLobes LoadGlossyLobes(const ShadingTables& tables, const SurfelColumns& surfels,
                                       const V3& direction, const V3& ns, MF flat, size_t i) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  GlossyLobes lobes;
  lobes.view = {hn::Neg(direction.x), hn::Neg(direction.y), hn::Neg(direction.z)};
  lobes.z = ns;
  const VF towards = Dot(ns, lobes.view);
  const V3 along = MulAdd3(ns, hn::Neg(towards), lobes.view);
  const VF sine = hn::Sqrt(Dot(along, along));
  // Near the normal, the plane of incidence is lost in rounding: any other.
  const MF oblique = hn::Gt(sine, hn::Set(d, 0.01f));
  const MF useX = hn::Lt(hn::Abs(ns.x), hn::Set(d, 0.5f));
  const V3 axis{hn::IfThenElseZero(useX, one), hn::IfThenElse(useX, zero, one), zero};
  const V3 across = NormalizeOr(Cross(ns, axis), axis);
  const VF scale = hn::Div(one, hn::IfThenElse(oblique, sine, one));
  lobes.x = Select3(oblique, Scale3(along, scale), across);
  lobes.y = Cross(ns, lobes.x);
  lobes.f0 = Load3(surfels.specular, i);
  lobes.f90 = LobeGrazing(tables, surfels, lobes.f0, i);
  const VF alpha = hn::Load(d, surfels.alpha + i);
  lobes.rough = hn::AndNot(flat, hn::Gt(alpha, hn::Set(d, kSmoothAlpha)));
  lobes.alpha = hn::IfThenElseZero(lobes.rough, alpha);
  lobes.nv = hn::Max(towards, hn::Set(d, 1e-4f));
  const V3 seen = Normalize3({hn::Mul(sine, lobes.alpha), zero, lobes.nv});
  lobes.seenX = seen.x;
  lobes.seenZ = seen.z;
  return lobes;
}

// A normal that can be seen, in the world.
HWY_INLINE V3 VisibleNormal(const GlossyLobes& lobes, const UnitPoints& at) {
  const FloatTag d;
  const VF one = hn::Set(d, 1.0f);
  const VF height = hn::Add(one, lobes.seenZ);
  const VF fall = hn::Mul(at.v, height);
  const VF squared = hn::Mul(fall, hn::Sub(hn::Set(d, 2.0f), fall));
  const VF radius = hn::Mul(hn::Sqrt(hn::Max(squared, hn::Zero(d))), lobes.alpha);
  const VF turn = hn::Mul(at.u, hn::Set(d, 6.28318531f));
  const VF x = MulThenAdd(lobes.seenX, lobes.alpha, hn::Mul(radius, hn::Cos(d, turn)));
  const VF y = hn::Mul(radius, hn::Sin(d, turn));
  const VF z = hn::Mul(hn::Sub(one, at.v), height);
  return NormalizeOr(MulAdd3(lobes.x, x, MulAdd3(lobes.y, y, Scale3(lobes.z, z))), lobes.z);
}

struct LobeSample {
  V3 direction, weight;
  VF cosine;  // of the direction to the shading normal; the ray ends in the surface unless above 0
};

// facetAt() of the scalar reference, with the reflectance of a lobe.
struct Facet {
  V3 normal;
  VF cosine;     // between viewer and facet, in [0, 1]
  V3 mirrored;   // the view
  VF elevation;  // of that over the surface
  V3 reflectance;
};

HWY_INLINE Facet FacetAt(const GlossyLobes& lobes, const UnitPoints& at) {
  const FloatTag d;
  const V3 h = VisibleNormal(lobes, at);
  const VF vh = Dot(lobes.view, h), cosine = hn::Min(hn::Max(vh, hn::Zero(d)), hn::Set(d, 1.0f));
  const V3 l = Normalize3(Sub3(Scale3(h, hn::Add(vh, vh)), lobes.view));
  const V3 grazing{hn::Sub(lobes.f90, lobes.f0.x), hn::Sub(lobes.f90, lobes.f0.y),
                   hn::Sub(lobes.f90, lobes.f0.z)};
  return {h, cosine, l, Dot(lobes.z, l), MulAdd3(grazing, SchlickTerm(cosine), lobes.f0)};
}

// passingShare().
HWY_INLINE VF PassingShare(const GlossyLobes& lobes, VF nl) {
  const FloatTag d;
  const VF one = hn::Set(d, 1.0f), nv = lobes.nv;
  const VF a2 = hn::Mul(lobes.alpha, lobes.alpha), rest = hn::Sub(one, a2);
  const VF maskV = hn::Sqrt(MulThenAdd(hn::Mul(nv, nv), rest, a2));
  const VF maskL = hn::Sqrt(MulThenAdd(hn::Mul(nl, nl), rest, a2));
  return hn::Div(hn::Mul(nl, hn::Add(nv, maskV)), MulThenAdd(nl, maskV, hn::Mul(nv, maskL)));
}

// seenShare().
HWY_INLINE VF SeenShare(VF cosine, VF alpha) {
  const FloatTag d;
  const VF a2 = hn::Mul(alpha, alpha), rest = hn::Sub(hn::Set(d, 1.0f), a2);
  const VF mask = hn::Sqrt(MulThenAdd(hn::Mul(cosine, cosine), rest, a2));
  return hn::Div(hn::Add(cosine, cosine), hn::Add(cosine, mask));
}

// The counterpart of lobeAlbedo(), in the lanes of `live`.
HWY_INLINE V3 LobeAlbedo(const LobeTable& table, const V3& f0, VF f90, VF cosine, VF roughness,
                         MF live) {
  const FloatTag d;
  const IntTag di;
  const VF last = hn::Set(d, kLobeSteps - 1.0f), most = hn::Set(d, kLobeSteps - 2.0f);
  const VF row = hn::Mul(roughness, last), column = hn::Mul(hn::Sqrt(cosine), last);
  const VF top = hn::Min(hn::Floor(row), most), left = hn::Min(hn::Floor(column), most);
  const VF down = hn::Sub(row, top), right = hn::Sub(column, left);
  const VF first = hn::IfThenElseZero(live, MulThenAdd(top, hn::Set(d, float{kLobeSteps}), left));
  // Three more texels are looked up behind it.
  const VI at = Clamped(hn::ConvertTo(di, first), kLobeSteps * (kLobeSteps - 1) - 1);
  const auto lookUp = [&](const float* plane) HWY_ATTR {
    const auto inRow = [&](const float* from) HWY_ATTR {
      const VF a = hn::GatherIndex(d, from, at);
      return MulThenAdd(hn::Sub(hn::GatherIndex(d, from + 1, at), a), right, a);
    };
    const VF upper = inRow(plane);
    return MulThenAdd(hn::Sub(inRow(plane + kLobeSteps), upper), down, upper);
  };
  const VF grazing = lookUp(table.grazing.data());
  const VF rest = hn::Mul(f90, grazing);
  return MulAdd3(f0, hn::Sub(lookUp(table.all.data()), grazing), {rest, rest, rest});
}

// The counterpart of mirroredShareOf().
HWY_INLINE VF MirroredShare(VF roughness) {
  const FloatTag d;
  const VF left = hn::Sub(hn::Set(d, kBlurredRoughness), roughness);
  const VF share = hn::Mul(left, hn::Set(d, 1 / (kBlurredRoughness - kMirroredRoughness)));
  return hn::Min(hn::Max(share, hn::Zero(d)), hn::Set(d, 1.0f));
}

// About a vector of unit normals.
class CosineLobes {
 public:
  HWY_INLINE explicit CosineLobes(const V3& normal) : z_(normal) {
    const FloatTag d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const MF useX = hn::Lt(hn::Abs(normal.x), hn::Set(d, kFrameAlongY));
    const V3 axis{hn::IfThenElseZero(useX, one), hn::IfThenElse(useX, zero, one), zero};
    x_ = NormalizeOr(Cross(normal, axis), axis);
    y_ = Cross(normal, x_);
  }

  HWY_INLINE V3 Direction(const UnitPoints& at) const {
    const FloatTag d;
    const VF turn = hn::Mul(at.u, hn::Set(d, 6.28318531f));
    const VF sine = hn::Sqrt(at.v), cosine = hn::Sqrt(hn::Sub(hn::Set(d, 1.0f), at.v));
    const VF x = hn::Mul(sine, hn::Cos(d, turn)), y = hn::Mul(sine, hn::Sin(d, turn));
    return Normalize3(MulAdd3(x_, x, MulAdd3(y_, y, Scale3(z_, cosine))));
  }

 private:
  V3 x_, y_, z_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
