// A surfel: a point of a surface with all that shading needs to know about it.
#pragma once

#include <cstdint>

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

}  // namespace whit::reference
