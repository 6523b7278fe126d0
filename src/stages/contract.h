// The parts of a chunk that a step reads and writes. Builds without NDEBUG check that steps keep to
// it (render/tile_tracer.cpp), and plans are checked for steps that read a part which no earlier
// step has written.
#pragma once

#include <cstdint>
#include <initializer_list>

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

class Parts {
 public:
  constexpr Parts() = default;
  constexpr Parts(std::initializer_list<Part> parts) {
    for (const Part part : parts) bits_ |= bit(part);
  }
  constexpr bool has(Part part) const { return (bits_ & bit(part)) != 0; }
  constexpr bool holds(Parts others) const { return (others.bits_ & ~bits_) == 0; }
  constexpr Parts with(Parts others) const {
    Parts sum;
    sum.bits_ = bits_ | others.bits_;
    return sum;
  }

 private:
  static constexpr std::uint32_t bit(Part part) { return 1u << static_cast<std::uint32_t>(part); }
  std::uint32_t bits_ = 0;
};

}  // namespace whit
