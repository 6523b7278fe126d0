// Parts of buildings: solids from a plan, walls, columns.
#pragma once

#include <array>
#include <vector>

#include "scene/mesh.h"

namespace whit::procedural {

// extrude.cpp: solids from a plan in the x-y plane pulled along z.
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

// wall.cpp: walls with rows of openings, in the x-y plane, centered on x = 0 and z = 0, standing on
// y = 0.
struct WallPlan {
  double spacing = 3;  // width of a bay
  int bays = 1;        // openings, one in the middle of each bay
  double height = 4, depth = 0.3;
  double margin = 0;  // more wall at both ends
  double openingWidth = 1.2;
  double sill = 0;    // height of the opening's lower edge, 0: a door
  double spring = 2;  // where the arch begins
  double rise = 0.6;  // height of the arch above the spring, 0: a straight lintel
  int segments = 24;  // of an arch
  double uvRepeat = 1;
};

Mesh buildWall(const WallPlan& plan);

// column.cpp: a classical column standing on y = 0: square plinth, moulded base, shaft with entasis
// and flutes, leafed bell and square abacus.
struct ColumnPlan {
  double radius = 0.3;  // of the shaft at its foot
  double height = 4;    // with base and capital
  int flutes = 0;       // 0: a smooth shaft
  int segments = 48;    // around; rounded up to a multiple of 4 a flute
  int rings = 16;       // along the shaft
  double taper = 0.14;  // how much thinner the shaft is at the top, in parts of the radius
  int leaves = 8;       // leaves in each of the capital's two rows, 0: a plain bell
  double uvRepeat = 1;
};

struct ColumnMeshes {
  Mesh shaft, trim;
};

ColumnMeshes buildColumn(const ColumnPlan& plan);

// Half the abacus' side in parts of the radius: what a wall above may rest on.
inline constexpr double kAbacusHalf = 1.5;

}  // namespace whit::procedural
