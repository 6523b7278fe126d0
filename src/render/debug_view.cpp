#include "render/debug_view.h"

#include <algorithm>
#include <chrono>

#include "core/pixel.h"
#include "render/false_colors.h"
#include "render/pixel_tracker.h"

namespace whit {

namespace {

using Clock = std::chrono::steady_clock;

constexpr EffectColor kEffectColors[] = {
    {Effect::textures, {0.25f, 0.25f, 0.25f}},   {Effect::normalMaps, {0.35f, 0.05f, 0.35f}},
    {Effect::alphaMasks, {0.05f, 0.35f, 0.05f}}, {Effect::glossy, {0.45f, 0.4f, 0.0f}},
    {Effect::emission, {0.7f, 0.25f, 0.0f}},     {Effect::mirror, {0.0f, 0.2f, 0.65f}},
    {Effect::transmission, {0.0f, 0.5f, 0.35f}}, {Effect::sky, {0.08f, 0.1f, 0.15f}}};

EffectSet effectsOf(const Material& m) {
  EffectSet e;
  if (m.diffuseMap != kNoTexture || m.specularMap != kNoTexture || m.emissionMap != kNoTexture)
    e = e.with(Effect::textures);
  if (m.normalMap != kNoTexture) e = e.with(Effect::normalMaps);
  if (m.alphaMap != kNoTexture) e = e.with(Effect::alphaMasks);
  if (m.hasGlossy()) e = e.with(Effect::glossy);
  if (maxComponent(m.emission) > 0) e = e.with(Effect::emission);
  if (m.hasMirror() || (m.boundsMedium() && m.ior != 1)) e = e.with(Effect::mirror);
  if (m.passesLight()) e = e.with(Effect::transmission);
  if (m.isPartlyThere()) e = e.with(Effect::coverage);
  return e;
}

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
  Watcher(const Renderer& renderer, const Crop& window, DebugView view)
      : renderer_(renderer), window_(window), view_(view), last_(Clock::now()) {
    const auto width = static_cast<std::size_t>(window.x1 - window.x0);
    pixels_.resize(width * static_cast<std::size_t>(window.y1 - window.y0));
  }

  const std::vector<WatchedPixel>& pixels() const { return pixels_; }

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
  void add(const Chunk& chunk, std::size_t slot, const Rgb& value, double count) {
    const std::uint32_t at = tracker_.pixel(chunk, slot);
    const auto x = static_cast<std::size_t>(pixelX(at) - window_.x0);
    const auto y = static_cast<std::size_t>(pixelY(at) - window_.y0);
    WatchedPixel& pixel = pixels_[y * static_cast<std::size_t>(window_.x1 - window_.x0) + x];
    pixel.sum += value;
    pixel.count += count;
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
        add(chunk, i, colorOf(EffectSet(all.bits() & renderer_.plan().effects.bits())), 1);
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
  PixelTracker tracker_;
  std::vector<WatchedPixel> pixels_;
  Clock::time_point last_;
};

}  // namespace

std::span<const EffectColor> effectColors() { return kEffectColors; }

DebugFrame renderDebugView(Renderer& renderer, const Camera& camera, Film& film, DebugView view) {
  Watcher watcher(renderer, film.image.window, view);
  StageObserver* const observers[] = {&watcher};
  DebugFrame frame{renderer.observe(camera, film, observers), ""};
  const std::vector<WatchedPixel>& pixels = watcher.pixels();
  const std::vector<double> amounts = amountsOf(pixels, renderer.options().spp);
  switch (view) {
    case DebugView::depth:
      frame.legend = paintDepth(pixels, film.display);
      break;
    case DebugView::rays:
      frame.legend = paintHeat(amounts, "rays a pixel and sample", film.display);
      break;
    case DebugView::cost:
      frame.legend = paintHeat(amounts, "microseconds a pixel and sample", film.display);
      break;
    case DebugView::occupancy:
      frame.legend = paintShare(amounts, "share of live lanes", film.display);
      break;
    case DebugView::normals:
    case DebugView::effects:
      paintColors(pixels, false, film.display);
      break;
    case DebugView::albedo:
      paintColors(pixels, true, film.display);
      break;
    case DebugView::none:
      break;
  }
  return frame;
}

}  // namespace whit
