#include "make/patterns/noise.h"

#include <numbers>

#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

struct ClothGrid {
  ClothGrid(ShapeParameters& parameters, int columns, int rows)
      : nx(parameters.integer("nx", columns, 1, 4096)),
        ny(parameters.integer("ny", rows, 1, 4096)),
        repeat(parameters.number("uvRepeat", 0, 0, 1e9)),
        seed(parameters.seed()) {}
  Uv uv(int i, int j, double width, double height) const {
    const double s = static_cast<double>(i) / nx, t = static_cast<double>(j) / ny;
    return repeat > 0 ? Uv{s * width / repeat, t * height / repeat} : Uv{s, t};
  }

  int nx, ny;
  double repeat;  // units of length that a texture covers; 0: it is stretched over the cloth
  std::uint32_t seed;
};

}  // namespace

// Hangs from y = 0 down to -height in the x-y plane, seen from +z; folds deepen downwards and
// wander a little; `gather` pulls the sides together at the given part of the height.
Shape makeCurtain(ShapeParameters& parameters) {
  const double width = parameters.number("width", 2, 1e-3, 1e6);
  const double height = parameters.number("height", 3, 1e-3, 1e6);
  const int folds = parameters.integer("folds", 7, 0, 1000);
  const double foldDepth = parameters.number("foldDepth", 0.08, 0, 1e6);
  const double gather = parameters.number("gather", 0, 0, 0.9);
  const double gatherAt = parameters.number("gatherAt", 0.6, 0.05, 0.95);
  const double sag = parameters.number("sag", 0, 0, 1e6);
  const ClothGrid n(parameters, 64, 48);
  MeshBuilder builder;
  builder.smoothSheet(
      n.nx, n.ny, false,
      [&](int i, int j) {
        const double s = static_cast<double>(i) / n.nx, t = 1 - static_cast<double>(j) / n.ny;
        const double d = (t - gatherAt) / (t < gatherAt ? gatherAt : 2 * (1 - gatherAt));
        const double waist = 1 - gather * (1 - smoothStep(0, 1, std::fabs(d)));
        const double wander = 0.35 * fractalNoise(n.seed, 2.5 * s + 7, 1.7 * t + 3, 3);
        const double wave = std::cos(2 * std::numbers::pi * (folds * s + wander));
        const double swing = foldDepth * fractalNoise(n.seed + 9, 1.3 * s, 1.5 * t + 0.5, 2);
        // Gathered cloth has nowhere to go but into deeper folds.
        const double deep = foldDepth * (0.35 + 0.65 * t) * (0.6 + 0.4 / waist);
        const double dip = sag * (4 * s * (1 - s)) * (1 - 0.5 * t);
        return Vec3d{(s - 0.5) * width * waist, -height * t - dip, deep * wave + t * swing};
      },
      [&](int i, int j) { return n.uv(i, j, width, height); });
  return singlePart(builder.take("curtain"));
}

// Spans along x between two bars at y = 0 and sags in between, with creases across the span; width
// along x, depth along z. Faces down, where it is looked at from.
Shape makeCanopy(ShapeParameters& parameters) {
  const double width = parameters.number("width", 6, 1e-3, 1e6);
  const double depth = parameters.number("depth", 2, 1e-3, 1e6);
  const double sag = parameters.number("sag", 0.8, 0, 1e6);
  const double ripple = parameters.number("ripple", 0.06, 0, 1e6);
  const int ripples = parameters.integer("ripples", 5, 0, 1000);
  const ClothGrid n(parameters, 96, 32);
  MeshBuilder builder;
  builder.smoothSheet(
      n.nx, n.ny, false,
      [&](int i, int j) {
        const double s = static_cast<double>(i) / n.nx, t = static_cast<double>(j) / n.ny;
        const double belly = 4 * s * (1 - s);
        const double wave =
            std::cos(2 * std::numbers::pi * ripples * t + 3 * gradientNoise(n.seed, 2 * s, 3 * t));
        // Pinned at the bars' ends, the middle of each edge hangs in a little.
        const double inward = 1 - 0.18 * belly;
        return Vec3d{(s - 0.5) * width,
                     -sag * belly + ripple * wave * std::sqrt(belly) -
                         0.15 * sag * belly * fractalNoise(n.seed + 5, 2 * s, 2 * t, 2),
                     (t - 0.5) * depth * inward};
      },
      [&](int i, int j) { return n.uv(i, j, width, depth); });
  return singlePart(builder.take("canopy"));
}

}  // namespace whit::procedural
