#include <cmath>

#include "make/patterns/noise.h"
#include "make/patterns/paint.h"

namespace whit::procedural {
namespace {

// Signed distance-like value of a pointed leaf standing on v = 0: positive inside.
double leafShape(double u, double v, double fullness) {
  const double half = fullness * std::pow(std::sin(3.14159265358979 * std::pow(v, 0.75)), 0.8);
  return half - std::fabs(u - 0.5);
}

// A feathered leaf: leaflets on both sides of a rib.
double frondShape(double u, double v, int leaflets) {
  const double s = std::fabs(u - 0.5) * 2;
  const double reach = 0.95 * std::pow(std::sin(3.14159265358979 * (0.06 + 0.93 * v)), 0.6);
  if (s < 0.07 * (1 - 0.7 * v)) return 1;
  // Leaflets slant towards the tip, and narrow outwards.
  const double along = (v - 0.28 * s) * leaflets;
  const double across = std::fabs(along - std::floor(along) - 0.5) * 2;
  return s < reach ? 0.86 - 0.62 * (s / reach) * (s / reach) - across : -1;
}

}  // namespace

// `columns` x `rows` squares of two colors; even numbers repeat without a seam.
Texture makeChecker(ShapeParameters& parameters) {
  const Rgb a = colorOf(parameters, "color", {0.8, 0.8, 0.8});
  const Rgb b = colorOf(parameters, "color2", {0.1, 0.1, 0.1});
  const int columns = parameters.integer("columns", 2, 1, 4096);
  const int rows = parameters.integer("rows", columns, 1, 4096);
  return paintColor("checker", sideOf(parameters), [=](double u, double v) {
    const int i = static_cast<int>(u * columns), j = static_cast<int>(v * rows);
    return (i + j) % 2 == 0 ? a : b;
  });
}

// Upright stripes of two colors; `share` is that of the first.
Texture makeStripes(ShapeParameters& parameters) {
  const Rgb a = colorOf(parameters, "color", {0.8, 0.8, 0.8});
  const Rgb b = colorOf(parameters, "color2", {0.5, 0.05, 0.05});
  const int count = parameters.integer("count", 4, 1, 4096);
  const double share = parameters.number("share", 0.5, 0, 1);
  return paintColor("stripes", sideOf(parameters), [=](double u, double) {
    const double t = u * count - std::floor(u * count);
    return t < share ? a : b;
  });
}

// Cloth with a woven diamond ornament and a border at the foot and head (v near 0 and 1).
Texture makeFabric(ShapeParameters& parameters) {
  const Rgb ground = colorOf(parameters, "color", {0.45, 0.03, 0.03});
  const Rgb figure = colorOf(parameters, "color2", {0.75, 0.5, 0.15});
  const int columns = parameters.integer("columns", 4, 1, 256);
  const int rows = parameters.integer("rows", columns, 1, 256);
  const double border = parameters.number("border", 0.06, 0, 0.5);
  const double contrast = parameters.number("contrast", 0.35, 0, 1);
  const std::uint32_t seed = parameters.seed();
  return paintColor("fabric", sideOf(parameters), [=](double u, double v) {
    const double fu = u * columns - std::floor(u * columns) - 0.5;
    const double fv = v * rows - std::floor(v * rows) - 0.5;
    const double diamond = std::fabs(fu) + std::fabs(fv);
    const double weave = 0.92 + 0.08 * fractalNoise(seed, 32 * u, 32 * v, 3, 32);
    const bool line = std::fabs(diamond - 0.36) < 0.035 || diamond < 0.10;
    Rgb color = mix(ground, figure, line ? contrast : 0.0);
    const double edge = std::min(v, 1 - v);
    if (edge < border) {
      const double t = edge / border;
      color = t > 0.25 && t < 0.75 ? figure : mix(ground, Rgb(0.0f), 0.4);
    }
    return color * static_cast<float>(weave);
  });
}

// Alpha: 1 inside one pointed leaf with its foot at v = 0.
Texture makeLeafMask(ShapeParameters& parameters) {
  const double fullness = parameters.number("fullness", 0.45, 0.01, 0.5);
  return paintScalar("leafMask", sideOf(parameters, 128), [=](double u, double v) {
    // A ramp of a few texels puts the cut at the contour when it is sampled bilinearly.
    return 0.5 + 24 * leafShape(u, v, fullness);
  });
}

Texture makeFrondMask(ShapeParameters& parameters) {
  const int leaflets = parameters.integer("leaflets", 14, 1, 200);
  return paintScalar("frondMask", sideOf(parameters, 256),
                     [=](double u, double v) { return 0.5 + 4 * frondShape(u, v, leaflets); });
}

// The colors of a leaf: a paler rib and side veins.
Texture makeLeaf(ShapeParameters& parameters) {
  const Rgb blade = colorOf(parameters, "color", {0.08, 0.22, 0.04});
  const Rgb vein = colorOf(parameters, "color2", {0.25, 0.42, 0.12});
  const int veins = parameters.integer("veins", 7, 0, 100);
  const std::uint32_t seed = parameters.seed();
  return paintColor("leaf", sideOf(parameters, 128), [=](double u, double v) {
    const double s = std::fabs(u - 0.5) * 2;
    const double along = (v - 0.3 * s) * veins;
    const double across = std::fabs(along - std::round(along));
    const double rib = std::max(1 - s / 0.08, 0.6 * (1 - across / 0.1));
    const double patch = 0.5 + 0.5 * fractalNoise(seed, 4 * u, 4 * v, 4, 4);
    const Rgb color = mix(blade, vein, std::clamp(rib, 0.0, 1.0));
    return color * static_cast<float>(0.75 + 0.5 * patch);
  });
}

}  // namespace whit::procedural
