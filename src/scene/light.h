// Lights, the sky, and the ambient light made from it.
#pragma once

#include <string>
#include <tuple>

#include "core/effects.h"
#include "core/vec3.h"
#include "scene/texture.h"

namespace whit {

// What arrives at a surface that faces the light, with nothing in between:
// - point, at distance d: intensity / max(d^2, radius^2). It is a sphere of this radius that shines
//   evenly in all directions; its center stands for it, unless --light-samples asks for more;
// - spot: the same within its cone, see SpotCone;
// - directional: `intensity`, everywhere.
struct Light {
  enum class Kind { point, spot, directional };

  std::string name;
  Vec3f position;          // of no meaning for a directional light
  Rgb intensity{1, 1, 1};  // radiant, W/sr per channel; of a directional light irradiance, W/m^2
  float radius = 0.01f;
  Kind kind = Kind::point;
  Vec3f direction{0, -1, 0};  // of spot and directional lights: where they shine, of any length
  // Of spot lights, degrees from the direction, 0 <= inner < outer <= 90.
  float innerConeAngle = 0, outerConeAngle = 45;
  std::string pointer{};  // as of a Material
};

// All of it that pictures depend on. The bindings name every member: one that is added does not
// compile before it is among them.
inline auto contentsOf(const Light& light) {
  const auto& [name, position, intensity, radius, kind, direction, inner, outer, pointer] = light;
  return std::tie(position, intensity, radius, kind, direction, inner, outer);
}

// The least radius there is: of a point.
inline constexpr float kPointRadius = 1.1e-18f;
// Whether it is more than a point, so that its shadows have penumbras.
inline bool hasExtent(const Light& light) {
  return light.kind != Light::Kind::directional && light.radius > kPointRadius;
}

// From `position` to the light: all the way, or a unit vector where the light is directional.
Vec3d towards(const Light& light, const Vec3d& position);

// How a spot light falls off between its cones (glTF's KHR_lights_punctual, "Inner and Outer Cone
// Angles"): s^2 with s = (cos(angle) - cosOuter) * scale, clamped to [0, 1].
struct SpotCone {
  Vec3d axis;  // unit
  double cosOuter = -1, scale = 1;

  double falloff(const Vec3d& unitToLight) const;
};
SpotCone coneOf(const Light& light);

struct Sky {
  enum class Kind { none, color, gradient, image };
  std::string name;  // where it has one: studio, or the image's file
  Kind kind = Kind::none;
  // gradient: linear in the sine of the elevation, horizon to zenith above, horizon to ground
  // below. color: `zenith` everywhere.
  Rgb zenith{0, 0, 0}, horizon{0, 0, 0}, ground{0, 0, 0};
  EnvironmentImage image;
  float scale = 1;  // multiplies all of the above
  // Degrees about +y, right-handed as Affine::rotation, image only: what the image has at -z is
  // seen towards -x after 90 degrees.
  float rotation = 0;
};

// Ambient light: irradiance / pi as a function of the normal's y alone,
// down + (up - down) * (1 + n.y) / 2.
struct Ambient {
  Rgb up{0, 0, 0}, down{0, 0, 0};
  double ofSky = 0;  // the strength by which ambientFromSky() made it; 0: given by itself
  // What is no further away than this holds off its share of the light; 0: nothing does. Frames
  // take --ambient-samples of it.
  float occlusion = 0;

  bool operator==(const Ambient&) const = default;
};

// As of a light.
inline auto contentsOf(const Ambient& ambient) {
  const auto& [up, down, ofSky, occlusion] = ambient;
  return std::tie(up, down, occlusion);
}

// Whether frames with these effects look for what holds it off.
inline bool isOccluded(const Ambient& ambient, EffectSet effects) {
  return effects.has(Effect::ambient) && effects.has(Effect::ambientOcclusion) &&
         ambient.occlusion > 0;
}

// What it is called: none, color, gradient, studio, or the name of its image's file.
std::string skyName(const Sky& sky);
// Radiance of the sky along the unit direction `d` (double precision; the kernels' oracle).
RgbD skyRadiance(const Sky& sky, const Vec3d& d);
// Cosine-weighted means of the sky over the upper and the lower hemisphere, times `strength`, in
// place of the light of `before`; what else that says stays.
Ambient ambientFromSky(const Sky& sky, double strength, Ambient before = {});

}  // namespace whit
