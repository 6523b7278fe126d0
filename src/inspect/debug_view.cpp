#include "inspect/debug_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "bake/finalize_steps.h"
#include "core/formatted.h"
#include "core/pixel.h"
#include "inspect/metrics.h"
#include "render/pixel_tracker.h"

namespace whit {

namespace {

using Clock = std::chrono::steady_clock;

constexpr EffectColor kEffectColors[] = {
    {Effect::textures, {0.25f, 0.25f, 0.25f}},   {Effect::normalMaps, {0.35f, 0.05f, 0.35f}},
    {Effect::alphaMasks, {0.05f, 0.35f, 0.05f}}, {Effect::glossy, {0.45f, 0.4f, 0.0f}},
    {Effect::emission, {0.7f, 0.25f, 0.0f}},     {Effect::mirror, {0.0f, 0.2f, 0.65f}},
    {Effect::transmission, {0.0f, 0.5f, 0.35f}}, {Effect::sky, {0.08f, 0.1f, 0.15f}}};

Rgb colorOf(EffectSet effects) {
  Rgb sum{0, 0, 0};
  for (const EffectColor& c : kEffectColors) {
    if (effects.has(c.effect)) sum += Rgb{c.color[0], c.color[1], c.color[2]};
  }
  return sum;
}

// Sums, a pixel of the window each, of whatever the view shows.
class Watcher : public StageObserver {
 public:
  Watcher(const Renderer& renderer, const Crop& window, DebugView view,
          std::vector<WatchedPixel>& pixels)
      : renderer_(renderer), window_(window), view_(view), pixels_(pixels), last_(Clock::now()) {
    const auto width = static_cast<std::size_t>(window.x1 - window.x0);
    pixels_.assign(width * static_cast<std::size_t>(window.y1 - window.y0), WatchedPixel());
  }

  void after(Stage stage, const Chunk& chunk) override {
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - last_).count();
    tracker_.follow(stage, chunk);
    const bool hits = stage == Stage::findIntersections;
    if (view_ == DebugView::cost) {
      for (std::size_t i = 0; i < chunk.n; ++i) {
        add(chunk, i, {static_cast<float>(us / static_cast<double>(chunk.n)), 0, 0}, 0);
      }
    } else if (view_ == DebugView::rays || view_ == DebugView::occupancy) {
      if (hits) countRays(chunk);
      if (stage == Stage::checkShadows) countShadowRays(chunk);
    } else if (hits && chunk.depth == 0) {
      lookAtSurfels(chunk);
    }
    last_ = Clock::now();
  }

 private:
  WatchedPixel& add(const Chunk& chunk, std::size_t slot, const Rgb& value, double count) {
    const std::uint32_t at = tracker_.pixel(chunk, slot);
    const auto x = static_cast<std::size_t>(pixelX(at) - window_.x0);
    const auto y = static_cast<std::size_t>(pixelY(at) - window_.y0);
    WatchedPixel& pixel = pixels_[y * static_cast<std::size_t>(window_.x1 - window_.x0) + x];
    pixel.sum += value;
    pixel.count += count;
    return pixel;
  }

  // Ray i of n that go to Embree together.
  void countRay(const Chunk& chunk, std::size_t slot, std::size_t i, std::size_t n) {
    if (view_ == DebugView::rays) {
      add(chunk, slot, {1, 0, 0}, 0);
      return;
    }
    const auto width = static_cast<std::size_t>(renderer_.machine().packet);
    const std::size_t live = std::min(width, n - i / width * width);
    add(chunk, slot, {static_cast<float>(live) / static_cast<float>(width), 0, 0}, 1);
  }

  void countRays(const Chunk& chunk) {
    for (std::size_t s = 0; s < chunk.segmentCount; ++s) {
      const Segment& part = chunk.segments[s];
      for (std::size_t i = part.begin; i < part.end; ++i) {
        countRay(chunk, i, i - part.begin, part.end - part.begin);
      }
    }
  }

  void countShadowRays(const Chunk& chunk) {
    for (std::size_t i = 0; i < chunk.shadowCount; ++i) {
      countRay(chunk, chunk.shadows.slot[i], i, chunk.shadowCount);
    }
  }

  void lookAtSurfels(const Chunk& chunk) {
    const SurfelColumns& s = chunk.surfels;
    for (std::size_t i = 0; i < chunk.n; ++i) {
      const bool hit = s.material[i] != kMiss;
      if (view_ == DebugView::effects) {
        const EffectSet sky = EffectSet().with(Effect::sky);
        const EffectSet all = hit ? effectsOf(renderer_.scene().materials[s.material[i]]) : sky;
        const EffectSet on(all.bits() & renderer_.plan().effects.bits());
        WatchedPixel& pixel = add(chunk, i, colorOf(on), 1);
        pixel.effects = EffectSet(pixel.effects.bits() | on.bits());
      } else if (!hit) {
        add(chunk, i, {0, 0, 0}, view_ == DebugView::depth ? 0 : 1);
      } else if (view_ == DebugView::depth) {
        add(chunk, i, {chunk.hits.t[i], 0, 0}, 1);
      } else if (view_ == DebugView::normals) {
        add(chunk, i, Rgb{s.nsX[i] + 1, s.nsY[i] + 1, s.nsZ[i] + 1} * 0.5f, 1);
      } else {
        add(chunk, i, {s.diffuseR[i], s.diffuseG[i], s.diffuseB[i]}, 1);
      }
    }
  }

