// Debug views of a frame, for inspection and not for speed: depth, normals, albedo, ray counts,
// cost.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace whit {

enum class DebugView { none, depth, normals, albedo, rays, cost, effects, occupancy };
inline constexpr std::array kDebugViewNames{"none", "depth", "normals", "albedo",
                                            "rays", "cost",  "effects", "occupancy"};

struct WatchedPixel {
  Rgb sum{0, 0, 0};  // of `count` colors, or of amounts in x
  double count = 0;
  EffectSet effects;  // of all surfaces that were met, for DebugView::effects
};

// The amounts that have the first and the last of the colors.
struct AmountScale {
  double low = 0, high = 0;
};

// Traces the frame with one worker and stores what `view` (not none) shows of the window's pixels,
// which `hooks` may look at. film.image is what render() makes of it.
//   depth      distance along the primary ray, near ones bright; black: nothing hit
//   normals    shading normals, (n + 1) / 2 a channel
//   albedo     diffuse reflectance, textures included
//   rays       all that were traced for the pixel
//   cost       the pixel's share of the time of the stages that it took part in
//   effects    those of the surface that the primary ray hits, by effectColors(), added up
//   occupancy  live lanes of the packets that carried the pixel's rays, bright when full
FrameStats watchFrame(Renderer& renderer, const Camera& camera, Film& film, DebugView view,
                      std::vector<WatchedPixel>& pixels, const FrameHooks* hooks = nullptr);
// Scale, picture, legend and words for such pixels, each the mean of this many samples.
AmountScale scaleOf(DebugView view, const std::vector<WatchedPixel>& pixels, int samples);
void paintView(DebugView view, const std::vector<WatchedPixel>& pixels, int samples,
               const AmountScale& scale, DisplayImage& display);
// Describes the colors: "rays a pixel and sample, from 1 to 23"; empty for views without a scale.
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
