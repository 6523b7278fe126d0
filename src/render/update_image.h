// The last stage: radiance of a tile's pixels to the film.
#pragma once

#include "stages/chunk.h"

namespace whit {

// Rounds radiance to what the film keeps (--film), encodes it where display codes are wanted, and
// writes both to the pixels.
void updateImage(Chunk& c);

// Display codes of the chunk's radiance, as --exposure, --tonemap and --srgb say.
void encodeForDisplay(Chunk& c);

// Pixels of the chunk that are not finite.
std::uint64_t countNonFinite(const Chunk& c);

}  // namespace whit
