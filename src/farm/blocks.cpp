#include "farm/blocks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace whit {

int blockSide(int tile, int workers) {
  return tile * static_cast<int>(std::ceil(std::sqrt(2.0 * workers)));
}

std::vector<Crop> blocksOf(const Crop& window, int side) {
  std::vector<Crop> blocks;
  for (int y = window.y0; y < window.y1; y += side) {
    for (int x = window.x0; x < window.x1; x += side) {
      blocks.push_back({x, y, std::min(x + side, window.x1), std::min(y + side, window.y1)});
    }
  }
  return blocks;
}

Film blockFilm(const Film& whole, const Crop& block) {
  Film film;
  film.image = Image(whole.image.width, whole.image.height, block);
  film.wantDisplay = whole.wantDisplay;
  film.channels.resize(whole.channels.channels(), film.image.pixels.size());
  return film;
}

void place(const Film& block, Film& whole) {
  const bool display = block.display.rgba.size() == 4 * block.image.pixels.size();
  place(block.image.window, block.image.pixels.data(),
        display ? block.display.rgba.data() : nullptr, whole);
  place(block.image.window, block.channels, whole);
}

void place(const Crop& block, const ChannelLayers& channels, Film& whole) {
  const auto width = static_cast<std::size_t>(block.x1 - block.x0);
  for (int y = block.y0; y < block.y1; ++y) {
    const std::size_t from = static_cast<std::size_t>(y - block.y0) * width;
    whole.channels.copy(channels, from, width, whole.image.index(block.x0, y));
  }
}

void place(const Crop& block, const Rgb* pixels, const std::uint8_t* rgba, Film& whole) {
  const auto width = static_cast<std::size_t>(block.x1 - block.x0);
  for (int y = block.y0; y < block.y1; ++y) {
    const std::size_t from = static_cast<std::size_t>(y - block.y0) * width;
    const std::size_t to = whole.image.index(block.x0, y);
    std::copy_n(pixels + from, width, whole.image.pixels.begin() + static_cast<std::ptrdiff_t>(to));
    if (rgba) std::memcpy(&whole.display.rgba[4 * to], rgba + 4 * from, 4 * width);
  }
}

}  // namespace whit
