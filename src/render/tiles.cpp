#include "render/tiles.h"

#include "core/pixel.h"
#include "stages/columns.h"

namespace whit {

namespace {

// The even bits of a Morton code.
int evenBits(std::uint32_t code) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < 16; ++i) bits |= (code >> (2 * i) & 1u) << i;
  return static_cast<int>(bits);
}

// Offsets within a tile, packed as its pixels.
std::vector<std::uint32_t> mortonOrder(int side) {
  int power = 1;
  while (power < side) power *= 2;
  std::vector<std::uint32_t> order;
  for (std::uint32_t code = 0; code < static_cast<std::uint32_t>(power * power); ++code) {
    const int x = evenBits(code), y = evenBits(code >> 1);
    if (x < side && y < side) order.push_back(packedPixel(x, y));
  }
  return order;
}

}  // namespace

PixelLists makeTiles(const Crop& window, int side) {
  const std::vector<std::uint32_t> order = mortonOrder(side);
  PixelLists tiles;
  for (int y0 = window.y0; y0 < window.y1; y0 += side) {
    for (int x0 = window.x0; x0 < window.x1; x0 += side) {
      std::vector<std::uint32_t>& tile = tiles.emplace_back();
      for (const std::uint32_t offset : order) {
        const int x = x0 + pixelX(offset), y = y0 + pixelY(offset);
        if (x >= window.x1 || y >= window.y1) continue;
        tile.push_back(packedPixel(x, y));
      }
    }
  }
  return tiles;
}

PixelLists dealOut(const PixelLists& lists, std::size_t workers) {
  PixelLists shares(workers);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    std::vector<std::uint32_t>& share = shares[i % workers];
    share.insert(share.end(), lists[i].begin(), lists[i].end());
  }
  return shares;
}

void padForVectors(PixelLists& lists) {
  for (auto& list : lists) list.reserve(list.size() + 2 * kBlock);
}

}  // namespace whit
