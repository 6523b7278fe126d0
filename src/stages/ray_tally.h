// Rays counted, and the packet lanes that were spent on them.
#pragma once

#include <cstdint>

namespace whit {

struct RayTally {
  std::uint64_t rays = 0;   // traced
  std::uint64_t lanes = 0;  // lanes sent to Embree for them: packets times width
};

}  // namespace whit
