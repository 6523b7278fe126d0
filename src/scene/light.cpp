#include "scene/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace whit {

namespace {

RgbD mix(const Rgb& a, const Rgb& b, double t) { return RgbD(a) * (1 - t) + RgbD(b) * t; }

RgbD texel(const EnvironmentImage& image, int x, int y) {
  const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x);
  return {image.r[i], image.g[i], image.b[i]};
}

// Bilinear at (u, v) in turns from -z and in half-turns from the zenith.
RgbD lookUp(const EnvironmentImage& image, double u, double v) {
  const double x = (u - std::floor(u)) * image.width - 0.5;
  const double y = std::clamp(v * image.height - 0.5, 0.0, image.height - 1.0);
  const double x0 = std::floor(x), y0 = std::floor(y);
  const int left = x0 < 0 ? image.width - 1 : static_cast<int>(x0);
  const int right = left + 1 < image.width ? left + 1 : 0;
  const int top = static_cast<int>(y0), bottom = std::min(top + 1, image.height - 1);
  const double s = x - x0, t = y - y0;
  return (texel(image, left, top) * (1 - s) + texel(image, right, top) * s) * (1 - t) +
         (texel(image, left, bottom) * (1 - s) + texel(image, right, bottom) * s) * t;
}

// The cosine-weighted mean over one hemisphere. A row between polar angles a and b weighs
// integral of 2 cos sin = sin^2 b - sin^2 a; the weights of a hemisphere's rows sum to 1.
RgbD hemisphereMean(const EnvironmentImage& image, bool upper) {
  RgbD sum;
  for (int y = 0; y < image.height; ++y) {
    // Polar angles, measured from the pole in question and cut at the horizon.
    const int row = upper ? y : image.height - 1 - y;
    const double a = std::numbers::pi * y / image.height,
                 b = std::min(std::numbers::pi * (y + 1) / image.height, std::numbers::pi / 2);
    if (a >= b) break;
    RgbD rowSum;
    for (int x = 0; x < image.width; ++x) rowSum += texel(image, x, row);
    const double sinA = std::sin(a), sinB = std::sin(b);
    sum += rowSum * ((sinB * sinB - sinA * sinA) / image.width);
  }
  return sum;
}

}  // namespace

Vec3d towards(const Light& light, const Vec3d& position) {
  if (light.kind == Light::Kind::directional) return -normalized(Vec3d(light.direction));
  return Vec3d(light.position) - position;
}

SpotCone coneOf(const Light& light) {
  const double inner = std::cos(light.innerConeAngle * std::numbers::pi / 180);
  const double outer = std::cos(light.outerConeAngle * std::numbers::pi / 180);
  // The extension's least width, 0.001, but not for cones that it would dim at their axis.
  const double least = std::min(0.001, 0.1 * (1 - outer));
  return {normalized(Vec3d(light.direction)), outer, 1 / std::max(least, inner - outer)};
}

double SpotCone::falloff(const Vec3d& unitToLight) const {
  const double s = std::clamp((-dot(axis, unitToLight) - cosOuter) * scale, 0.0, 1.0);
  return s * s;
}

std::string skyName(const Sky& sky) {
  if (!sky.name.empty()) return sky.name;
  constexpr const char* kKinds[] = {"none", "color", "gradient", "image"};
  return kKinds[static_cast<std::size_t>(sky.kind)];
}

RgbD skyRadiance(const Sky& sky, const Vec3d& d) {
  switch (sky.kind) {
    case Sky::Kind::none:
      return {};
    case Sky::Kind::color:
      return RgbD(sky.zenith) * sky.scale;
    case Sky::Kind::gradient:
      return mix(sky.horizon, d.y < 0 ? sky.ground : sky.zenith, std::abs(d.y)) * sky.scale;
    case Sky::Kind::image:
      break;
  }
  const double u = std::atan2(d.x, -d.z) / (2 * std::numbers::pi) + sky.rotation / 360.0;
  // Unlike acos this keeps its precision near the poles.
  const double v = std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi;
  return lookUp(sky.image, u, v) * sky.scale;
}

Ambient ambientFromSky(const Sky& sky, double strength, Ambient before) {
  // The cosine-weighted mean of the sine of the elevation: integral of 2 y * y over [0, 1].
  constexpr double kMeanSine = 2.0 / 3.0;
  RgbD up, down;
  switch (sky.kind) {
    case Sky::Kind::none:
      break;
    case Sky::Kind::color:
      up = down = RgbD(sky.zenith);
      break;
    case Sky::Kind::gradient:
      up = mix(sky.horizon, sky.zenith, kMeanSine);
      down = mix(sky.horizon, sky.ground, kMeanSine);
      break;
    case Sky::Kind::image:
      up = hemisphereMean(sky.image, true);
      down = hemisphereMean(sky.image, false);
  }
  const double factor = strength * sky.scale;
  before.up = Rgb(up * factor);
  before.down = Rgb(down * factor);
  before.ofSky = strength;
  return before;
}

}  // namespace whit
