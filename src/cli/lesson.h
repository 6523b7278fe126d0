// The columns of the tile around one pixel as the stages of a frame fill them, for the page that
// whit explain --html writes.
#pragma once

#include "output/json_report.h"
#include "render/renderer.h"

namespace whit::cli {

// Renders the pixels of `tile` and returns what each stage has written at depth 0 of the first
// sample, in the order of the stages, in the chunk that holds pixel x,y. A step of the list has
// `stage`, the `light` if it is about one, and `columns`: name, whether the values are whole
// numbers, and the values of all pixels, row by row, as 32-bit floats in base64; NaN where the
// stage wrote nothing. `depths` has the number of rays that each depth traced.
Json recordStages(Renderer& renderer, const Camera& camera, const Film& film, const Crop& tile,
                  int x, int y);

}  // namespace whit::cli
