// Where rays leave a surfel.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/shading_choices.h"
#include "reference/surfel.h"

namespace whit::reference {

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
