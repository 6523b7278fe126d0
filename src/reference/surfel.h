// A surfel: a point of a surface with all that shading needs to know about it, and where rays leave
// it.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/shading_choices.h"
#include "core/vec3.h"
#include "scene/camera.h"

namespace whit::reference {

inline constexpr double kUnitRoundOff = 0x1p-24;  // of float

struct Surfel {
  Vec3d position;
  Vec3d view;             // unit, back along the ray
  Vec3d geometricNormal;  // unit, the triangle's, on the viewer's side
  Vec3d shadingNormal;    // unit, interpolated and bent by the normal map; see makeSurfel
  Vec3d lift;             // from the facet to the surface its vertex normals stand for
  double offset = 0;      // how far along the geometric normal a new ray must start
  double retreat = 0;     // on the viewer's side, how far along `view` as well
  bool entering = false;  // the ray met the outside, where corners run counter-clockwise
  std::uint32_t material = 0;
  RgbD diffuse, specular;   // textures and vertex colors applied
  RgbD emission{1, 1, 1};   // what they multiply the material's by
  double alpha = 1;         // width of the glossy lobe (GGX), roughness squared
  double coverage = 1;      // the share of the surface that is there
  RgbD aboveLobe{1, 1, 1};  // what mirror and interface leave for the samples of the lobe
  RgbD belowLobe{1, 1, 1};  // what these leave for transmission and diffuse color
  RayCone cone;             // of rays that go on from here
};

// One coordinate, moved towards `direction`.
inline double moved(double coordinate, double direction) {
  constexpr float kNearOrigin = 1.0f / 32, kStepThere = 1.0f / 65536, kUlps = 256;
  const auto p = static_cast<float>(coordinate), n = static_cast<float>(direction);
  if (std::fabs(p) < kNearOrigin) return p + kStepThere * n;
  const auto ulps = static_cast<std::int32_t>(kUlps * n);
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(p) + (p < 0 ? -ulps : ulps));
}

// `side` is 1 for the viewer's side of the surface, -1 for the other. Waechter and Binder's method
// is one on the bits of floats: the position is rounded to float for it.
inline Vec3d rayOrigin(OffsetMethod method, const Surfel& surfel, double side) {
  const Vec3d n = surfel.geometricNormal * side, p = surfel.position;
  switch (method) {
    case OffsetMethod::wachterBinder:
      return {moved(p.x, n.x), moved(p.y, n.y), moved(p.z, n.z)};
    case OffsetMethod::fixed:
      return p + n * double{kFixedOffset};
    case OffsetMethod::bound:
      break;
  }
  const Vec3d back = side > 0 ? surfel.view * surfel.retreat : Vec3d{};
  return p + n * surfel.offset + back;
}

}  // namespace whit::reference
