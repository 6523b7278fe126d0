#include "inspect/prober.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/index.h"
#include "inspect/metrics.h"

namespace whit {

namespace {

// A list has as many pixels as a tile.
constexpr std::size_t kListPixels = 1024;
constexpr int kTimedSide = 16, kTimedSpp = 3;
constexpr double kLeastTimed = 16;

// Cells of a grid by the lattice of the plastic number (Roberts 2018): the first few lie all over
// it.
std::vector<std::pair<int, int>> spreadCells(int columns, int rows, double count) {
  const auto all = cellsOf(columns, rows);
  std::vector<std::pair<int, int>> cells;
  std::vector<bool> taken(all);

  for (std::size_t k = 0; k < 8 * all && static_cast<double>(cells.size()) < count; ++k) {
    double u = 0.5 + 0.7548776662466927 * static_cast<double>(k), whole = 0;
    double v = 0.5 + 0.5698402909980532 * static_cast<double>(k);
    u = std::modf(u, &whole);
    v = std::modf(v, &whole);

    const int x = static_cast<int>(u * columns), y = static_cast<int>(v * rows);
    const std::size_t cell = cellAt(x, y, columns);
    if (!taken[cell]) cells.emplace_back(x, y);
    taken[cell] = true;
  }
  return cells;
}

}  // namespace

void Prober::chooseBlocks(int side, double count) {
  const Image& image = film_.image;
  side_ = std::min({side, image.windowWidth(), image.windowHeight()});

  blocks_.clear();
  for (const auto& [column, row] :
       spreadCells(image.windowWidth() / side_, image.windowHeight() / side_, count)) {
    const int x = image.window.x0 + column * side_, y = image.window.y0 + row * side_;
    blocks_.push_back(makeTiles({x, y, x + side_, y + side_}, side_)[0]);
  }

  // Every worker gets at least two lists if there are enough blocks, so that the work is
  // balanced.
  const std::size_t lists = 2 * renderer_.machine().threads;
  const std::size_t most = std::max<std::size_t>(kListPixels / blocks_[0].size(), 1);
  const std::size_t together = std::clamp<std::size_t>(blocks_.size() / lists, 1, most);

  lists_.clear();
  for (const auto i : indices(blocks_)) {
    const std::size_t room = together * blocks_[i].size() + kListPadding;
    if (i % together == 0) lists_.emplace_back().reserve(room);
    lists_.back().insert(lists_.back().end(), blocks_[i].begin(), blocks_[i].end());
  }
}

FrameStats Prober::render(RenderOptions options, int spp) {
  options.spp = spp;
  renderer_.setOptions(options);
  return renderer_.render({.camera = camera_, .film = film_, .pixels = &lists_});
}

double Prober::time(const RenderOptions& options, int spp) {
  render(options, 1);
  return 1e3 * render(options, spp).frameMs / (probed() * spp);
}

double Prober::wholePictureMs(const RenderOptions& options, double share) {
  const int spp = options.spp, few = std::min(spp, kTimedSpp);
  const double packets = pixels() / squared(kPacketSide), blocks = pixels() / squared(kTimedSide);

  // Small packets from all over the picture give the number of rays per sample.
  chooseBlocks(kPacketSide, std::max(share * spp * packets, kLeastPackets));
  const double rays = static_cast<double>(render(options, 1).allRays()) / probed();

  // Larger blocks give the time per ray, because their rays are as coherent as the picture's.
  chooseBlocks(kTimedSide, std::max(share * spp / few * blocks, kLeastTimed));
  render(options, 1);  // fills new queues
  const FrameStats timed = render(options, few);
  const double ms =
      std::accumulate(timed.stageWorkerMs.begin(), timed.stageWorkerMs.end(), 0.0) / timed.workers;

  return ms / static_cast<double>(timed.allRays()) * rays * pixels() * spp;
}

Image Prober::mosaic(const Image& picture) const {
  // The blocks are arranged in a grid that is nearly square.
  const int count = static_cast<int>(blocks_.size());
  const int columns = std::max(static_cast<int>(std::sqrt(count)), 1);
  Image image(columns * side_, (count + columns - 1) / columns * side_);

  for (int b = 0; b < count; ++b) {
    const std::vector<std::uint32_t>& block = entryOf(blocks_, b);
    for (const std::uint32_t pixel : block) {
      image.at(b % columns * side_ + pixelX(pixel) - pixelX(block[0]),
               b / columns * side_ + pixelY(pixel) - pixelY(block[0])) =
          picture.at(pixelX(pixel), pixelY(pixel));
    }
  }
  return image;
}

double Prober::difference(const Image& a, const Image& b) const {
  const RenderOptions& o = renderer_.options();
  const ImageDifference d = compareImages(a, b, o.exposure.ev, o.toneCurve);
  return inCodes_ ? 255 * std::pow(10, -d.psnrDb / 20) : d.flipMean;
}

}  // namespace whit
