#include <cmath>

#include "make/patterns/noise.h"
#include "make/patterns/paint.h"

namespace whit::procedural {
namespace {

ScalarFormula plasterHeight(int cells, std::uint32_t seed) {
  return [=](double u, double v) {
    const double rough = fractalNoise(seed, cells * u, cells * v, 5, cells);
    // Strokes of the trowel: stretched, so the periods differ.
    const double strokes = gradientNoise(seed + 8, cells * u, 0.25 * cells * v * 4, cells);
    return rough + 0.3 * strokes;
  };
}

}  // namespace

// Fractal noise between two colors; `contrast` sharpens it. For lawns, soil, clouds of any kind.
Texture makeNoise(ShapeParameters& parameters) {
  const Rgb a = colorOf(parameters, "color", {0.10, 0.22, 0.05});
  const Rgb b = colorOf(parameters, "color2", {0.22, 0.26, 0.09});
  const int cells = parameters.integer("cells", 8, 1, 1024);
  const int octaves = parameters.integer("octaves", 6, 1, 12);
  const double contrast = parameters.number("contrast", 1, 0, 100);
  const std::uint32_t seed = parameters.seed();
  return paintColor("noise", sideOf(parameters), [=](double u, double v) {
    const double n = fractalNoise(seed, cells * u, cells * v, octaves, cells);
    return mix(a, b, std::clamp(0.5 + contrast * n, 0.0, 1.0));
  });
}

Texture makePlaster(ShapeParameters& parameters) {
  const Rgb color = colorOf(parameters, "color", {0.66, 0.56, 0.42});
  const Rgb color2 = colorOf(parameters, "color2", {0.50, 0.40, 0.29});
  const int cells = parameters.integer("cells", 6, 1, 1024);
  const double stain = parameters.number("stain", 0.5, 0, 1);
  const std::uint32_t seed = parameters.seed();
  const ScalarFormula height = plasterHeight(cells, seed);
  return paintColor("plaster", sideOf(parameters), [=](double u, double v) {
    const double cloud = 0.5 + 0.6 * fractalNoise(seed + 40, 3 * u, 3 * v, 5, 3);
    const Rgb base = mix(color, color2, std::clamp(stain * cloud, 0.0, 1.0));
    return base * static_cast<float>(1 + 0.12 * height(u, v));
  });
}

Texture makePlasterNormals(ShapeParameters& parameters) {
  const int cells = parameters.integer("cells", 6, 1, 1024);
  const double depth = parameters.number("depth", 0.004, 0, 0.5);
  const ScalarFormula height = plasterHeight(cells, parameters.seed());
  return paintNormals("plasterNormals", sideOf(parameters),
                      [=](double u, double v) { return depth * height(u, v); });
}

// Veins along the zero lines of warped noise.
Texture makeMarble(ShapeParameters& parameters) {
  const Rgb color = colorOf(parameters, "color", {0.80, 0.78, 0.74});
  const Rgb vein = colorOf(parameters, "color2", {0.32, 0.31, 0.32});
  const int cells = parameters.integer("cells", 3, 1, 256);
  const double sharpness = parameters.number("sharpness", 10, 0.1, 1000);
  const std::uint32_t seed = parameters.seed();
  return paintColor("marble", sideOf(parameters), [=](double u, double v) {
    const double x = cells * u, y = cells * v;
    const double warp = 0.7 * fractalNoise(seed + 20, x, y, 5, cells);
    const double coarse = 1 - std::fabs(fractalNoise(seed, x + warp, y + 0.5 * warp, 4, cells));
    const double fine =
        1 - std::fabs(fractalNoise(seed + 60, 2 * x - warp, 2 * y + warp, 4, 2 * cells));
    const double depth = std::pow(std::clamp(coarse, 0.0, 1.0), sharpness) +
                         0.4 * std::pow(std::clamp(fine, 0.0, 1.0), 1.6 * sharpness);
    const Rgb cloudy = color * static_cast<float>(1 + 0.12 * warp);
    return mix(cloudy, vein, std::min(1.0, 0.8 * depth));
  });
}

// Boards along u, each with its own grain.
Texture makeWood(ShapeParameters& parameters) {
  const Rgb color = colorOf(parameters, "color", {0.36, 0.20, 0.09});
  const Rgb color2 = colorOf(parameters, "color2", {0.19, 0.09, 0.035});
  const int boards = parameters.integer("boards", 4, 1, 256);
  const double rings = parameters.number("rings", 5, 0, 200);
  const std::uint32_t seed = parameters.seed();
  return paintColor("wood", sideOf(parameters), [=](double u, double v) {
    const int board = std::min(static_cast<int>(v * boards), boards - 1);
    const double y = v * boards - board, own = unitHash(seed, board);
    const auto boardSeed = seed + 100u * static_cast<std::uint32_t>(board);
    const double sway = fractalNoise(boardSeed + 7, 2 * u, y, 3, 2);
    const double ring =
        0.5 + 0.5 * std::sin(6.283185307 * (rings * (y - 0.5) * (1 + own) + 2 * sway));
    const double fibre = 0.5 + 0.5 * fractalNoise(boardSeed + 9, 4 * u, 64 * y, 3, 64);
    const double gap = smoothStep(0, 0.015, std::min(y, 1 - y));
    const Rgb grain = mix(color, color2, std::clamp(0.65 * ring + 0.35 * fibre, 0.0, 1.0));
    return grain * static_cast<float>((0.85 + 0.3 * own) * (0.25 + 0.75 * gap));
  });
}

}  // namespace whit::procedural
