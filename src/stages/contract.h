// The parts of a chunk that a step reads and writes. Builds without NDEBUG check that steps keep to
// it (render/tile_tracer.cpp), and plans are checked for steps that read a part which no earlier
// step has written.
#pragma once

#include <cstdint>

#include "core/enum_set.h"

namespace whit {

enum class Part : std::uint8_t {
  pixels,
  rays,  // of the chunk
  hits,
  surfels,
  radiance,
  unshadowed,  // one light's radiance, and whether it is visible
  shadows,     // shadow rays
  children,    // rays of the next depth
  parentRadiance,
  codes,
  film,
  rayCounts,  // of each ray and all that follow from it
  channels    // of the film
};

using Parts = EnumSet<Part, static_cast<int>(Part::channels) + 1>;

}  // namespace whit
