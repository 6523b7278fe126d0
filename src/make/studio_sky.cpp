#include "make/studio_sky.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "make/patterns/noise.h"

namespace whit {
namespace {

// Size of the studio's image, and the radiance of its gradient.
constexpr int kWidth = 256, kHeight = 128;
constexpr double kZenith = 0.15, kHorizon = 0.20, kGround = 0.10;

// A soft box of the studio. Angles are in degrees: the azimuth of its center from -z towards +x,
// the elevation of its center, and half of its sides.
struct SoftBox {
  double azimuth, elevation, halfWidth, halfHeight, radiance;
};
// The first box is around the supplied light, the second beside it, the third behind the model.
constexpr SoftBox kBoxes[] = {
    {143, 48, 26, 17, 4.0}, {250, 40, 14, 20, 1.6}, {320, 44, 9, 20, 3.0}};
constexpr double kSoftEdge = 7;  // degrees over which a box fades

// Returns 1 within `half` of the middle, and 0 beyond the soft edge.
double fade(double distance, double half) {
  return procedural::smoothStep(0, 1, (half - distance) / kSoftEdge + 1);
}

double radianceAt(double azimuth, double elevation) {
  const double sine = std::sin(elevation * std::numbers::pi / 180);
  // The gradient runs from the horizon up to the zenith and down to the ground.
  double radiance = kHorizon + ((sine < 0 ? kGround : kZenith) - kHorizon) * std::abs(sine);

  for (const SoftBox& box : kBoxes) {
    const double across = std::abs(std::remainder(azimuth - box.azimuth, 360.0));
    // Azimuths are narrower near the zenith.
    const double width = across * std::cos(box.elevation * std::numbers::pi / 180);
    radiance += box.radiance * fade(width, box.halfWidth) *
                fade(std::abs(elevation - box.elevation), box.halfHeight);
  }
  return radiance;
}

}  // namespace

Sky studioSky() {
  Sky sky;
  sky.name = kStudio;
  sky.kind = Sky::Kind::image;

  EnvironmentImage& image = sky.image;
  image.width = kWidth;
  image.height = kHeight;
  image.r.reserve(std::size_t{kWidth} * kHeight);

  // Rows run from the zenith down to the nadir.
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double azimuth = 360 * (x + 0.5) / kWidth, elevation = 90 - 180 * (y + 0.5) / kHeight;
      image.r.push_back(static_cast<float>(radianceAt(azimuth, elevation)));
    }
  }

  image.g = image.b = image.r;
  return sky;
}

}  // namespace whit
