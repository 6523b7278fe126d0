#include "render/adaptive.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "core/image.h"
#include "core/index.h"
#include "sampling/adaptive_pixels.h"

namespace whit {

namespace {

// Pixels that are traced together after the first pass. Fewer than a tile has: they are few, of
// many samples, and no worker is to wait long for another's last list.
constexpr std::size_t kListLength = 256;

// Notes what the rays of depth 0 meet, a surface a pixel of the film.
class SurfaceRecorder : public StageObserver {
 public:
  SurfaceRecorder(const Image& image, std::vector<PixelSurface>& surfaces)
      : image_(image), surfaces_(surfaces) {}

  void after(Stage stage, const Chunk& c) override {
    if (stage != Stage::findIntersections || c.depth > 0) return;

    const SurfelColumns& s = c.surfels;
    for (const auto i : indices(c.n)) {
      const std::uint32_t pixel = c.pixels[c.first + i];
      PixelSurface& surface = surfaces_[image_.index(pixelX(pixel), pixelY(pixel))];
      surface = {};
      if (s.material[i] == kMiss) continue;

      surface.material = s.material[i];
      if (c.has(Feature::instances)) surface.instance = c.hits.instance[i];
      surface.position = s.pos.at(i);
      surface.normal = s.ng.at(i);
    }
  }

 private:
  const Image& image_;
  std::vector<PixelSurface>& surfaces_;
};

}  // namespace

Crop AdaptiveSampler::tracedWindow(const Image& image) {
  return grown(image.window, kPassReach, image.width, image.height);
}

std::size_t AdaptiveSampler::bytes() const {
  return surfaces_.capacity() * sizeof(PixelSurface) + edges_.capacity() + contrasting_.capacity() +
         (probes_ ? probes_->bytes() : 0) + first_.image.pixels.capacity() * sizeof(Rgb) +
         first_.display.rgba.capacity();
}

FrameStats AdaptiveSampler::render(const Frame& frame) {
  startOver(frame);

  FrameStats stats = traceCenters(frame);
  stats.add(traceProbes(frame));
  stats.nonFinitePixels = 0;  // only pixels of the film count
  stats.add(findContrast(frame));

  // Pixels with contrast get the samples that the probes have not taken.
  Frame rest = frame;
  rest.constants.channels = {};
  if (frame.samples.size() > kProbeSamples) {
    rest.probes = &*probes_;
    rest.firstSample = kProbeSamples;
  }
  stats.add(traceMarked(rest, frame.film->image.window, contrasting_));
  return stats;
}

std::vector<Vec2f> AdaptiveSampler::samplesAt(int x, int y, std::vector<Vec2f> pattern) const {
  const std::size_t i = first_.image.index(x, y);
  if (edges_[i] == 0) return samplePattern(1);
  if (contrasting_[i] == 0) pattern.resize(std::min<std::size_t>(pattern.size(), kProbeSamples));
  return pattern;
}

void AdaptiveSampler::startOver(const Frame& frame) {
  const Image& film = frame.film->image;
  // Buffers are kept between frames as long as window and size stay the same.
  if (first_.image.window != scheduler_.window() || first_.image.width != film.width ||
      first_.image.height != film.height) {
    first_.image = Image(film.width, film.height, scheduler_.window());
    sizeDisplay(first_);
    surfaces_.resize(first_.image.pixels.size());
    edges_.resize(surfaces_.size());
    probes_.reset();
  }

  // The pattern of the probes depends on the number of samples.
  if (frame.samples.size() != samples_) probes_.reset();
  samples_ = frame.samples.size();
  contrasting_.assign(surfaces_.size(), 0);
}

FrameStats AdaptiveSampler::traceCenters(const Frame& frame) {
  Frame centers = frame;
  SurfaceRecorder recorder(first_.image, surfaces_);

  // One ray through the center of each pixel also fills the channels of the film.
  centers.samples = samplePattern(1);
  centers.constants.camera.footprint = 1;
  centers.constants.channels.sample = 0;
  centers.endSample = 1;
  centers.film = &first_;
  centers.observer = &recorder;

  return scheduler_.trace(centers, scheduler_.tiles());
}

FrameStats AdaptiveSampler::traceProbes(const Frame& frame) {
  const int contrast = frame.constants.options.contrast;
  FrameStats stats = scheduler_.forRows([&](int begin, int end) {
    findEdges(first_.display, surfaces_, contrast, begin, end, edges_);
  });

  if (!probes_) {
    const int spp = static_cast<int>(samples_);
    probes_.emplace(scheduler_.window(), edges_, samplePattern(std::max(spp, kProbeSamples)));
  }

  Frame probes = frame;
  probes.constants.channels = {};
  probes.samples.resize(std::min<std::size_t>(samples_, kProbeSamples));
  probes.endSample = probes.samples.size();
  probes.film = &first_;
  probes.probes = &*probes_;

  // The probes of the film's pixels are compared with those of the pixels next to its window.
  const Image& image = frame.film->image;
  stats.add(traceMarked(probes, grown(image.window, 1, image.width, image.height), edges_));
  return stats;
}

// Marks the pixels whose probe samples do not agree, if there are more samples than those. The film
// takes all other pixels over; workers share the rows.
FrameStats AdaptiveSampler::findContrast(const Frame& frame) {
  Film& film = *frame.film;
  const int contrast = frame.constants.options.contrast;
  const bool more = samples_ > kProbeSamples;
  const Crop &traced = scheduler_.window(), &window = film.image.window;
  std::atomic<std::uint64_t> nonFinite{0};

  FrameStats stats = scheduler_.forRows([&](int begin, int end) {
    const int last = std::min(traced.y0 + end, window.y1);
    for (int y = std::max(traced.y0 + begin, window.y0); y < last; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        const std::size_t source = first_.image.index(x, y), target = film.image.index(x, y);
        contrasting_[source] = more && edges_[source] != 0 && probes_->differ(x, y, contrast);
        if (contrasting_[source] != 0) continue;

        const Rgb value = first_.image.pixels[source];
        film.image.pixels[target] = value;
        if (!isFinite(value)) ++nonFinite;
        if (!film.wantDisplay) continue;
        std::memcpy(&film.display.rgba[4 * target], &first_.display.rgba[4 * source], 4);
      }
    }
  });

  stats.nonFinitePixels += nonFinite;
  return stats;
}

FrameStats AdaptiveSampler::traceMarked(const Frame& frame, const Crop& window,
                                        const std::vector<std::uint8_t>& marks) {
  // Pixels are collected in the order of the tiles, so that neighbors stay together.
  PixelLists lists;
  for (const auto& tile : scheduler_.tiles()) {
    for (const std::uint32_t pixel : tile) {
      const int x = pixelX(pixel), y = pixelY(pixel);
      if (!window.contains(x, y) || marks[first_.image.index(x, y)] == 0) continue;

      if (lists.empty() || lists.back().size() == kListLength) {
        lists.emplace_back().reserve(kListLength + kListPadding);
      }
      lists.back().push_back(pixel);
    }
  }

  return scheduler_.trace(frame, lists);
}

}  // namespace whit
