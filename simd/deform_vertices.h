// Morph targets and skins in double, operation for operation as deformVertices() in
// scene/motion.h computes them: the same bits.
#pragma once

#include "scene/motion.h"

namespace whit::simd {

// With the kernels of the chosen target.
DeformedVertices deformVertices(const Deformation& deformation, const DeformationPose& pose);

}  // namespace whit::simd
