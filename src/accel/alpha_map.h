// An alpha mask as Embree's filter reads it, once for each ray that meets a masked triangle: a byte
// a texel, and the bounds of each cell of 8x8 texels, which settle most lookups from a table that
// stays in the cache.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/texture.h"

namespace whit {

class AlphaMap {
 public:
  explicit AlphaMap(const Texture& texture);

  // True if the bilinear alpha at texture coordinates (u, v) is at least `cutoff`.
  bool isOpaqueAt(float u, float v, float cutoff) const noexcept;

 private:
  struct Bounds {
    std::uint8_t least = 255, most = 0;
  };

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }
  Bounds boundsOf(int cellX, int cellY) const;

  Wrap wrapU_, wrapV_;
  int width_, height_;
  int cellsAcross_;
  std::vector<std::uint8_t> alpha_;
  std::vector<Bounds> cells_;  // of every footprint whose lower texel lies in the cell
};

}  // namespace whit