  const Renderer& renderer_;
  const Crop window_;
  const DebugView view_;
  std::vector<WatchedPixel>& pixels_;
  PixelTracker tracker_;
  Clock::time_point last_;
};

// Empty of views without a scale.
std::string amountName(DebugView view) {
  switch (view) {
    case DebugView::depth:
      return "distance";
    case DebugView::rays:
      return "rays a pixel and sample";
    case DebugView::cost:
      return "microseconds a pixel and sample";
    case DebugView::occupancy:
      return "share of live lanes";
    default:
      return "";
  }
}

std::string namesOf(EffectSet effects) {
  std::string names;
  for (int i = 0; i < kEffectCount; ++i) {
    if (!effects.has(static_cast<Effect>(i))) continue;
    names +=
        (names.empty() ? "" : ", ") + std::string(kEffectNames[static_cast<std::size_t>(i)].name);
  }
  return names.empty() ? "none" : names;
}

}  // namespace

std::span<const EffectColor> effectColors() { return kEffectColors; }

FrameStats watchFrame(Renderer& renderer, const Camera& camera, Film& film, DebugView view,
                      std::vector<WatchedPixel>& pixels, const FrameHooks* hooks) {
  Watcher watcher(renderer, film.image.window, view, pixels);
  StageObserver* const observers[] = {&watcher};
  return renderer.observe(camera, film, observers, hooks);
}

AmountScale scaleOf(DebugView view, const std::vector<WatchedPixel>& pixels, int samples) {
  switch (view) {
    case DebugView::depth:
      return depthScale(pixels);
    case DebugView::rays:
    case DebugView::cost:
      return heatScale(amountsOf(pixels, samples));
    default:
      return {0, 1};
  }
}

void paintView(DebugView view, const std::vector<WatchedPixel>& pixels, int samples,
               const AmountScale& scale, DisplayImage& display) {
  switch (view) {
    case DebugView::depth:
      return paintDepth(pixels, scale, display);
    case DebugView::rays:
    case DebugView::cost:
      return paintHeat(amountsOf(pixels, samples), scale, display);
    case DebugView::occupancy:
      return paintShare(amountsOf(pixels, samples), display);
    case DebugView::normals:
    case DebugView::effects:
    case DebugView::albedo:
      return paintColors(pixels, view == DebugView::albedo, display);
    case DebugView::none:
      return;
  }
}

bool hasScale(DebugView view) { return !amountName(view).empty(); }

std::string legendOf(DebugView view, const AmountScale& scale) {
  if (!hasScale(view)) return "";
  return formatted("%s, from %.3g to %.3g", amountName(view).c_str(), scale.low, scale.high);
}

std::array<std::uint8_t, 3> colorAt(DebugView view, double share) {
  if (view != DebugView::depth) return heatColor(share);
  constexpr float kBrightest = 255;
  const auto code = static_cast<std::uint8_t>(std::lround(kBrightest * depthGray(share)));
  return {code, code, code};
}

double amountAt(DebugView view, const AmountScale& scale, double share) {
  const bool logarithmic = view == DebugView::rays || view == DebugView::cost;
  if (logarithmic && scale.low > 0) return scale.low * std::pow(scale.high / scale.low, share);
  return scale.low + share * (scale.high - scale.low);
}

std::string textOf(DebugView view, const WatchedPixel& pixel, int samples) {
  const double count = pixel.count;
  const auto amount = static_cast<double>(pixel.sum.x) / (count > 0 ? count : samples);
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
    case DebugView::effects:
      return "effects: " + namesOf(pixel.effects);
    case DebugView::occupancy:
      return formatted("%.1f %% of the lanes live", 100 * amount);
    case DebugView::none:
      break;
  }
  return "";
}

DebugFrame renderDebugView(Renderer& renderer, const Camera& camera, Film& film, DebugView view) {
  DebugFrame frame;
  frame.stats = watchFrame(renderer, camera, film, view, frame.pixels);
  const int samples = renderer.options().spp;
  frame.scale = scaleOf(view, frame.pixels, samples);
  paintView(view, frame.pixels, samples, frame.scale, film.display);
  frame.legend = legendOf(view, frame.scale);
  return frame;
}

}  // namespace whit
