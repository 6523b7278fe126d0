// Rays from the eye.
#pragma once

#include "reference/intersector.h"
#include "scene/camera.h"

namespace whit::reference {

// Through image position (x, y), in pixels from the top left; unit direction.
inline Ray generateRay(const CameraFrame& camera, double x, double y) {
  if (camera.orthographic) {
    const Vec3d aside =
        camera.right * (x - camera.width / 2.0) - camera.up * (y - camera.height / 2.0);
    return {camera.eye + aside, camera.forward, pixelCone(camera)};
  }
  const Vec3d through = camera.forward + camera.right * (x - camera.width / 2.0) -
                        camera.up * (y - camera.height / 2.0);
  return {camera.eye, normalized(through, camera.forward), pixelCone(camera)};
}

}  // namespace whit::reference
