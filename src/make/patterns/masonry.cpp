#include <cmath>

#include "make/patterns/noise.h"
#include "make/patterns/paint.h"

namespace whit::procedural {
namespace {

// Stones in rows; where in the layout a point lies.
struct Stone {
  int column, row;    // of the stone, wrapped
  double across, up;  // within the stone, 0 to 1
  double edge;        // distance to the stone's edge, in parts of the texture's side
};

struct Layout {
  int columns, rows;
  double bond;   // shift of every other row, in stones
  double joint;  // width of the joints, in parts of a row
  double bevel;  // width of the stones' rounded rim, the same

  Stone at(double u, double v) const {
    const int row = std::min(static_cast<int>(v * rows), rows - 1);
    const double x = u * columns + (row % 2 == 1 ? bond : 0.0);
    const int column = static_cast<int>(std::floor(x));
    const double fu = x - std::floor(x), fv = v * rows - row;
    const double edge = std::min(std::min(fu, 1 - fu) / columns, std::min(fv, 1 - fv) / rows);
    return {column % columns, row, fu, fv, edge};
  }
  // 0 in the joint, 1 on the face.
  double face(const Stone& s) const {
    const double half = 0.5 * joint / rows;
    return smoothStep(half, half + std::max(bevel, 1e-6) / rows, s.edge);
  }
};

Layout readLayout(ShapeParameters& parameters, int columns, int rows, double bond, double joint,
                  double bevel) {
  Layout layout{};
  layout.columns = parameters.integer("columns", columns, 1, 1024);
  layout.rows = parameters.integer("rows", rows, 1, 1024);
  layout.bond = parameters.number("bond", bond, 0, 1);
  layout.joint = parameters.number("joint", joint, 0, 0.9);
  layout.bevel = parameters.number("bevel", bevel, 0, 0.9);
  return layout;
}

// Heights in parts of the texture's side: joints lie `depth` deep, stones are a little uneven.
Texture masonryNormals(ShapeParameters& parameters, const std::string& name, const Layout& layout,
                       double depthFallback, double roughFallback) {
  const double depth = parameters.number("depth", depthFallback, 0, 0.5);
  const double rough = parameters.number("rough", roughFallback, 0, 10);
  const std::uint32_t seed = parameters.seed();
  return paintNormals(name, sideOf(parameters), [=](double u, double v) {
    const Stone s = layout.at(u, v);
    const double grain = fractalNoise(seed + 11, 16 * u, 16 * v, 4, 16);
    const double lean = (unitHash(seed + 5, s.column, s.row) - 0.5) * (s.across - 0.5) +
                        (unitHash(seed + 6, s.column, s.row) - 0.5) * (s.up - 0.5);
    return depth * layout.face(s) * (1 + 0.5 * rough * lean) + 0.35 * depth * rough * grain;
  });
}

Layout brickLayout(ShapeParameters& parameters) {
  return readLayout(parameters, 6, 12, 0.5, 0.10, 0.10);
}

Layout tileLayout(ShapeParameters& parameters) {
  return readLayout(parameters, 4, 4, 0, 0.02, 0.015);
}

}  // namespace

Texture makeBricks(ShapeParameters& parameters) {
  const Layout layout = brickLayout(parameters);
  const Rgb color = colorOf(parameters, "color", {0.42, 0.17, 0.10});
  const Rgb color2 = colorOf(parameters, "color2", {0.28, 0.10, 0.07});
  const Rgb mortar = colorOf(parameters, "mortar", {0.45, 0.42, 0.38});
  const double stain = parameters.number("stain", 0.25, 0, 1);
  const std::uint32_t seed = parameters.seed();
  return paintColor("bricks", sideOf(parameters), [=](double u, double v) {
    const Stone s = layout.at(u, v);
    const double grain = 0.5 + 0.5 * fractalNoise(seed + 11, 16 * u, 16 * v, 5, 16);
    const double cloud = 0.5 + 0.5 * fractalNoise(seed + 3, 3 * u, 3 * v, 4, 3);
    const Rgb stone = mix(color, color2, unitHash(seed, s.column, s.row));
    const Rgb base = mix(mortar, stone, layout.face(s));
    return base * static_cast<float>((1 - 0.5 * stain + stain * (grain - 0.5)) *
                                     (1 - stain * (cloud - 0.5)));
  });
}

Texture makeBrickNormals(ShapeParameters& parameters) {
  const Layout layout = brickLayout(parameters);
  return masonryNormals(parameters, "bricksNormals", layout, 0.006, 0.8);
}

// Polished slabs in two colors, chequered, with veins that differ from slab to slab.
Texture makeTiles(ShapeParameters& parameters) {
  const Layout layout = tileLayout(parameters);
  const Rgb color = colorOf(parameters, "color", {0.62, 0.56, 0.48});
  const Rgb color2 = colorOf(parameters, "color2", {0.34, 0.16, 0.10});
  const Rgb joint = colorOf(parameters, "mortar", {0.10, 0.09, 0.08});
  const double variation = parameters.number("variation", 0.15, 0, 1);
  const double veins = parameters.number("veins", 0.35, 0, 1);
  const std::uint32_t seed = parameters.seed();
  return paintColor("tiles", sideOf(parameters, 1024), [=](double u, double v) {
    const Stone s = layout.at(u, v);
    const bool odd = (s.column + s.row) % 2 == 1;
    const double own = unitHash(seed, s.column, s.row);
    // Each slab is cut from another part of the block.
    const double x = s.across + 17 * own, y = s.up + 29 * unitHash(seed + 1, s.column, s.row);
    const double warp = fractalNoise(seed + 20, 1.5 * x, 1.5 * y, 4);
    const double line = 1 - std::fabs(fractalNoise(seed + 30, 1.2 * x + warp, 1.6 * y, 4));
    const double vein = std::pow(std::clamp(line, 0.0, 1.0), 14);
    const double cloud = 0.5 + 0.5 * warp;
    Rgb slab = odd ? color2 : color;
    slab = slab * static_cast<float>(1 + variation * (own - 0.5) + 0.5 * veins * (cloud - 0.5));
    slab = mix(slab, odd ? Rgb(0.6f) : slab * 0.45f, veins * vein);
    return mix(joint, slab, layout.face(s));
  });
}

Texture makeTileNormals(ShapeParameters& parameters) {
  const Layout layout = tileLayout(parameters);
  return masonryNormals(parameters, "tilesNormals", layout, 0.002, 0.05);
}

Texture makeRoof(ShapeParameters& parameters) {
  const int columns = parameters.integer("columns", 8, 1, 1024);
  const int rows = parameters.integer("rows", 6, 1, 1024);
  const Rgb color = colorOf(parameters, "color", {0.45, 0.18, 0.09});
  const Rgb color2 = colorOf(parameters, "color2", {0.30, 0.13, 0.08});
  const std::uint32_t seed = parameters.seed();
  return paintColor("roof", sideOf(parameters), [=](double u, double v) {
    const double fu = u * columns - std::floor(u * columns);
    const double fv = v * rows - std::floor(v * rows);
    const double own = unitHash(seed, static_cast<int>(u * columns), static_cast<int>(v * rows));
    const double grain = fractalNoise(seed + 2, 16 * u, 16 * v, 4, 16);
    const double gutter = smoothStep(0, 0.14, std::min(fu, 1 - fu));
    const double shade = (0.45 + 0.55 * gutter) * (fv > 0.93 ? 0.6 : 1.0) * (1 + 0.2 * grain);
    return mix(color, color2, own) * static_cast<float>(shade);
  });
}

Texture makeRoofNormals(ShapeParameters& parameters) {
  const int columns = parameters.integer("columns", 8, 1, 1024);
  const int rows = parameters.integer("rows", 6, 1, 1024);
  const double depth = parameters.number("depth", 0.03, 0, 0.5);
  // Rounded pans lie in overlapping rows.
  return paintNormals("roofNormals", sideOf(parameters), [=](double u, double v) {
    const double fu = u * columns - std::floor(u * columns), fv = v * rows - std::floor(v * rows);
    return depth * (std::sqrt(std::max(0.0, 1 - 4 * (fu - 0.5) * (fu - 0.5))) - 0.6 * fv);
  });
}

}  // namespace whit::procedural
