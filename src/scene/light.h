// Lights, the sky, and the ambient light made from it.
#pragma once

#include <cmath>
#include <string>

#include "core/effects.h"
#include "core/vec3.h"
#include "scene/texture.h"

namespace whit {

// Irradiance of a surface that faces the light, without occlusion:
// - point, at distance d: intensity / max(d^2, radius^2). It is a sphere of this radius that shines
//   evenly in all directions; its center stands for it, unless --light-samples asks for more;
// - spot: the same within its cone, see SpotCone;
// - directional: `intensity`, everywhere.
// Members are listed in scene/members.h.
struct Light {
  enum class Kind { point, spot, directional };

  std::string name;
  Vec3f position;          // unused by directional lights
  Rgb intensity{1, 1, 1};  // radiant, W/sr per channel; of a directional light irradiance, W/m^2
  float radius = 0.01f;
  Kind kind = Kind::point;
  Vec3f direction{0, -1, 0};  // spot and directional lights shine along it; of any length
  // Degrees from the direction of a spot light, inner < outer.
  float innerConeAngle = 0, outerConeAngle = 45;
  std::string pointer{};  // see Material
};

inline constexpr double kLeastConeAngle = 0.5, kLargestConeAngle = 90;

// Lights up to this radius are points.
inline constexpr float kPointRadius = 1.1e-18f;
// The light is more than a point, so that its shadows have penumbras.
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

// Members are listed in scene/members.h.
struct Sky {
  enum class Kind { none, color, gradient, image };
  std::string name;  // studio, the whole path of the image's file, or empty
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
  double ofSky = 0;  // strength that ambientFromSky() was called with; 0: it was not
  // Radius of ambient occlusion; 0: none. Frames take --ambient-samples of it.
  float occlusion = 0;
  // The share of the sky that rough surfaces reflect, blurred, in frames without --glossy samples.
  float reflection = 1;

  bool operator==(const Ambient&) const = default;
};

// Homogeneous fog of the air, which is all that lies outside of dielectrics. Of the radiance behind
// a way of length t it leaves exp(-density t), and adds `color` times the rest.
struct Fog {
  Rgb density{0, 0, 0};  // per unit length
  Rgb color{0, 0, 0};    // radiance that the fog scatters towards the viewer, however deep it is
};

// Fog of this optical depth hides what is behind it from any float. Rays that leave the scene pass
// through as much, so that no factor becomes 0 or infinite.
inline constexpr float kOpaqueFog = 40;

// Beer's law: what fog leaves of each channel, after any distance.
inline RgbD leftBy(const Fog& fog, double distance) {
  const auto channel = [&](double sigma) { return sigma > 0 ? std::exp(-sigma * distance) : 1.0; };
  return {channel(fog.density.x), channel(fog.density.y), channel(fog.density.z)};
}
// The same of a light at the end of `way`. A directional light is what arrives.
inline RgbD leftOfLight(const Fog& fog, const Light& light, const Vec3d& way) {
  if (light.kind == Light::Kind::directional) return RgbD(1.0);
  return leftBy(fog, std::sqrt(dot(way, way)));
}

// Frames with these effects trace rays for ambient occlusion.
inline bool isOccluded(const Ambient& ambient, EffectSet effects) {
  return effects.has(Effect::ambientOcclusion) && ambient.occlusion > 0;
}

// none, color, gradient, studio, or the name of the image's file.
std::string skyName(const Sky& sky);
// Radiance of the sky along the unit direction `d` (double precision; the kernels' oracle).
RgbD skyRadiance(const Sky& sky, const Vec3d& d);
// The sky as GGX lobes see it that look straight along a direction: of roughness 0, 0.2, ... 1, one
// image of kBlurRows rows below the other, without Sky::scale and Sky::rotation.
inline constexpr int kSkyBlurs = 6, kBlurRows = 32;
EnvironmentImage blurredSky(const Sky& sky);
// Radiance of the blurred sky along the unit direction `d`, linear in the roughness from 0 to 1.
RgbD blurredRadiance(const Sky& sky, const EnvironmentImage& blurred, const Vec3d& d,
                     double roughness);
// Replaces the light of `before` by the cosine-weighted means of the sky over the upper and the
// lower hemisphere, times `strength`; the other members of `before` stay.
Ambient ambientFromSky(const Sky& sky, double strength, Ambient before = {});

}  // namespace whit
