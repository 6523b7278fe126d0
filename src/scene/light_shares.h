// Half rates: on the even fields of a checkerboard over the image, pixels trace every ray and lend
// what they found to their four neighbours, which borrow it where they show the same surface. Never
// across surfaces: a pixel that finds too few lenders traces its rays itself. The same rule for
// reference and kernels.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"
#include "scene/pixel_edges.h"

namespace whit {

// What one pixel found out.
struct LightShare {
  // Lights, a bit each, that its shadow rays found visible, and those they found hidden. Lights
  // numbered kSharedLights and higher are not shared.
  std::uint64_t lit = 0, dark = 0;
  Rgb impulses;  // radiance that reflection and refraction brought

  void saw(std::size_t light, bool visible);
};
inline constexpr std::size_t kSharedLights = 64;

// The lenders next to a pixel, on its surface: left, right, above, below.
struct Lenders {
  static constexpr int kEnough = 2;  // no value is taken from a single one
  std::array<const LightShare*, 4> shares{};
  int count = 0;

  // As all that know it say, when they agree and are enough.
  std::optional<bool> visibility(std::size_t light) const;
  // Their mean.
  std::optional<Rgb> impulses() const;
};

class LightShares {
 public:
  // `surfaces` are those of the window's pixels; they must outlive the shares, and be there for
  // lenders before anything is borrowed.
  LightShares(const Crop& window, const std::vector<PixelSurface>& surfaces)
      : window_(window), surfaces_(surfaces), shares_(surfaces.size()) {}

  static bool lends(int x, int y) { return (x + y) % 2 == 0; }

  LightShare& at(int x, int y) { return shares_[index(x, y)]; }
  // For a pixel that does not lend.
  Lenders lendersOf(int x, int y, const PixelSurface& surface) const;
  std::size_t bytes() const { return shares_.capacity() * sizeof(LightShare); }

 private:
  bool inside(int x, int y) const {
    return x >= window_.x0 && x < window_.x1 && y >= window_.y0 && y < window_.y1;
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - window_.y0) *
               static_cast<std::size_t>(window_.x1 - window_.x0) +
           static_cast<std::size_t>(x - window_.x0);
  }

  Crop window_;
  const std::vector<PixelSurface>& surfaces_;
  std::vector<LightShare> shares_;
};

}  // namespace whit
