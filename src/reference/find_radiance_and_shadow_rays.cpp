#include "reference/find_radiance_and_shadow_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/add_impulses.h"
#include "reference/fresnel.h"
#include "reference/write_emitted_and_reflective_ambient.h"
#include "sampling/ggx_lobe.h"

namespace whit::reference {

namespace {

// Up to which occluders count, in lengths of the shadow ray.
double shadowReach(const Light& light) {
  if (light.kind == Light::Kind::directional) return kInfinity;
  return double{kShadowReach};
}

// The view of a light from a surfel: the vector to a point of it, and the area by which the
// intensity is divided for the biradiance that the whole light would bring from there.
struct LightView {
  Vec3d toPoint;
  double area = 1;
};

LightView viewOf(const Light& light, const Vec3d& position, const LightPoint& point) {
  const Vec3d toCenter = towards(light, position);
  if (light.kind == Light::Kind::directional) return {toCenter, 1};
  const double squared = dot(toCenter, toCenter), radius = light.radius;
  if (point.center || squared <= radius * radius) {
    return {toCenter, std::max(squared, radius * radius)};
  }
  const double distance = std::sqrt(squared), sine2 = radius * radius / squared;
  // 1 - cos of the cone that the sphere fills, without cancellation.
  const double height = sine2 / (1 + std::sqrt(1 - sine2));
  const double u = point.at.u, turn = 2 * std::numbers::pi * double{point.at.v};
  const double h = u * height, s = std::sqrt(h * (2 - h));
  const Vec3d z = toCenter / distance;
  const Vec3d axis = std::fabs(z.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d x = normalized(cross(z, axis)), y = cross(z, x);
  const Vec3d l = x * (s * std::cos(turn)) + y * (s * std::sin(turn)) + z * (1 - h);
  // The root of 1 - s^2 / sine2, likewise.
  const double inside = std::sqrt((1 - u) * (2 - height * (1 + u)) / (2 - height));
  return {l * (distance * (1 - h) - radius * inside), radius * radius / (2 * height)};
}

}  // namespace

RgbD glossyLobe(const Surfel& surfel, const Vec3d& toLight) {
  const Vec3d& n = surfel.shadingNormal;
  const Vec3d h = normalized(toLight + surfel.view, n);
  const double nl = dot(n, toLight), nh = dot(n, h), vh = dot(surfel.view, h);
  const double nv = std::max(dot(n, surfel.view), kLeastCosine);
  const double a2 = surfel.alpha * surfel.alpha;
  // nh^2 (a2 - 1) + 1, but next to the highlight of a narrow lobe the cosine alone loses it: to a
  // normal that is a unit vector in float only, for one.
  const Vec3d across = cross(n, h);
  const double spread = nh * nh * a2 + dot(across, across);
  const double distribution = a2 / (std::numbers::pi * spread * spread);
  const double visibility =
      0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
  const RgbD f0 = surfel.specular, f90(lobeGrazing(f0, surfel.grazingRatio));
  const RgbD fresnel = f0 + (f90 - f0) * schlickTerm(vh);
  return fresnel * (distribution * visibility);
}

LightArrival radianceFromLight(EffectSet effects, const Surfel& surfel, const Light& light,
                               const ShadingChoices& choices, const LightPoint& point) {
  LightArrival arrival;
  const bool directional = light.kind == Light::Kind::directional;
  if (directional && !effects.has(Effect::directionalLights)) return arrival;
  const auto [toLight, area] = viewOf(light, surfel.position, point);
  const double squaredDistance = dot(toLight, toLight);
  if (!(squaredDistance > 0)) return arrival;
  const double distance = std::sqrt(squaredDistance);
  const Vec3d l = toLight / distance;
  const double cosine = dot(surfel.shadingNormal, l);
  const bool isOffset = choices.terminator && !(surfel.shadowOffset == Vec3d{});
  // Above the facet, the smooth surface alone decides what lies behind the horizon.
  const bool front = isOffset || dot(surfel.geometricNormal, l) > 0;
  if (!(front && cosine > 0)) return arrival;

  RgbD biradiance(light.intensity);
  if (!directional) biradiance = biradiance / area;
  if (light.kind == Light::Kind::spot && effects.has(Effect::spotLights)) {
    biradiance *= coneOf(light).falloff(l);
  }
  RgbD reflected = surfel.diffuse / std::numbers::pi;
  if (effects.has(Effect::glossy) && maxComponent(surfel.specular) > 0) {
    reflected += glossyLobe(surfel, l) * surfel.underCoat;
  }
  arrival.radiance = reflected * biradiance * (cosine * surfel.coverage);
  Surfel start = surfel;
  if (isOffset) start.position += surfel.shadowOffset;
  const Vec3d origin = rayOrigin(choices.offset, start, 1);
  arrival.shadowRay = {origin,
                       point.center ? towards(light, origin) : surfel.position + toLight - origin};
  arrival.tFar = shadowReach(light);
  return arrival;
}

LightArrival arrivalFromLight(const Scene& scene, EffectSet effects, const Surfel& surfel,
                              const Light& light, const ShadingChoices& choices,
                              const LightPoint& point) {
  LightArrival arrival = radianceFromLight(effects, surfel, light, choices, point);
  if (effects.has(Effect::fog)) {
    const Vec3d way = arrival.shadowRay.origin + arrival.shadowRay.direction - surfel.position;
    arrival.radiance = arrival.radiance * leftOfLight(scene.fog, light, way);
  }
  return arrival;
}

LightArrival ambientArrival(const Scene& scene, EffectSet effects, const Surfel& surfel,
                            const ShadingChoices& choices, const UnitPoint& at) {
  const Vec3d direction = cosineDirection(surfel.shadingNormal, at);
  const bool isOffset = choices.terminator && !(surfel.shadowOffset == Vec3d{});
  if (!isOffset && !(dot(surfel.geometricNormal, direction) > 0)) return {};
  Surfel start = surfel;
  if (isOffset) start.position += surfel.shadowOffset;
  return {reflectedAmbient(scene, effects, surfel) * surfel.coverage,
          {rayOrigin(choices.offset, start, 1), direction},
          double{scene.ambient.occlusion}};
}

LightArrival arrivalAt(const World& world, const Chunk& chunk, std::size_t slot) {
  if (chunk.lightIsAmbient()) {
    const LobeSampling sampling =
        lightSampling(chunk.depth, chunk.lightSamples, chunk.sampleNumber);
    return ambientArrival(
        world.scene, world.effects, surfelOf(chunk, slot), chunk.options().shading,
        lightPoint(chunk.rays.path[slot], sampling, kAmbientLight, chunk.lightSample));
  }
  LightPoint point;
  if (chunk.lightSamples > 1) {
    const LobeSampling sampling =
        lightSampling(chunk.depth, chunk.lightSamples, chunk.sampleNumber);
    point = {false,
             lightPoint(chunk.rays.path[slot], sampling, chunk.lightNumber, chunk.lightSample)};
  }
  Surfel surfel = surfelOf(chunk, slot);
  const Material& material = world.scene.materials[surfel.material];
  surfel.grazingRatio = double{material.grazingRatio};
  surfel.underCoat = underCoat(material, world.effects, surfel);
  return arrivalFromLight(world.scene, world.effects, surfel, *chunk.light, chunk.options().shading,
                          point);
}

std::optional<UnshadowedRow> findRadiance(const World& world, const Chunk& chunk,
                                          std::size_t slot) {
  const LightArrival arrival = arrivalAt(world, chunk, slot);
  if (!(maxComponent(arrival.radiance) > 0)) return std::nullopt;
  UnshadowedRow row;
  row.rgb = arrival.radiance / chunk.lightSamples;
  // Shadow rays have yet to find out.
  row.visible = chunk.tracesShadows() ? 0 : 1;
  return row;
}

std::optional<ShadowRow> findShadowRay(const World& world, const Chunk& chunk,
                                       std::size_t shadowRay) {
  const std::uint32_t slot = chunk.shadows.slot[shadowRay];
  const LightArrival arrival = arrivalAt(world, chunk, slot);
  if (!(maxComponent(arrival.radiance) > 0)) return std::nullopt;
  ShadowRow row;
  row.org = arrival.shadowRay.origin;
  row.dir = arrival.shadowRay.direction;
  row.tFar = arrival.tFar;
  row.slot = slot;
  return row;
}

}  // namespace whit::reference
