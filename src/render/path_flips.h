// Where the vector pipeline and the reference followed different paths.
#pragma once

#include <cstdint>

#include "render/renderer.h"

namespace whit {

// Pixels of the film's window whose primary hit (triangle and instance), shadow bits or sequence
// of impulses differ between packets and reference: there the two saw different surfaces, and no
// tolerance on values applies.
std::uint64_t countPathFlips(Renderer& renderer, const Camera& camera, const Film& film);

}  // namespace whit
