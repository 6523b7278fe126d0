#include "reference/impulses.h"

#include <algorithm>

#include "reference/fresnel.h"
#include "reference/ray_origin.h"

namespace whit::reference {

namespace {

Ray reflectedRay(const Surfel& s, const ShadingChoices& choices) {
  const Vec3d mirrored = reflect(-s.view, s.shadingNormal),
              origin = rayOrigin(choices.offset, s, 1);
  if (!choices.bend) return {origin, mirrored, s.cone};
  return {origin, lifted(mirrored, s.geometricNormal, smallestElevation(s)), s.cone};
}

Ray refractedRay(const Surfel& s, const Interface& interface, double c,
                 const ShadingChoices& choices) {
  const Vec3d d = -s.view, origin = rayOrigin(choices.offset, s, -1);
  if (interface.k == 0) return {origin, d, s.cone};
  const Vec3d bent = refract(interface, d, s.shadingNormal, c);
  if (!choices.bend) return {origin, bent, s.cone};
  // Under the geometric normal the ray would leave this steeply, if at all; normals that agree
  // change nothing.
  const double facing = dot(s.view, s.geometricNormal);
  const double g2 = interface.k + facing * facing;
  const double steepness = g2 > 0 ? std::sqrt(g2) / interface.eta : 1;
  return {origin, lifted(bent, -s.geometricNormal, std::min(0.9 * steepness, 0.01)), s.cone};
}

// The mirror coat's reflectance.
RgbD coatReflectance(const Material& material, double c) {
  const RgbD normal(material.mirror), grazing(material.mirrorGrazing);
  return normal + (grazing - normal) * schlickTerm(c);
}

}  // namespace

double smallestElevation(const Surfel& surfel) {
  return std::min(0.9 * dot(surfel.view, surfel.geometricNormal), 0.01);
}

Vec3d lifted(const Vec3d& r, const Vec3d& normal, double elevation) {
  const double own = dot(r, normal);
  return own < elevation ? normalized(r + normal * (elevation - own)) : r;
}

Impulses findImpulses(const Scene& scene, EffectSet effects, const Surfel& surfel,
                      const Crossing& crossing, MediaStack stack, const ShadingChoices& choices) {
  Impulses result;
  if (crossing.hidden) {
    result.refracted = {RgbD(1.0),
                        {rayOrigin(choices.offset, surfel, -1), -surfel.view, surfel.cone},
                        crossing.stackBehind};
    return result;
  }
  const Material& material = scene.materials[surfel.material];
  const double c = std::clamp(dot(surfel.view, surfel.shadingNormal), 0.0, 1.0);
  RgbD reflectance;
  if (effects.has(Effect::mirror)) reflectance = coatReflectance(material, c);
  if (crossing.dielectric) {
    const Interface interface = makeInterface(crossing.n1, crossing.n2, c, choices.fresnel);
    if (effects.has(Effect::mirror)) reflectance += RgbD(interface.reflectance);
    if (interface.reflectance < 1) {
      result.refracted = {RgbD(material.transmission) * (1 - interface.reflectance),
                          refractedRay(surfel, interface, c, choices), crossing.stackBehind};
    }
  }
  if (maxComponent(reflectance) > 0) {
    result.reflected = {reflectance, reflectedRay(surfel, choices), stack};
  }
  return result;
}

}  // namespace whit::reference
