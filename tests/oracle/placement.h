// Where transforms, one within the other, put what they hold, and where motions carry it.
#pragma once

#include <span>

#include "oracle/scene.h"

namespace oracle {

// All by the last of the transforms first.
Vec placed(Vec point, std::span<const Transform> transforms);
// Differences of points are not moved.
Vec placedDifference(Vec difference, std::span<const Transform> transforms);
// Normals go with the inverse transpose, which keeps them outside of what is mirrored.
Vec placedNormal(Vec n, std::span<const Transform> transforms);
bool areMirroring(std::span<const Transform> transforms);

// Where the motion has brought things at a time.
Transform placeAt(const Motion& motion, double time);
// The scene with camera and lights where they are at its time; bodies keep their motions.
Scene atItsTime(Scene scene);

}  // namespace oracle
