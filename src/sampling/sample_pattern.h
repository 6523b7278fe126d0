// Where the samples of a pixel lie: the same fixed pattern in every pixel, for reference and
// kernels alike, so that two renderings differ by arithmetic alone.
#pragma once

#include <cstddef>
#include <vector>

#include "core/vec3.h"

namespace whit {

// Offsets in [0, 1)^2 from the pixel's top left corner; one sample is the center. Rooks that do not
// attack each other on a board of spp x spp cells, in the order of a Fibonacci lattice: an edge
// that is nearly level or upright passes the samples one at a time, unlike with a regular grid, and
// the pattern is as even in the plane (Niederreiter 1992, "Random Number Generation and Quasi-Monte
// Carlo Methods", chapter 5).
//
// The first kProbeSamples lie near those of the pattern of as many, their mean in the center or
// next to it, so that they stand for the pixel by themselves. Each further one lies far
// from those before it, and their mean stays near the center: a picture of the first few shows the
// whole pixel, only with more noise.
std::vector<Vec2f> samplePattern(int spp);
inline constexpr int kProbeSamples = 4;

// Returns the index of the sample nearest to the pixel's center, the first of several.
std::size_t nearestToCenter(const std::vector<Vec2f>& samples);

}  // namespace whit
