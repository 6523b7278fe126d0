// Frames of several passes. What happens to a pixel in the later ones depends on whole pictures of
// the earlier ones and on nothing else, so that the result is the same for any tiles and threads.
#include <algorithm>
#include <atomic>
#include <cstring>

#include "core/pixel.h"
#include "render/renderer_parts.h"
#include "render/stage_clock.h"
#include "sampling/sample_pattern.h"

namespace whit {

namespace {

// Pixels that are traced together after the first pass. Fewer than a tile has: they are few, of
// many samples, and no worker is to wait long for another's last list.
constexpr std::size_t kListLength = 256;

}  // namespace

Crop Renderer::Parts::tracedWindow(const Film& film) const {
  const Image& image = film.image;
  return adaptive() ? grown(image.window, kPassReach, image.width, image.height) : image.window;
}

FrameStats Renderer::Parts::renderInPasses(FrameJob& job, std::vector<RayLog>* logs) {
  Film& film = *job.film;
  const Image& kept = firstSamples.image;
  if (kept.window != laidOut || kept.width != film.image.width ||
      kept.height != film.image.height) {
    firstSamples.image = Image(film.image.width, film.image.height, laidOut);
    sizeDisplay(firstSamples);
    surfaces.resize(kept.pixels.size());
    probes.reset();
  }
  contrasting.assign(surfaces.size(), 0);
  FrameStats stats = renderCenters(job, logs);
  stats.add(refine(job, logs));
  stats.nonFinitePixels = 0;  // of pictures that are kept only
  keepFirstSamples(film, stats);
  stats.add(renderMarked(job, film.image.window, contrasting, logs));
  return stats;
}

FrameStats Renderer::Parts::renderCenters(FrameJob& job, std::vector<RayLog>* logs) {
  FrameJob first = job;
  first.samples = samplePattern(1);
  first.film = &firstSamples;
  first.surfaces = &surfaces;
  return renderLists(first, tiles, batches, logs);
}

FrameStats Renderer::Parts::refine(FrameJob& job, std::vector<RayLog>* logs) {
  FrameStats stats;
  edges.resize(surfaces.size());
  shareRows(stats, [&](int begin, int end) {
    findEdges(firstSamples.display, surfaces, options.contrast, begin, end, edges);
  });
  const std::vector<Vec2f> pattern = job.samples;
  if (!probes) probes.emplace(laidOut, edges, samplePattern(std::max(options.spp, kProbeSamples)));
  FrameJob first = job;
  first.samples.resize(std::min<std::size_t>(pattern.size(), kProbeSamples));
  first.film = &firstSamples;
  first.probes = &*probes;
  const Crop& window = job.film->image.window;
  const Crop around = grown(window, 1, job.film->image.width, job.film->image.height);
  stats.add(renderMarked(first, around, edges, logs));
  if (pattern.size() <= kProbeSamples) return stats;
  shareRows(stats, [&](int begin, int end) {
    for (int y = std::max(laidOut.y0 + begin, window.y0); y < std::min(laidOut.y0 + end, window.y1);
         ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        const std::size_t i = firstSamples.image.index(x, y);
        contrasting[i] = edges[i] != 0 && probes->differ(x, y, options.contrast);
      }
    }
  });
  job.probes = &*probes;
  job.firstSample = kProbeSamples;
  return stats;
}

FrameStats Renderer::Parts::renderMarked(FrameJob& job, const Crop& window,
                                         const std::vector<std::uint8_t>& marks,
                                         std::vector<RayLog>* logs) {
  PixelLists lists = markedPixels(window, marks), dealt;
  if (options.batch == Batch::frame) dealt = dealOut(lists, tracers.size());
  padForVectors(lists);
  padForVectors(dealt);
  return renderLists(job, lists, dealt, logs);
}

void Renderer::Parts::keepFirstSamples(Film& film, FrameStats& stats) {
  const Image& from = firstSamples.image;
  Image& to = film.image;
  std::atomic<std::uint64_t> nonFinite{0};
  shareRows(stats, [&](int begin, int end) {
    std::uint64_t mine = 0;
    for (int y = std::max(laidOut.y0 + begin, to.window.y0);
         y < std::min(laidOut.y0 + end, to.window.y1); ++y) {
      for (int x = to.window.x0; x < to.window.x1; ++x) {
        const std::size_t source = from.index(x, y), target = to.index(x, y);
        if (contrasting[source] != 0) continue;
        const Rgb value = to.pixels[target] = from.pixels[source];
        mine += !isFinite(value);
        if (!film.wantDisplay) continue;
        std::memcpy(&film.display.rgba[4 * target], &firstSamples.display.rgba[4 * source], 4);
      }
    }
    nonFinite += mine;
  });
  stats.nonFinitePixels += nonFinite;
}

void Renderer::Parts::shareRows(FrameStats& stats, const std::function<void(int, int)>& task) {
  std::vector<FrameStats> parts(tracers.size());
  pool->run([&](int worker) {
    FrameStats mine;
    StageClock clock(mine);
    const auto share = [&](int w) { return (laidOut.y1 - laidOut.y0) * w / machine.threads; };
    task(share(worker), share(worker + 1));
    clock.lap(Stage::updateImage, 0);
    parts[static_cast<std::size_t>(worker)] = mine;
  });
  for (const FrameStats& part : parts) stats.add(part);
}

// In the order of the tiles, so that neighbors stay together.
PixelLists Renderer::Parts::markedPixels(const Crop& window,
                                         const std::vector<std::uint8_t>& marks) const {
  PixelLists lists;
  for (const auto& tile : tiles) {
    for (const std::uint32_t pixel : tile) {
      const int x = pixelX(pixel), y = pixelY(pixel);
      const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
      if (!inside || marks[firstSamples.image.index(x, y)] == 0) continue;
      if (lists.empty() || lists.back().size() == kListLength) {
        lists.emplace_back().reserve(kListLength);
      }
      lists.back().push_back(pixel);
    }
  }
  return lists;
}

}  // namespace whit
