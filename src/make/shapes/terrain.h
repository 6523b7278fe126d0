// The landscape as a function, so that whatever stands on it can ask how high the ground is.
#pragma once

#include <cstdint>

#include "core/vec3.h"
#include "make/shape.h"

namespace whit::procedural {

// Hills that rise towards ridges away from a basin at the origin, longest along z. Lengths in
// the scene's units; the same seed, size, height and valley give the same ground at any resolution.
class Ground {
 public:
  // Reads seed, size, height, valley and floor.
  explicit Ground(ShapeParameters& parameters);

  double size() const { return size_; }
  std::uint32_t seed() const { return seed_; }
  // Height of the ground at (x, z); below zero in the valley's floor.
  double height(double x, double z) const;
  // Upward unit normal, from differences over `step`.
  Vec3d normal(double x, double z, double step) const;

 private:
  std::uint32_t seed_;
  double size_, height_, valley_, floor_;
};

}  // namespace whit::procedural
