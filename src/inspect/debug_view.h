// Debug views of a frame, for inspection and not for speed: depth, normals, albedo, ray counts,
// cost.
#pragma once

#include <array>
#include <span>
#include <string>

#include "inspect/false_colors.h"
#include "render/renderer.h"

namespace whit {

enum class DebugView { none, depth, normals, albedo, rays, cost, effects, occupancy };
inline constexpr std::array kDebugViewNames{"none", "depth", "normals", "albedo",
                                            "rays", "cost",  "effects", "occupancy"};

struct DebugFrame {
  FrameStats stats;  // of one worker, who was looked at all the time
  // Describes the colors to people: "rays a pixel, from 1 to 23".
  std::string legend;
  AmountScale scale;                 // of those views that have one
  std::vector<WatchedPixel> pixels;  // of the window
};

// Traces the frame as ever, but with one worker, and paints film.display (the window's pixels):
//   depth      distance along the primary ray, near ones bright; black: nothing hit
//   normals    shading normals, (n + 1) / 2 a channel
//   albedo     diffuse reflectance, textures included
//   rays       all that were traced for the pixel
//   cost       the pixel's share of the time of the stages that it took part in
//   effects    those of the surface that the primary ray hits, by effectColors(), added up
//   occupancy  live lanes of the packets that carried the pixel's rays, bright when full
// Several samples are averaged. film.image is what render() makes of it. `view` is not none.
DebugFrame renderDebugView(Renderer& renderer, const Camera& camera, Film& film, DebugView view);

// The parts of the above, for pictures that are shown tile by tile: what is seen of the window's
// pixels, which `hooks` may look at; then for any pixels, of so many samples each, scale, picture
// and words.
FrameStats watchFrame(Renderer& renderer, const Camera& camera, Film& film, DebugView view,
                      std::vector<WatchedPixel>& pixels, const FrameHooks* hooks = nullptr);
AmountScale scaleOf(DebugView view, const std::vector<WatchedPixel>& pixels, int samples);
void paintView(DebugView view, const std::vector<WatchedPixel>& pixels, int samples,
               const AmountScale& scale, DisplayImage& display);
std::string legendOf(DebugView view, const AmountScale& scale);
// The value of a pixel with its unit: "5.3 rays a sample".
std::string textOf(DebugView view, const WatchedPixel& pixel, int samples);

// Views with a scale have a color and an amount at each share of the way from low to high.
bool hasScale(DebugView view);
std::array<std::uint8_t, 3> colorAt(DebugView view, double share);
double amountAt(DebugView view, const AmountScale& scale, double share);

// The colors of DebugView::effects.
struct EffectColor {
  Effect effect;
  std::array<float, 3> color;  // as displayed, 0 to 1
};
std::span<const EffectColor> effectColors();

}  // namespace whit
