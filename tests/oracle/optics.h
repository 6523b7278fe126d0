// The formulas of surfaces and light, each from its source.
#pragma once

#include "oracle/scene.h"

namespace oracle {

// Mean of both polarizations (Fresnel's equations) for a ray that goes from index n1 to n2 at this
// cosine; 1 where reflection is total.
double fresnel(double n1, double n2, double cosine);
// Schlick's polynomial instead, in the cosine on the side of the lower index.
double fresnelBySchlick(double n1, double n2, double cosine);

// From a value at normal incidence to one at grazing incidence (Schlick 1994).
Color schlick(const Color& normal, const Color& grazing, double cosine);

Vec mirrored(const Vec& direction, const Vec& normal);
// By Snell's law; `normal` is on the ray's side. Not for total reflection.
Vec refracted(const Vec& direction, const Vec& normal, double n1, double n2);

// The glossy lobe, 1/sr: GGX of width roughness^2 (Walter et al. 2007) with height-correlated
// masking (Heitz 2014), Schlick's reflectance from `specular` to 1, less than that at grazing
// incidence where it is below 4 %.
Color glossyLobe(const Material& material, const Vec& normal, const Vec& toViewer,
                 const Vec& toLight);

// The same with a reflectance of 1.
double facetLobe(const Material& material, const Vec& normal, const Vec& toViewer,
                 const Vec& toLight);

// What facets between two indices of refraction let pass of light that comes from `toLight`, behind
// the surface, 1/sr: equation 21 of Walter et al. 2007 without 1 - F. n1 is the viewer's index, and
// the radiance is not scaled, as if light went from the viewer.
double transmittedLobe(const Material& material, double n1, double n2, const Vec& normal,
                       const Vec& toViewer, const Vec& toLight);
// The density of these directions if the facets are drawn from those that are seen: equation 17.
double transmittedDensity(const Material& material, double n1, double n2, const Vec& normal,
                          const Vec& toViewer, const Vec& toLight);

// Of its facets, which the viewer sees at this cosine.
Color lobeReflectance(const Material& material, double vh);

// The share of even light that the lobe reflects towards the viewer: an integral over its facets.
Color lobeAlbedo(const Material& material, double nv);

// The share of an unsampled lobe for which one mirrored ray stands, as the page has it.
double mirroredShare(const Material& material);

// The normals of the lobe's facets, 1/sr: D of Walter et al. 2007.
double facetsFacing(const Material& material, double nh);
// The share of them that a viewer at this cosine sees: Smith's G1.
double shareSeen(const Material& material, double nv);
// One of those that are seen, by a point of the unit square (Heitz 2018, "Sampling the GGX
// distribution of visible normals", appendix A).
Vec facetSeen(const Material& material, const Vec& normal, const Vec& toViewer, double u, double v);

// What arrives of a light at a point that faces it, and from where.
struct Arrival {
  Color irradiance;
  Vec toLight;  // unit
  double distance = INFINITY;
};
Arrival arrivalOf(const Light& light, const Vec& point);

// A light with a radius as a sphere that shines evenly: a point outside sees a cone of light.
class LightSphere {
 public:
  LightSphere(const Light& light, const Vec& point);

  // What arrives from a part of the cone, times how often that part goes into the cone. By points
  // of the unit square, evenly in the angle to the cone's axis, unlike whit's samples: these are
  // spread evenly over solid angle.
  struct Part {
    Arrival arrival;
    double ratio;  // of the density of such parts to that of whit's
  };
  Part partAt(double u, double v) const;

  // No sample of whit's brings more than this by the surface's diffuse reflection and its lobe; and
  // no part more than twice as much.
  double largestSample(const Material& material, const Vec& normal, const Vec& toViewer) const;

 private:
  const Light& light_;
  double distance_ = 0, widest_ = 0;  // angle to the axis
  Vec axis_;
};

Color skyAlong(const Sky& sky, const Vec& direction);
// Ambient radiance on a surface of this normal.
Color ambientAt(const Ambient& ambient, const Sky& sky, const Vec& normal);

// A direction about the normal, of density cosine / pi, by a point of the unit square: the square
// of the sine is even in [0, 1].
Vec cosineDirection(const Vec& normal, double u, double v);

// What a way of this length leaves of light (Beer and Lambert).
Color transmittance(const Color& absorption, double distance);

}  // namespace oracle
