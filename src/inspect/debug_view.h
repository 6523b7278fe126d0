// Debug views of a frame, for inspection and not for speed: depth, normals, albedo, ray counts,
// cost.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace whit {

enum class DebugView {
  none,
  depth,
  normals,
  albedo,
  rays,
  cost,
  occupancy,
  reference,  // these two come from watchReference() (reference_view.h)
  difference
};
inline constexpr std::array kDebugViewNames{"none", "depth",     "normals",   "albedo",    "rays",
                                            "cost", "occupancy", "reference", "difference"};

struct WatchedPixel {
  Rgb sum{0, 0, 0};  // sum of `count` colors, or of amounts in x
  double count = 0;
};

struct DebugPicture {
  DebugView view = DebugView::none;
  int samples = 1;  // samples of each pixel
  std::vector<WatchedPixel> pixels;
  double low = 0, high = 0;      // the amounts that have the first and the last color
  double largest = 0, mean = 0;  // the pixels' differences from the reference, in 8-bit codes

  // "rays a pixel and sample, from 1 to 23"; empty for views without a scale.
  std::string legend() const;
  // The value of a pixel with its unit: "5.3 rays a sample".
  std::string textOf(std::size_t pixel) const;
};

// Traces the frame with one worker, stores what `view` shows of the window's pixels, and paints it
// into film.display. film.image is what render() makes of it.
//   depth      distance along the primary ray, near ones bright; black: nothing hit
//   normals    shading normals, (n + 1) / 2 a channel
//   albedo     diffuse reflectance, textures included
//   rays       number of rays traced for the pixel
//   cost       the pixel's share of the time of its stages
//   occupancy  live lanes of the packets that carried the pixel's rays, bright when full
FrameStats watchFrame(Renderer& renderer, const Camera& camera, Film& film, DebugView view,
                      DebugPicture& picture, const FrameHooks* hooks = nullptr);

// Returns the color at a share of the way from the lowest to the highest amount.
std::array<std::uint8_t, 3> colorAt(DebugView view, double share);

}  // namespace whit
