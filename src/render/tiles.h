// How an image is cut into tiles, and in which order a tile's pixels are traced.
#pragma once

#include <cstdint>
#include <vector>

#include "core/options.h"

namespace whit {

// Pixels x | y << 16 of each tile of the window, in Morton order: any 4, 8 or 16 that follow each
// other make up 2x2, 4x2 or 4x4 pixels, the most coherent packet there is. Tiles that the window
// cuts lose their outer pixels and close the gaps.
std::vector<std::vector<std::uint32_t>> makeTiles(const Crop& window, int side);

}  // namespace whit
