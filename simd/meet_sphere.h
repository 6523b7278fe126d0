// Rays of a packet and one exact sphere: what Embree asks for where it finds a sphere's box.
#pragma once

#include <cstddef>
#include <cstdint>

namespace whit::simd {

// The map from the world, or the space of a geometry, to the unit sphere: rows * (point - center).
struct SphereInverse {
  double rows[3][3];
  double center[3];
  bool diagonal;  // the rows are 0 off their diagonal
};

// Columns of the rays' hits: their distances and the weights of their points (bake/sphere.h). The
// weights are null where nobody needs them.
struct SphereHits {
  float *t, *u, *v;
};

// `words` are those of Embree's packet of `width` rays (stages/packet_words.h). Returns a bit for
// each ray that is valid (not 0) and meets the sphere farther than `after`, but not beyond `end`;
// its hit is the first such place, and what others get may be anything. A ray's hit does not depend
// on the width.
using SphereMeeter = std::uint32_t (*)(const SphereInverse& sphere, const float* words,
                                       std::size_t width, const int* valid, const float* after,
                                       const float* end, const SphereHits& to);

// Returns the kernel for the chosen target.
SphereMeeter findMeetSphere();

}  // namespace whit::simd
