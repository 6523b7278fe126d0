// Guesses which axis is up in a model whose file does not say so.
#pragma once

#include "io/scene/scene_layout.h"

namespace whit {

// True if z seems to be up in the model, which has y up otherwise. Two things are signs of it:
// - The model stands on the plane z = 0: its lower end lies there, it is at least half as high as
//   wide, and it extends to both sides of y = 0.
// - The model has a base: z is its longest extent, flat parts at the lower end of z fill a share of
//   the box's side, and hardly any lie at the upper end of z and at both ends of y.
// Boards speak against both: flat parts that face y and lie between the ends of y, if their area
// exceeds that of such parts along the other axes. They are shelves on a wall, which stands in the
// plane z = 0.
bool seemsZUp(const Body& content);

}  // namespace whit
