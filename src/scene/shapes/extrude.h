// Solids from a plan in the x-y plane pulled along z: walls, arches, vaults.
#pragma once

#include <array>
#include <vector>

#include "scene/mesh.h"

namespace whit::procedural {

using PlanPoint = std::array<double, 2>;
// Four corners, counter-clockwise. Cells meet edge to edge with equal coordinates: what only one
// cell has is the outline.
using PlanCell = std::array<PlanPoint, 4>;

// Closed solid from z0 to z1. Side faces whose directions differ by less than 35 degrees are
// smooth. `repeat` units of length a texture.
Mesh extrude(const std::vector<PlanCell>& plan, double z0, double z1, double repeat);

PlanCell rectangle(double x0, double y0, double x1, double y1);
// Cells of the half ring between two half ellipses over `center`.
std::vector<PlanCell> halfRing(PlanPoint center, PlanPoint innerRadii, PlanPoint outerRadii,
                               int segments);

}  // namespace whit::procedural
