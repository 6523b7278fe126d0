// The blocks of an image: what one rank of a farm traces at a time.
#pragma once

#include <vector>

#include "render/renderer.h"

namespace whit {

// Pixels a side of a block: whole tiles, at least two for each worker, so that none stands idle.
int blockSide(int tile, int workers);

// The blocks of a window, row by row from the top. They begin where its tiles of side / n begin, so
// that a block's tiles are those of the whole window and its pixels have the same bits.
std::vector<Crop> blocksOf(const Crop& window, int side);

// An empty film for a block of `whole`.
Film blockFilm(const Film& whole, const Crop& block);

// Copies what a block's film holds, or the same as arrays (`rgba` may be null: no display), to its
// place. Room for the display must be there. Blocks may be placed by several threads.
void place(const Film& block, Film& whole);
void place(const Crop& block, const Rgb* pixels, const std::uint8_t* rgba, Film& whole);
// Copies a block's channels, which are those of the whole film.
void place(const Crop& block, const ChannelLayers& channels, Film& whole);

}  // namespace whit
