// Textures and their mip maps (Williams 1983).
#pragma once

#include <vector>

#include "oracle/scene.h"

namespace oracle {

class MipChain {
 public:
  explicit MipChain(const Texture& texture);

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
  static Level halved(const Level& level, bool isData);
  const Level& level(int number) const;

  std::vector<Level> levels_;  // down to one texel
};

}  // namespace oracle
