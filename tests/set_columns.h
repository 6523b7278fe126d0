// Writes rays into columns.
#pragma once

#include <cstddef>

#include "core/vec3.h"

namespace whit::test {

template <typename Columns>
void setRay(const Columns& rays, std::size_t i, const Vec3f& origin, const Vec3f& direction) {
  rays.org.set(i, origin);
  rays.dir.set(i, direction);
}

}  // namespace whit::test
