// Adaptive sampling (Whitted 1980, "An improved illumination model for shaded display", section on
// aliasing): a pixel that differs from a neighbor in surface or in contrast gets a few probe
// samples; one whose probes differ, from one another or from those of the pixel next to it, gets
// every sample. Reference and kernels follow the same rules.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/vec3.h"
#include "sampling/sample_pattern.h"

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

// Returns the window enlarged by `more` pixels on each side, as far as the image reaches.
Crop grown(const Crop& window, int more, int width, int height);

// Number of pixels by which a pixel's result depends on others: it compares its probes with those
// of its neighbors, and their edges depend on their neighbors in turn.
inline constexpr int kPassReach = 2;

// Sets edges[i] to 1 for each pixel i of the window's rows [row0, row1), counted from its top, that
// has a neighbor among its eight on another surface, or with a display code that differs by more
// than `contrast` in some channel; 0 for the others. `surfaces` and `edges` are one a pixel of
// `display`. Rows may be shared out among threads.
void findEdges(const DisplayImage& display, const std::vector<PixelSurface>& surfaces, int contrast,
               int row0, int row1, std::vector<std::uint8_t>& edges);

// The probes of one pixel.
struct PixelProbes {
  std::array<std::uint32_t, kProbeSamples> codes{};  // as displayed: r | g << 8 | b << 16
  RgbD total;  // their sum, to which further samples are added
};

class ProbeSamples {
 public:
  // Makes room for the window's pixels. `edges` has an entry for each pixel, which is not 0 where
  // probes are traced; it must outlive the probes. The pattern is that of all samples, at least
  // kProbeSamples of them.
  ProbeSamples(const Crop& window, const std::vector<std::uint8_t>& edges,
               const std::vector<Vec2f>& pattern);

  PixelProbes& at(int x, int y) { return samples_[shape_.index(x, y)]; }
  const PixelProbes& at(int x, int y) const { return samples_[shape_.index(x, y)]; }
  // True if the probes of this pixel differ from one another, or from the nearest probes of its
  // eight neighbors. Neighbors without probes are skipped. The probes must have been traced.
  bool differ(int x, int y, int contrast) const;
  std::size_t bytes() const { return samples_.capacity() * sizeof(PixelProbes); }

 private:
  Image shape_;  // without pixels
  const std::vector<std::uint8_t>& edges_;
  std::array<std::size_t, 9> nearest_{};  // the nearest of each neighbor's probes, row by row
  std::vector<PixelProbes> samples_;
};

}  // namespace whit
