// addShading: the radiance from a light, once its shadow is known.
#pragma once

#include "reference/twin.h"

namespace whit::reference {

// The row that the step writes. `before` is the radiance that the step has added to.
RadianceRow addShading(const RadianceRow& before, const Chunk& chunk, std::size_t slot);

}  // namespace whit::reference
