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
  const VF normal = Div(Sub(iorBehind, iorBefore), Add(iorBehind, iorBefore));
  const VF f0 = Mul(normal, normal);
  const VF refracted = Mul(g, Div(iorBefore, iorBehind));
  const VF cosine = IfThenElse(Lt(iorBehind, iorBefore), refracted, c);
  return MulThenAdd(Sub(Set(1.0f), f0), SchlickTerm(cosine), f0);
}

// c: cosine between the viewer and the normal, in [0, 1].
HWY_INLINE Interface DielectricInterface(FresnelModel model, VF iorBefore, VF iorBehind, VF c) {
  const VF zero = Zero(), one = Set(1.0f);
  const VF eta = Div(iorBehind, iorBefore);
  // eta^2 - 1, factored over the iors themselves.
  const VF k =
      Div(Mul(Sub(iorBehind, iorBefore), Add(iorBehind, iorBefore)), Mul(iorBefore, iorBefore));
  const VF g2 = MulThenAdd(c, c, k);
  const MF straight = Eq(k, zero);
  const MF total = Or(Le(g2, zero), Le(c, zero));
  const VF g = Sqrt(Max(g2, zero));
  const VF sum = Max(Add(c, g), Set(1e-30f));
  const VF bend = Div(k, sum);
  const VF rs = Div(bend, sum);
  const VF etaSquaredC = Mul(Mul(eta, eta), c);
  const VF rp = Div(Mul(k, Sub(c, Div(one, sum))), Max(Add(etaSquaredC, g), Set(1e-30f)));
  VF f = Mul(Set(0.5f), MulThenAdd(rs, rs, Mul(rp, rp)));
  if (model == FresnelModel::schlick) f = SchlickReflectance(iorBefore, iorBehind, c, g);
  f = IfThenElse(total, one, Min(f, one));
  f = IfThenElse(straight, zero, f);
  return {f, eta, k, bend, straight};
}

// The reflectance of the lobes at grazing incidence, with the reflectance `f0` at normal incidence.
HWY_INLINE VF LobeGrazing(const ShadingTables& tables, const SurfelColumns& surfels, const V3& f0,
                          size_t i) {
  VF ratio = Set(kGrazingRatio);
  if (HWY_UNLIKELY(!tables.grazingRatios.empty())) {
    const VI material = MaterialNumbers(surfels, i);
    ratio = GatherMember<0>(std::span(tables.grazingRatios), material);
  }
  return Min(Set(1.0f), Mul(ratio, MaxComponent(f0)));
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
  const VF zero = Zero(), one = Set(1.0f);
  GlossyLobes lobes;
  lobes.view = Neg3(direction);
  lobes.z = ns;
  const VF towards = Dot(ns, lobes.view);
  const V3 along = MulAdd3(ns, Neg(towards), lobes.view);
  const VF sine = Sqrt(Dot(along, along));
  // If the view is close to the normal, rounding loses the plane of incidence, and any other plane
  // serves.
  const MF oblique = Gt(sine, Set(0.01f));
  const V3 across = UnitAcross(ns, 0.5f);
  const VF scale = Div(one, IfThenElse(oblique, sine, one));
  lobes.x = Select3(oblique, Scale3(along, scale), across);
  lobes.y = Cross(ns, lobes.x);
  lobes.f0 = Load3(surfels.specular, i);
  lobes.f90 = LobeGrazing(tables, surfels, lobes.f0, i);
  const VF alpha = Load(surfels.alpha, i);
  lobes.rough = AndNot(flat, Gt(alpha, Set(kSmoothAlpha)));
  lobes.alpha = IfThenElseZero(lobes.rough, alpha);
  lobes.nv = Max(towards, Set(static_cast<float>(kLeastCosine)));
  const V3 seen = Normalize3({Mul(sine, lobes.alpha), zero, lobes.nv});
  lobes.seenX = seen.x;
  lobes.seenZ = seen.z;
  return lobes;
}

// A normal that can be seen, in the world.
HWY_INLINE V3 VisibleNormal(const GlossyLobes& lobes, const UnitPoints& at) {
  const FloatTag d;
  const VF one = Set(1.0f);
  const VF height = Add(one, lobes.seenZ);
  const VF fall = Mul(at.v, height);
  const VF squared = Mul(fall, Sub(Set(2.0f), fall));
  const VF radius = Mul(Sqrt(Max(squared, Zero())), lobes.alpha);
  const VF turn = Mul(at.u, Set(6.28318531f));
  const VF x = MulThenAdd(lobes.seenX, lobes.alpha, Mul(radius, hn::Cos(d, turn)));
  const VF y = Mul(radius, hn::Sin(d, turn));
  const VF z = Mul(Sub(one, at.v), height);
  return NormalizeOr(MulAdd3(lobes.x, x, MulAdd3(lobes.y, y, Scale3(lobes.z, z))), lobes.z);
}

