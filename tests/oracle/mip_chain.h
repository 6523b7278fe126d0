// Textures and their mip maps (Williams 1983).
#pragma once

#include <vector>

#include "oracle/scene.h"

namespace oracle {

// One number a texel, from the top left.
struct Shares {
  int width = 0, height = 0;
  std::vector<double> of;
};

// The share of a surface that its masks leave, for each texel of a grid. Alpha cuts where it is
// below the cutoff: of four points a texel.
Shares uncutShares(const Texture& alpha, double cutoff);
Shares coveredShares(const Texture& coverage);
Shares stretched(const Shares& shares, int width, int height);

class MipChain {
 public:
  // Smaller levels are means of what the shares leave, or without any of all.
  explicit MipChain(const Texture& texture, Shares left = {});

  // u to the right and v upwards, repeated. `texels`: the area that is looked at, in texels of the
  // whole texture.
  Color at(double u, double v, Filter filter, double texels) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<Color> texels;  // from the top left

    Color texel(int x, int y) const;
    Color mixed(double u, double v) const;
  };
  static Level halved(const Level& level, const Shares& left, bool isData);
  const Level& level(int number) const;

  std::vector<Level> levels_;  // down to one texel
};

}  // namespace oracle
