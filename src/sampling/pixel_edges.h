// Which pixels need more than one sample: those that differ from a neighbor in surface or in
// contrast, as in the adaptive sampling of Whitted 1980 ("An improved illumination model for shaded
// display", section on aliasing). The same rule for reference and kernels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace whit {

// The surface that a pixel's first ray hits. The defaults stand for a miss.
struct PixelSurface {
  static constexpr std::uint32_t kNothing = 0xffffffffu;
  std::uint32_t material = kNothing, instance = kNothing;
  Vec3f position, normal;  // in the world; the geometric normal, towards the viewer
};

// True if neighboring pixels show the same smooth surface: material and instance agree, the normals
// agree within 5 degrees, and the direction from one point to the other lies in both planes within
// 5 degrees. A surface behind or beside an edge fails the last test at any scale, even if its
// material is the same.
bool onSameSurface(const PixelSurface& a, const PixelSurface& b);

// The pixels of `window` and `more` on each side, as far as the image reaches.
Crop grown(const Crop& window, int more, int width, int height);
// How far a pixel of several passes looks: to its neighbors' probes, and these to theirs for
// edges.
inline constexpr int kPassReach = 2;

// Sets edges[i] to 1 for each pixel i of the window's rows [row0, row1), counted from its top, that
// has a neighbor among its eight on another surface, or with a display code that differs by more
// than `contrast` in some channel; 0 for the others. `surfaces` and `edges` are one a pixel of
// `display`. Rows may be shared out among threads.
void findEdges(const DisplayImage& display, const std::vector<PixelSurface>& surfaces, int contrast,
               int row0, int row1, std::vector<std::uint8_t>& edges);

}  // namespace whit
