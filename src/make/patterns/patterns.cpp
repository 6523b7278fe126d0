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

ScalarFormula plasterHeight(int cells, std::uint32_t seed) {
  return [=](double u, double v) {
    const double rough = fractalNoise(seed, cells * u, cells * v, 5, cells);
    // Strokes of the trowel: stretched, so the periods differ.
    const double strokes = gradientNoise(seed + 8, cells * u, 0.25 * cells * v * 4, cells);
    return rough + 0.3 * strokes;
  };
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
