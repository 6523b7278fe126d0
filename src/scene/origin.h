// Scenes far from the origin are moved to it, because single precision would round their shapes.
#pragma once

#include "core/vec3.h"

namespace whit {

// A scene is far along an axis if its middle is more than kFarOverSize times its diagonal away from
// the origin there. Nearer ones would gain fewer than six bits of their coordinates. At this
// distance coordinates are rounded to 2^-19 of the diagonal, a sixth of a pixel in the widest
// picture that shows all of the scene (65536).
inline constexpr double kFarOverSize = 32;

// Returns what to subtract from the coordinates of a scene in this box, in double precision: its
// middle along the axes where it is far, else zero. The middle is rounded to a power of two below a
// quarter of the diagonal, so that it is a short number and subtracting it is exact for coordinates
// in single precision. Heights above the sea stay as they are in surveyed coordinates.
Vec3d originOf(const BoxOf<Vec3d>& box);

}  // namespace whit
