// Scenes of a few polygons, and rays through them.
#pragma once

#include "brute_force.h"
#include "pi.h"
#include "reference/reference.h"
#include "verify/scene_builder.h"

namespace whit::test {

using namespace verify;

// Returns a direction downwards, at an angle to the vertical.
inline Vec3d steep(double degrees) {
  const double angle = degrees * kPi / 180;
  return {std::sin(angle), -std::cos(angle), 0};
}

inline Light sun(const Vec3f& direction, float irradiance) {
  Light light;
  light.kind = Light::Kind::directional;
  light.direction = direction;
  light.intensity = Rgb(irradiance);
  return light;
}

// Returns a light of intensity 8, 2 above the origin, that shines down: fully up to the inner angle
// to the vertical, and not beyond the outer one.
inline Light spotOf(float inner, float outer) {
  Light light = lightAt({0, 2, 0}, 8);
  light.kind = Light::Kind::spot;
  light.innerConeAngle = inner;
  light.outerConeAngle = outer;
  return light;
}

// Returns a material that has a diffuse color below a lobe of this reflectance.
inline Material glossyMaterial(float albedo, float f0, float roughness) {
  Material m = diffuseMaterial(albedo);
  m.specular = Rgb(f0);
  m.roughness = roughness;
  return m;
}

// Gives the scene a sky that has radiance 1 above and is black below.
inline void whiteAbove(SceneBuilder& builder) {
  builder.description.sky.kind = Sky::Kind::gradient;
  builder.description.sky.zenith = Rgb(1.0f);
}

// Gives the scene ambient light that is the same from all sides.
inline void lightEvenly(SceneBuilder& builder, float radiance) {
  builder.description.ambient = {Rgb(radiance), Rgb(radiance)};
}

// Returns settings of depth 8 without a cutoff, so that all contributions count.
inline reference::Settings uncut(int depth = 8) {
  reference::Settings settings;
  settings.options.depth = depth;
  settings.options.cutoff = 0;
  return settings;
}

// Likewise with so many rays for the lobes of the first surface.
inline reference::Settings sampled(int glossy, int depth = 8) {
  reference::Settings settings = uncut(depth);
  settings.options.glossy = glossy;
  return settings;
}

inline EffectSet allBut(Effect effect) { return EffectSet::all().without(effect); }

// Returns the settings without an effect.
inline reference::Settings without(Effect effect, reference::Settings settings = uncut()) {
  settings.effects = settings.effects.without(effect);
  return settings;
}

// Returns the builder of a floor at height 0, 2 * half wide.
inline SceneBuilder withFloor(const Material& material, float half = 1) {
  SceneBuilder builder;
  builder.add(floorAt(0, half), material);
  return builder;
}

// Returns the same floor under a sky of one radiance, or lit by lights.
inline Scene floorUnderSky(const Material& material, float radiance = 1, float half = 1000) {
  SceneBuilder builder = withFloor(material, half);
  builder.sky(radiance);
  return builder.build();
}
inline Scene litFloor(const Material& material, const std::vector<Light>& lights,
                      float half = 100) {
  SceneBuilder builder = withFloor(material, half);
  builder.description.lights = lights;
  return builder.build();
}

// Returns the radiance that the reference computes along a ray by brute force. `direction` has any
// length.
inline RgbD radianceAlong(const Scene& scene, const Vec3d& origin, const Vec3d& direction,
                          const reference::Settings& settings = uncut(),
                          reference::RayCounts* counts = nullptr) {
  const BruteForce bruteForce(scene, settings.effects);
  const reference::Tracer tracer(scene, bruteForce, settings);
  reference::RayCounts own;
  return tracer.traceImpulse({origin, normalized(direction)}, 0, 1.0, 0, counts ? *counts : own);
}

// Likewise straight down.
inline RgbD radianceBelow(const Scene& scene, const Vec3d& eye = {0, 1, 0},
                          const reference::Settings& settings = uncut(),
                          reference::RayCounts* counts = nullptr) {
  return radianceAlong(scene, eye, {0, -1, 0}, settings, counts);
}

}  // namespace whit::test
