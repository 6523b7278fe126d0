#include "inspect/debug_view.h"

#include <algorithm>
#include <cmath>

#include "core/display.h"
#include "core/image.h"
#include "core/index.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "inspect/metrics.h"

namespace whit {

namespace {

// Adds up what the view shows, for each pixel of the window.
class Watcher : public StageObserver {
 public:
  Watcher(const Renderer& renderer, const Image& image, DebugView view,
          std::vector<WatchedPixel>& pixels)
      : renderer_(renderer), image_(image), view_(view), pixels_(pixels) {
    pixels_.assign(image.pixels.size(), WatchedPixel());
  }

  void after(Stage stage, const Chunk& chunk) override {
    const double us = 1000 * sinceLast_.ms();
    tracker_.follow(stage, chunk);
    const bool hits = stage == Stage::findIntersections;

    if (view_ == DebugView::cost) {
      // The rays of the chunk share the time of the stage equally.
      for (const auto i : indices(chunk.n)) {
        add(chunk, i, {static_cast<float>(us / static_cast<double>(chunk.n)), 0, 0}, 0);
      }
    } else if (view_ == DebugView::rays || view_ == DebugView::occupancy) {
      if (hits) countRays(chunk);
      if (stage == Stage::checkShadows) countShadowRays(chunk);
    } else if (hits && chunk.depth == 0) {
      lookAtSurfels(chunk);
    }

    sinceLast_ = Stopwatch();
  }

 private:
  void add(const Chunk& chunk, std::size_t slot, const Rgb& value, double count) {
    const std::uint32_t at = tracker_.pixel(chunk, slot);
    WatchedPixel& pixel = pixels_[image_.index(pixelX(at), pixelY(at))];
    pixel.sum += value;
    pixel.count += count;
  }

  // Ray i of n that go to Embree together.
  void countRay(const Chunk& chunk, std::size_t slot, std::size_t i, std::size_t n) {
    if (view_ == DebugView::rays) {
      add(chunk, slot, {1, 0, 0}, 0);
      return;
    }

    // All packets are full except for the last one.
    const std::size_t width = renderer_.machine().packet;
    const std::size_t live = std::min(width, n - i / width * width);
    add(chunk, slot, {static_cast<float>(live) / static_cast<float>(width), 0, 0}, 1);
  }

  void countRays(const Chunk& chunk) {
    for (const auto s : indices(chunk.segmentCount)) {
      const Segment& part = chunk.segments[s];
      for (std::size_t i = part.begin; i < part.end; ++i) {
        countRay(chunk, i, i - part.begin, part.end - part.begin);
      }
    }
  }

  void countShadowRays(const Chunk& chunk) {
    for (const auto i : indices(chunk.shadowCount)) {
      countRay(chunk, chunk.shadows.slot[i], i, chunk.shadowCount);
    }
  }

  void lookAtSurfels(const Chunk& chunk) {
    const SurfelColumns& s = chunk.surfels;
    for (const auto i : indices(chunk.n)) {
      if (s.material[i] == kMiss) {
        add(chunk, i, {0, 0, 0}, view_ == DebugView::depth ? 0 : 1);
      } else if (view_ == DebugView::depth) {
        add(chunk, i, {chunk.hits.t[i], 0, 0}, 1);
      } else if (view_ == DebugView::normals) {
        add(chunk, i, (s.ns.at(i) + Rgb(1)) * 0.5f, 1);
      } else {
        add(chunk, i, s.diffuse.at(i), 1);
      }
    }
  }

  const Renderer& renderer_;
  const Image& image_;
  const DebugView view_;
  std::vector<WatchedPixel>& pixels_;
  PixelTracker tracker_;
  Stopwatch sinceLast_;
};

// The amounts that a view shows; empty for views without a scale.
constexpr std::array<const char*, kDebugViewNames.size()> kAmounts{
    "",
    "distance",
    "",
    "",
    "rays a pixel and sample",
    "microseconds a pixel and sample",
    "share of live lanes",
    "",
    ""};

// A few pixels take tens of times what most do.
bool isLogarithmic(DebugView view) { return view == DebugView::rays || view == DebugView::cost; }

// True where a distance is not known because the primary rays left the scene.
bool hitsNothing(DebugView view, const WatchedPixel& pixel) {
  return view == DebugView::depth && pixel.count == 0;
}

double amountOf(const WatchedPixel& pixel, int samples) {
  return double{pixel.sum.x} / (pixel.count > 0 ? pixel.count : samples);
}

std::uint8_t codeOf(float x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(double{x}, 0.0, 1.0)));
}

std::array<std::uint8_t, 3> meanColor(DebugView view, const WatchedPixel& pixel) {
  const Rgb c = pixel.sum * (1 / static_cast<float>(std::max(pixel.count, 1.0)));
  const auto code = [&](float x) {
    const bool linear = view == DebugView::albedo;
    return linear ? static_cast<std::uint8_t>(srgbCode(double{x})) : codeOf(x);
  };
  return {code(c.x), code(c.y), code(c.z)};
}

