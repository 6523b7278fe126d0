// How an image is cut into tiles, and in which order a tile's pixels are traced.
#pragma once

#include <cstdint>
#include <vector>

#include "core/options.h"

namespace whit {

using PixelLists = std::vector<std::vector<std::uint32_t>>;

// The packed pixels of each tile of the window, in Morton order: any 4, 8 or 16 that follow each
// other make up 2x2, 4x2 or 4x4 pixels, the most coherent packet there is. Tiles that the window
// cuts lose their outer pixels and close the gaps.
PixelLists makeTiles(const Crop& window, int side);

// The lists dealt out in turn, so that every worker gets its share of each part of the image.
PixelLists dealOut(const PixelLists& lists, std::size_t workers);

// Kernels read whole vectors of pixels: room for what they read beyond a list's end.
void padForVectors(PixelLists& lists);

}  // namespace whit
