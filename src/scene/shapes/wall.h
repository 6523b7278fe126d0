// Walls with rows of openings, in the x-y plane, centered on x = 0 and z = 0, standing on y = 0.
#pragma once

#include "scene/mesh.h"

namespace whit::procedural {

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

}  // namespace whit::procedural
