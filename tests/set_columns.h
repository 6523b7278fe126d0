// Writes vectors into columns of coordinates.
#pragma once

#include <cstddef>

#include "core/vec3.h"

namespace whit::test {

inline void setVector(float* x, float* y, float* z, std::size_t i, const Vec3f& v) {
  x[i] = v.x;
  y[i] = v.y;
  z[i] = v.z;
}

template <typename Columns>
void setRay(const Columns& rays, std::size_t i, const Vec3f& origin, const Vec3f& direction) {
  setVector(rays.orgX, rays.orgY, rays.orgZ, i, origin);
  setVector(rays.dirX, rays.dirY, rays.dirZ, i, direction);
}

}  // namespace whit::test
