// Where the samples of a pixel lie: the same fixed pattern in every pixel, for reference and
// kernels alike, so that two renderings differ by arithmetic alone. And which pixels adaptive
// sampling refines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/vec3.h"

namespace whit {

// Offsets in [0, 1)^2 from the pixel's top left corner; one sample is the center. Rooks that do not
// attack each other on a board of spp x spp cells, in the order of a Fibonacci lattice: an edge
// that is nearly level or upright passes the samples one at a time, unlike with a regular grid, and
// the pattern is as even in the plane (Niederreiter 1992, "Random Number Generation and Quasi-Monte
// Carlo Methods", chapter 5).
//
// The first kProbeSamples lie near those of the pattern of as many, their mean in the center or
// next to it, so that they stand for the pixel by themselves. Each further one lies far
// from those before it, and their mean stays near the center: a picture of the first few shows the
// whole pixel, only with more noise.
std::vector<Vec2f> samplePattern(int spp);
inline constexpr int kProbeSamples = 4;

// Returns the index of the sample nearest to the pixel's center, the first of several.
std::size_t nearestToCenter(const std::vector<Vec2f>& samples);

// Adaptive sampling (Whitted 1980, "An improved illumination model for shaded display", section on
// aliasing): a pixel that differs from a neighbor in surface or in contrast gets a few probe
// samples; one whose probes differ, from one another or from those of the pixel next to it, gets
// every sample. The same rules for reference and kernels.

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
  RgbD total;  // their sum, or their mean: for who goes on with more samples
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
  // True if the probes of this pixel and of its eight neighbors differ. All of them must have
  // probes.
  bool differ(int x, int y, int contrast) const;
  std::size_t bytes() const { return samples_.capacity() * sizeof(PixelProbes); }

 private:
  Image shape_;  // without pixels
  const std::vector<std::uint8_t>& edges_;
  std::array<std::size_t, 9> nearest_{};  // the nearest of each neighbor's probes, row by row
  std::vector<PixelProbes> samples_;
};

}  // namespace whit
