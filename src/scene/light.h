// Point lights, the sky, and the ambient light made from it.
#pragma once

#include <memory>
#include <string>

#include "core/vec3.h"
#include "scene/texture.h"

namespace whit {

// Biradiance at distance d: intensity / max(d^2, radius^2); `radius` only bounds it near the light.
struct PointLight {
  std::string name;
  Vec3f position;
  Rgb intensity{1, 1, 1};  // radiant intensity, W/sr per channel
  float radius = 0.01f;
  std::string pointer;  // as of a Material
};

struct Sky {
  enum class Kind { none, colour, gradient, image };
  Kind kind = Kind::none;
  // gradient: linear in the sine of the elevation, horizon to zenith above, horizon to ground
  // below. colour: `zenith` everywhere.
  Rgb zenith{0, 0, 0}, horizon{0, 0, 0}, ground{0, 0, 0};
  EnvironmentImage image;
  float scale = 1;  // multiplies all of the above
  // Degrees about +y, right-handed as Affine::rotation, image only: what the image has at -z is
  // seen towards -x after 90 degrees.
  float rotation = 0;
};

// Constant-time ambient: irradiance / pi as a function of the normal's y alone,
// down + (up - down) * (1 + n.y) / 2.
struct Ambient {
  Rgb up{0, 0, 0}, down{0, 0, 0};
};

// Radiance of the sky along the unit direction `d` (double precision; the kernels' oracle).
RgbD skyRadiance(const Sky& sky, const Vec3d& d);
// Cosine-weighted means of the sky over the upper and the lower hemisphere, times `strength`.
Ambient ambientFromSky(const Sky& sky, double strength);

}  // namespace whit
