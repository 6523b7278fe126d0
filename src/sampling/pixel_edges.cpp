#include "sampling/pixel_edges.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

constexpr double kCosOfTurn = 0.99619469809;  // 5 degrees
constexpr double kSinOfTurn = 0.08715574275;

bool contrasts(const std::uint8_t* a, const std::uint8_t* b, int contrast) {
  for (int channel = 0; channel < 3; ++channel) {
    if (std::abs(int{a[channel]} - int{b[channel]}) > contrast) return true;
  }
  return false;
}

}  // namespace

bool onSameSurface(const PixelSurface& a, const PixelSurface& b) {
  if (a.material != b.material || a.instance != b.instance) return false;
  if (a.material == PixelSurface::kNothing) return true;
  const Vec3d na(a.normal), nb(b.normal), between = Vec3d(b.position) - Vec3d(a.position);
  if (!(dot(na, nb) >= kCosOfTurn)) return false;
  const double rise = std::max(std::fabs(dot(na, between)), std::fabs(dot(nb, between)));
  return rise * rise <= kSinOfTurn * kSinOfTurn * dot(between, between);
}

Crop grown(const Crop& window, int more, int width, int height) {
  return {std::max(window.x0 - more, 0), std::max(window.y0 - more, 0),
          std::min(window.x1 + more, width), std::min(window.y1 + more, height)};
}

void findEdges(const DisplayImage& display, const std::vector<PixelSurface>& surfaces, int contrast,
               int row0, int row1, std::vector<std::uint8_t>& edges) {
  const int width = display.width, height = display.height;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  };
  std::fill(edges.begin() + static_cast<std::ptrdiff_t>(at(0, row0)),
            edges.begin() + static_cast<std::ptrdiff_t>(at(0, row1)), std::uint8_t{0});
  // Pairs are looked at once, from the upper or left pixel; those that reach across the ends of the
  // rows also from the other side.
  const auto compare = [&](int x, int y, int dx, int dy) {
    const int nx = x + dx, ny = y + dy;
    if (nx < 0 || nx >= width || ny >= height) return;
    const std::size_t a = at(x, y), b = at(nx, ny);
    const bool markA = y >= row0 && edges[a] == 0, markB = ny < row1 && edges[b] == 0;
    if (!markA && !markB) return;
    const std::uint8_t* codes = display.rgba.data();
    if (!contrasts(codes + 4 * a, codes + 4 * b, contrast) &&
        onSameSurface(surfaces[a], surfaces[b])) {
      return;
    }
    if (markA) edges[a] = 1;
    if (markB) edges[b] = 1;
  };
  for (int y = std::max(row0 - 1, 0); y < row1; ++y) {
    for (int x = 0; x < width; ++x) {
      if (y >= row0) compare(x, y, 1, 0);
      for (int dx = -1; dx <= 1; ++dx) compare(x, y, dx, 1);
    }
  }
}

}  // namespace whit