void findScale(DebugPicture& picture) {
  constexpr double kOutliers = 0.005;  // share of the pixels that may be beyond the scale
  constexpr double kLongestScale = 1000;
  const DebugView view = picture.view;

  picture.low = 0;
  picture.high = 1;
  if (view != DebugView::depth && !isLogarithmic(view)) return;

  std::vector<double> amounts;
  for (const WatchedPixel& p : picture.pixels) {
    if (!hitsNothing(view, p)) amounts.push_back(amountOf(p, picture.samples));
  }
  if (amounts.empty()) amounts.push_back(0);

  // The scale leaves out the few largest amounts, which would hide the differences of all others.
  const auto last = static_cast<double>(amounts.size() - 1);
  const auto highest = amounts.begin() + std::lround(last * (1 - kOutliers));
  std::nth_element(amounts.begin(), highest, amounts.end());
  const double low = *std::min_element(amounts.begin(), highest + 1);

  // A logarithmic scale spans at most three decades.
  picture.low = isLogarithmic(view) ? std::max(low, *highest / kLongestScale) : low;
  picture.high = *highest;
}

void paint(const DebugPicture& picture, DisplayImage& display) {
  const DebugView view = picture.view;
  const double low = picture.low, high = picture.high;
  const bool hasScale = !picture.legend().empty(), flat = !(high > low);
  const double perLog = !flat && isLogarithmic(view) ? 1 / std::log(high / low) : 0;

  const auto shareOf = [&](double amount) {
    if (flat) return 0.0;
    const double share =
        isLogarithmic(view) ? std::log(amount / low) * perLog : (amount - low) / (high - low);
    return share > 0 ? std::min(share, 1.0) : 0;
  };

  for (const auto i : indices(picture.pixels)) {
    const WatchedPixel& p = picture.pixels[i];
    std::array<std::uint8_t, 3> color{};
    if (!hasScale) {
      color = meanColor(view, p);
    } else if (!hitsNothing(view, p)) {
      color = colorAt(view, shareOf(amountOf(p, picture.samples)));
    }

    std::ranges::copy(color, &display.rgba[4 * i]);
    display.rgba[4 * i + 3] = 255;
  }
}

}  // namespace

FrameStats watchFrame(Renderer& renderer, const Camera& camera, Film& film, DebugView view,
                      DebugPicture& picture, const FrameHooks* hooks) {
  picture.view = view;
  picture.samples = renderer.options().spp;

  Watcher watcher(renderer, film.image, view, picture.pixels);
  StageObserver* const observers[] = {&watcher};
  const FrameStats stats = renderer.render(
      {.camera = camera, .film = film, .observers = observers, .uniform = true, .hooks = hooks});

  findScale(picture);
  paint(picture, film.display);
  return stats;
}

std::string DebugPicture::legend() const {
  if (view == DebugView::difference) {
    return formatted(
        "8-bit codes off the reference, from 0 to %d (logarithmic); largest %.0f, mean %.2g",
        kHeatCodes, largest, mean);
  }
  const char* const amounts = entryOf(kAmounts, view);
  return *amounts == 0 ? "" : formatted("%s, from %.3g to %.3g", amounts, low, high);
}

std::array<std::uint8_t, 3> colorAt(DebugView view, double share) {
  constexpr double kFarthest = 0.08;  // the gray of the farthest surface, brighter than a miss
  if (view != DebugView::depth) return heatColor(share);

  const std::uint8_t code = codeOf(static_cast<float>(1 - (1 - kFarthest) * share));
  return {code, code, code};
}

std::string DebugPicture::textOf(std::size_t number) const {
  const WatchedPixel& pixel = pixels[number];
  const double count = pixel.count, amount = amountOf(pixel, samples);
  const RgbD mean = RgbD(pixel.sum) / std::max(count, 1.0);

  switch (view) {
    case DebugView::depth:
      return count > 0 ? formatted("distance %.5g units", amount) : "nothing is hit";
    case DebugView::normals:
      if (isBlack(pixel.sum)) return "nothing is hit";
      return formatted("normal %.3f %.3f %.3f", 2 * mean.x - 1, 2 * mean.y - 1, 2 * mean.z - 1);
    case DebugView::albedo:
      return formatted("albedo %.3f %.3f %.3f, linear", mean.x, mean.y, mean.z);
    case DebugView::rays:
      return formatted("%.4g ray%s a sample", amount, amount == 1 ? "" : "s");
    case DebugView::cost:
      return formatted("%.3g microseconds a sample", amount);
    case DebugView::occupancy:
      return formatted("%.1f %% of the lanes live", 100 * amount);
    case DebugView::reference:
    case DebugView::difference:
      return formatted("%.0f codes off the reference, %.3g linear", mean.x, mean.y);
    case DebugView::none:
      break;
  }
  return "";
}

}  // namespace whit