struct LobeSample {
  V3 direction, weight;
  // Cosine between direction and shading normal. Unless it is above 0, the ray ends in the surface.
  VF cosine;
};

// facetAt() of the scalar reference, with the reflectance of a lobe.
struct Facet {
  V3 normal;
  VF cosine;     // cosine between viewer and facet, in [0, 1]
  V3 mirrored;   // the view
  VF elevation;  // sine of its elevation over the surface
  V3 reflectance;
};

HWY_INLINE Facet FacetAt(const GlossyLobes& lobes, const UnitPoints& at) {
  const V3 h = VisibleNormal(lobes, at);
  const VF vh = Dot(lobes.view, h), cosine = Clamped01(vh);
  const V3 l = Normalize3(Sub3(Scale3(h, Add(vh, vh)), lobes.view));
  const VF f90 = lobes.f90;
  return {h, cosine, l, Dot(lobes.z, l), SchlickColor(lobes.f0, {f90, f90, f90}, cosine)};
}

// passingShare().
HWY_INLINE VF PassingShare(const GlossyLobes& lobes, VF nl) {
  const VF one = Set(1.0f), nv = lobes.nv;
  const VF a2 = Mul(lobes.alpha, lobes.alpha), rest = Sub(one, a2);
  const VF maskV = Sqrt(MulThenAdd(Mul(nv, nv), rest, a2));
  const VF maskL = Sqrt(MulThenAdd(Mul(nl, nl), rest, a2));
  return Div(Mul(nl, Add(nv, maskV)), MulThenAdd(nl, maskV, Mul(nv, maskL)));
}

// seenShare().
HWY_INLINE VF SeenShare(VF cosine, VF alpha) {
  const VF a2 = Mul(alpha, alpha), rest = Sub(Set(1.0f), a2);
  const VF mask = Sqrt(MulThenAdd(Mul(cosine, cosine), rest, a2));
  return Div(Add(cosine, cosine), Add(cosine, mask));
}

// The counterpart of lobeAlbedo(), in the lanes of `live`.
HWY_INLINE V3 LobeAlbedo(const LobeTable& table, const V3& f0, VF f90, VF cosine, VF roughness,
                         MF live) {
  const FloatTag d;
  const IntTag di;
  const VF last = Set(kLobeSteps - 1.0f), most = Set(kLobeSteps - 2.0f);
  const VF row = Mul(roughness, last), column = Mul(Sqrt(cosine), last);
  const VF top = Min(Floor(row), most), left = Min(Floor(column), most);
  const VF down = Sub(row, top), right = Sub(column, left);
  const VF first = IfThenElseZero(live, MulThenAdd(top, Set(float{kLobeSteps}), left));
  // Its three neighbors, to the right and below, are read as well.
  const VI at = Clamped(ConvertTo(di, first), kLobeSteps * (kLobeSteps - 1) - 1);
  const auto lookUp = [&](const float* plane) HWY_ATTR {
    const auto inRow = [&](const float* from) HWY_ATTR {
      const VF a = GatherIndex(d, from, at);
      return MulThenAdd(Sub(GatherIndex(d, from + 1, at), a), right, a);
    };
    const VF upper = inRow(plane);
    return MulThenAdd(Sub(inRow(plane + kLobeSteps), upper), down, upper);
  };
  const VF grazing = lookUp(table.grazing.data());
  const VF rest = Mul(f90, grazing);
  return MulAdd3(f0, Sub(lookUp(table.all.data()), grazing), {rest, rest, rest});
}

// The counterpart of mirroredShareOf().
HWY_INLINE VF MirroredShare(VF roughness) {
  const VF left = Sub(Set(kBlurredRoughness), roughness);
  const VF share = Mul(left, Set(1 / (kBlurredRoughness - kMirroredRoughness)));
  return Clamped01(share);
}

// Directions drawn by their cosine to a unit normal, one normal for each lane.
class CosineLobes {
 public:
  HWY_INLINE explicit CosineLobes(const V3& normal) : z_(normal) {
    x_ = UnitAcross(normal, kFrameAlongY);
    y_ = Cross(normal, x_);
  }

  HWY_INLINE V3 Direction(const UnitPoints& at) const {
    const FloatTag d;
    const VF turn = Mul(at.u, Set(6.28318531f));
    const VF sine = Sqrt(at.v), cosine = Sqrt(Sub(Set(1.0f), at.v));
    const VF x = Mul(sine, hn::Cos(d, turn)), y = Mul(sine, hn::Sin(d, turn));
    return Normalize3(MulAdd3(x_, x, MulAdd3(y_, y, Scale3(z_, cosine))));
  }

 private:
  V3 x_, y_, z_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
