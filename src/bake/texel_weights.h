// The share of a surface that masks leave, texel by texel. Mip levels are means with these weights.
#pragma once

#include <cstddef>
#include <vector>

#include "core/index.h"
#include "scene/texture.h"

namespace whit {

// The texels along one axis that a texel of a grid of another size covers, and their shares of it.
struct TexelCover {
  int first = 0;
  std::vector<double> shares;
};

// One cover for each of `count` texels that take the place of `size` texels.
std::vector<TexelCover> texelCovers(int size, int count);

// One number for each texel, in rows from the top. As doubles, because the mean that they weight is
// rounded to a code, and rounded weights would decide it more often.
struct TexelWeights {
  int width = 1, height = 1;
  std::vector<double> values;

  double at(int column, int row) const { return values[cellAt(column, row, width)]; }
  // True if the four texels from this one on have one weight, which is not 0.
  bool areEqual(int column, int row) const {
    const double first = at(column, row);
    return first > 0 && first == at(column + 1, row) && first == at(column, row + 1) &&
           first == at(column + 1, row + 1);
  }
};

// Returns the share of each texel's area in which the first channel of `mask`, looked up
// bilinearly, is at least `cutoff`. The area is sampled at the midpoints of the texel's quarters.
TexelWeights uncutShares(const Texture& mask, float cutoff);

// Returns the first channel of each texel.
TexelWeights firstChannel(const Texture& mask);

// Returns the means of the weights over the texels of another grid.
TexelWeights resized(const TexelWeights& weights, int width, int height);

}  // namespace whit
