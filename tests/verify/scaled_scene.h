// Scenes at other scales, whose pictures have the same bits.
#pragma once

#include <cmath>

#include "scene/description.h"

namespace whit::verify {

inline Vec3f scaled(const Vec3f& v, int k) {
  return {std::ldexp(v.x, k), std::ldexp(v.y, k), std::ldexp(v.z, k)};
}

// Multiplies lengths by 2^k and intensities by 4^k, so that irradiance stays the same.
inline SceneDescription scaled(SceneDescription d, int k) {
  const double factor = std::ldexp(1.0, k);
  for (Object& object : d.objects) {
    for (Mesh& mesh : object.meshes) {
      for (Vec3f& p : mesh.positions) p = scaled(p, k);
      for (Affine& s : mesh.spheres) s = Affine::scaling(Vec3d(factor)) * s;
    }
  }

  for (Instance& instance : d.instances) instance.toWorld.p *= factor;
  for (Light& light : d.lights) {
    light.position = scaled(light.position, k);
    light.intensity = scaled(light.intensity, 2 * k);
    light.radius = std::ldexp(light.radius, k);
  }

  for (Camera& camera : d.cameras) {
    camera.eye = scaled(camera.eye, k);
    camera.at = scaled(camera.at, k);
    for (float Camera::*length :
         {&Camera::orthographicHeight, &Camera::aperture, &Camera::focus, &Camera::eyeDistance}) {
      camera.*length = std::ldexp(camera.*length, k);
    }
  }

  // Absorption is a rate per length.
  for (Material& m : d.materials) m.absorption = scaled(m.absorption, -k);
  d.fog.density = scaled(d.fog.density, -k);
  return d;
}

}  // namespace whit::verify
