// --adaptive: two passes over a frame. Which pixels get the second depends on the first one's whole
// picture and on nothing else, so that the result is the same for any tiles and threads.
#include <cmath>
#include <cstring>

#include "render/renderer_parts.h"

namespace whit {

Crop Renderer::Parts::tracedWindow(const Film& film) const {
  const Image& image = film.image;
  return adaptive() ? grownByOne(image.window, image.width, image.height) : image.window;
}

FrameStats Renderer::Parts::renderAdaptively(FrameJob& job, std::vector<RayLog>* logs) {
  Film& film = *job.film;
  if (firstSamples.image.window != laidOut || firstSamples.image.width != film.image.width ||
      firstSamples.image.height != film.image.height) {
    firstSamples.image = Image(film.image.width, film.image.height, laidOut);
    sizeDisplay(firstSamples);
    surfaces.resize(firstSamples.image.pixels.size());
    edges.resize(surfaces.size());
  }
  FrameJob first = job;
  first.samples = samplePattern(1);
  first.film = &firstSamples;
  first.surfaces = &surfaces;
  FrameStats stats = renderLists(first, tiles, batches, logs);
  stats.nonFinitePixels = 0;  // of pictures that are kept only
  stats.add(settleFirstSamples(film));
  PixelLists lists = edgePixels(film.image.window);
  PixelLists shares;
  if (options.batch == Batch::frame) shares = dealOut(lists, tracers.size());
  padForVectors(lists);
  padForVectors(shares);
  job.contrast = options.contrast;
  stats.add(renderLists(job, lists, shares, logs));
  job.contrast.reset();
  return stats;
}

FrameStats Renderer::Parts::settleFirstSamples(Film& film) {
  const Image& from = firstSamples.image;
  Image& to = film.image;
  std::vector<FrameStats> stats(tracers.size());
  pool->run([&](int worker) {
    FrameStats mine;
    StageClock clock(mine);
    const auto share = [&](int w) { return from.windowHeight() * w / machine.threads; };
    findEdges(firstSamples.display, surfaces, options.contrast, share(worker), share(worker + 1),
              edges);
    for (int row = share(worker); row < share(worker + 1); ++row) {
      const int y = from.window.y0 + row;
      if (y < to.window.y0 || y >= to.window.y1) continue;
      for (int x = to.window.x0; x < to.window.x1; ++x) {
        const std::size_t source = from.index(x, y), target = to.index(x, y);
        if (edges[source] != 0) continue;
        const Rgb value = to.pixels[target] = from.pixels[source];
        mine.nonFinitePixels += !isFinite(value);
        if (!film.wantDisplay) continue;
        std::memcpy(&film.display.rgba[4 * target], &firstSamples.display.rgba[4 * source], 4);
      }
    }
    clock.lap(Stage::updateImage, 0);
    stats[static_cast<std::size_t>(worker)] = mine;
  });
  FrameStats sum;
  for (const FrameStats& s : stats) sum.add(s);
  return sum;
}

// In the order of the tiles, as full lists as tiles would be.
PixelLists Renderer::Parts::edgePixels(const Crop& window) const {
  const auto length = static_cast<std::size_t>(options.tile * options.tile);
  PixelLists lists;
  for (const auto& tile : tiles) {
    for (const std::uint32_t pixel : tile) {
      const int x = static_cast<int>(pixel & 0xFFFFu), y = static_cast<int>(pixel >> 16);
      const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
      if (!inside || edges[firstSamples.image.index(x, y)] == 0) continue;
      if (lists.empty() || lists.back().size() == length) lists.emplace_back().reserve(length);
      lists.back().push_back(pixel);
    }
  }
  return lists;
}

}  // namespace whit
