// A classical column standing on y = 0: square plinth, moulded base, shaft with entasis and flutes,
// leafed bell and square abacus.
#pragma once

#include "scene/mesh.h"

namespace whit::procedural {

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
