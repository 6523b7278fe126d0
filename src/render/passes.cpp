// Frames of several passes. What happens to a pixel in the later ones depends on whole pictures of
// the earlier ones and on nothing else, so that the result is the same for any tiles and threads.
#include <algorithm>
#include <cstring>

#include "render/renderer_parts.h"

namespace whit {

namespace {

// Those pixels of the lists that lend, or those that borrow.
PixelLists fieldsOf(const PixelLists& lists, bool lenders) {
  PixelLists fields;
  for (const auto& list : lists) {
    std::vector<std::uint32_t>& field = fields.emplace_back();
    for (const std::uint32_t pixel : list) {
      const int x = static_cast<int>(pixel & 0xFFFFu), y = static_cast<int>(pixel >> 16);
      if (LightShares::lends(x, y) == lenders) field.push_back(pixel);
    }
  }
  padForVectors(fields);
  return fields;
}

}  // namespace

Crop Renderer::Parts::tracedWindow(const Film& film) const {
  const Image& image = film.image;
  return inPasses() ? grown(image.window, kPassReach, image.width, image.height) : image.window;
}

FrameStats Renderer::Parts::renderInPasses(FrameJob& job, std::vector<RayLog>* logs) {
  Film& film = *job.film;
  const Image& kept = firstSamples.image;
  if (kept.window != laidOut || kept.width != film.image.width ||
      kept.height != film.image.height) {
    firstSamples.image = Image(film.image.width, film.image.height, laidOut);
    sizeDisplay(firstSamples);
    surfaces.resize(kept.pixels.size());
    edges.resize(surfaces.size());
    shares.reset();
  }
  if (!adaptive()) std::fill(edges.begin(), edges.end(), std::uint8_t{0});
  FrameStats stats = renderCentres(job, logs);
  stats.nonFinitePixels = 0;  // of pictures that are kept only
  stats.add(settleFirstSamples(film));
  if (!adaptive()) return stats;
  PixelLists lists = edgePixels(film.image.window);
  PixelLists dealt;
  if (options.batch == Batch::frame) dealt = dealOut(lists, tracers.size());
  padForVectors(lists);
  padForVectors(dealt);
  FrameJob more = job;
  more.contrast = options.contrast;
  stats.add(renderLists(more, lists, dealt, logs));
  return stats;
}

FrameStats Renderer::Parts::renderCentres(FrameJob& job, std::vector<RayLog>* logs) {
  FrameJob first = job;
  first.samples = samplePattern(1);
  first.film = &firstSamples;
  first.surfaces = &surfaces;
  if (!halfRate()) return renderLists(first, tiles, batches, logs);
  const bool whole = options.batch == Batch::frame && !logs;
  if (!shares || whole != fieldsOfBatches) {
    shares.emplace(laidOut, surfaces);
    lenders = fieldsOf(whole ? batches : tiles, true);
    borrowers = fieldsOf(whole ? batches : tiles, false);
    fieldsOfBatches = whole;
  }
  first.shares = &*shares;
  first.shareImpulses = options.impulseRate == Rate::half;
  first.shareShadows = options.shadowRate == Rate::half;
  first.lends = true;
  FrameStats stats = renderLists(first, lenders, lenders, logs);
  first.lends = false;
  stats.add(renderLists(first, borrowers, borrowers, logs));
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
    if (adaptive()) {
      findEdges(firstSamples.display, surfaces, options.contrast, share(worker), share(worker + 1),
                edges);
    }
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
  const auto side = static_cast<std::size_t>(options.tile), length = side * side;
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
