#include "make/shapes/generators.h"

#include <numbers>

#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

// Units of length that one texture repeat covers; 0 stretches one repeat over the face.
double repeatOf(ShapeParameters& parameters, double fallback) {
  return parameters.number("uvRepeat", fallback, 0, 1e9);
}

double side(ShapeParameters& parameters, const char* key, double fallback) {
  return parameters.number(key, fallback, 1e-6, 1e9);
}

}  // namespace

// Faces up, centered on the origin: width along x, depth along z.
Shape makeQuad(ShapeParameters& parameters) {
  const double width = side(parameters, "width", 2), depth = side(parameters, "depth", 2);
  const double repeat = repeatOf(parameters, 0);
  MeshBuilder builder(MeshBuilder::Shading::flat);
  builder.sheet(1, 1, [&](int u, int v) {
    const Uv uv = repeat > 0 ? Uv{u * width / repeat, v * depth / repeat} : Uv{1.0 * u, 1.0 * v};
    return SurfacePoint{{(u - 0.5) * width, 0, (0.5 - v) * depth}, {0, 1, 0}, uv};
  });
  return singlePart(builder.take("quad"));
}

Shape makeBox(ShapeParameters& parameters) {
  const Vec3d size = parameters.vector("size", {2, 2, 2});
  const double repeat = repeatOf(parameters, 1);
  const Vec3d half = abs(size) / 2.0;
  MeshBuilder builder(MeshBuilder::Shading::flat);
  builder.box(-half, half, repeat > 0 ? repeat : std::max(maxComponent(abs(size)), 1e-12));
  return singlePart(builder.take("box"));
}

// A cube whose six faces are grids; each point is pushed out from the inner box by the radius, so
// neighboring faces compute the same points along their common edges.
Shape makeRoundedBox(ShapeParameters& parameters) {
  const Vec3d half = max(abs(parameters.vector("size", {2, 2, 2})) / 2.0, Vec3d(1e-9));
  const double least = std::min(half.x, std::min(half.y, half.z));
  const double radius = parameters.number("radius", 0.1 * least, 1e-9, 1e9);
  const int steps = parameters.integer("steps", 4, 1, 256);
  const double r = std::min(radius, least);
  // Half of a rounding on each side of the flat middle, in equal angles.
  const int n = 2 * steps + 1;
  const auto coordinate = [&](int i, double h) {
    const int k = i <= steps ? steps - i : i - steps - 1;
    const double c = (h - r) + (k == steps ? r : r * std::tan(std::numbers::pi / 4 * k / steps));
    return i <= steps ? -c : c;
  };
  MeshBuilder builder;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1 : -1;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    builder.sheet(n, n, [&](int i, int j) {
      const int first = sign > 0 ? i : n - i;  // mirrored, so that the face points outwards
      Vec3d p;
      p[axis] = sign * ((half[axis] - r) + r);
      p[a] = coordinate(first, half[a]);
      p[b] = coordinate(j, half[b]);
      // At the face's rim the coordinate is the very one the neighboring face holds fixed.
      const Vec3d inner = max(min(p, half - Vec3d(r)), Vec3d(r) - half);
      const Vec3d out = normalized(p - inner);
      return SurfacePoint{
          inner + out * r, out, {static_cast<double>(first) / n, static_cast<double>(j) / n}};
    });
  }
  return singlePart(builder.take("roundedBox"));
}

// A flight climbing towards -z, one closed solid: `steps` steps of `rise` and `run`.
Shape makeStairs(ShapeParameters& parameters) {
  const int steps = parameters.integer("steps", 5, 1, 1000);
  const double width = side(parameters, "width", 2) / 2, rise = side(parameters, "rise", 0.17);
  const double run = side(parameters, "run", 0.3), repeat = side(parameters, "uvRepeat", 1);
  using Corners = std::array<Vec3d, 4>;
  MeshBuilder builder(MeshBuilder::Shading::flat);
  const double w = width;
  for (int k = 0; k < steps; ++k) {
    const double z0 = -k * run, z1 = -(k + 1) * run, y1 = (k + 1) * rise;
    builder.plate(Corners{{{-w, k * rise, z0}, {w, k * rise, z0}, {w, y1, z0}, {-w, y1, z0}}},
                  repeat);
    builder.plate(Corners{{{-w, y1, z0}, {w, y1, z0}, {w, y1, z1}, {-w, y1, z1}}}, repeat);
    builder.plate(Corners{{{-w, 0, z1}, {w, 0, z1}, {w, 0, z0}, {-w, 0, z0}}}, repeat);
    // The sides in bricks of one rise, so that every corner meets a corner.
    for (int m = 0; m <= k; ++m) {
      const double a = m * rise, b = (m + 1) * rise;
      builder.plate(Corners{{{w, a, z0}, {w, a, z1}, {w, b, z1}, {w, b, z0}}}, repeat);
      builder.plate(Corners{{{-w, a, z1}, {-w, a, z0}, {-w, b, z0}, {-w, b, z1}}}, repeat);
    }
  }
  const double back = -steps * run;
  for (int m = 0; m < steps; ++m) {
    const double a = m * rise, b = (m + 1) * rise;
    builder.plate(Corners{{{w, a, back}, {-w, a, back}, {-w, b, back}, {w, b, back}}}, repeat);
  }
  return singlePart(builder.take("stairs"));
}

}  // namespace whit::procedural
