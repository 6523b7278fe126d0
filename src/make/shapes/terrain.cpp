#include "make/shapes/terrain.h"

#include <numbers>

#include "make/patterns/noise.h"
#include "make/shapes/generators.h"
#include "make/shapes/mesh_builder.h"

namespace whit::procedural {

Ground::Ground(ShapeParameters& parameters)
    : seed_(static_cast<std::uint32_t>(parameters.integer("seed", 1, 0, 1 << 30))),
      size_(parameters.number("size", 400, 1e-3, 1e7)),
      height_(parameters.number("height", 0.15 * size_, 0, 1e7)),
      valley_(parameters.number("valley", 0.12, 0, 1)),  // half width, in parts of the size
      floor_(parameters.number("floor", 0.04 * height_, 0, 1e7)) {}  // depth below zero

double Ground::height(double x, double z) const {
  const double u = x / size_, v = z / size_;
  const double bend =
      0.35 * valley_ * std::sin(7 * v) + 0.12 * gradientNoise(seed_ + 70, 0.5, 3 * v);
  // Half as steep along z: a long basin that closes at both ends.
  const double away = std::hypot(u - bend * smoothStep(0, 0.2, std::fabs(v)), 0.5 * v);
  const double slope = smoothStep(0.55 * valley_, 2.6 * valley_ + 0.08, away);
  const double warpU = u + 0.08 * fractalNoise(seed_ + 40, 3 * u, 3 * v, 2);
  const double warpV = v + 0.08 * fractalNoise(seed_ + 50, 3 * u + 9, 3 * v, 2);
  const double ridges = ridgedNoise(seed_, 3.2 * warpU + 5, 3.2 * warpV, 7);
  const double hills = 0.5 + 0.5 * fractalNoise(seed_ + 20, 6 * u, 6 * v, 6);
  const double meadow = 0.05 * fractalNoise(seed_ + 30, 14 * u, 14 * v, 4);
  const double shore =
      smoothStep(0.35 * valley_, 0.9 * valley_, away + 0.3 * valley_ * (hills - 0.5));
  return -floor_ * (1 - shore) +
         height_ * (0.03 * shore + meadow * shore + slope * (0.75 * ridges + 0.25 * hills));
}

Vec3d Ground::normal(double x, double z, double step) const {
  const double dx = height(x + step, z) - height(x - step, z);
  const double dz = height(x, z + step) - height(x, z - step);
  return normalized(Vec3d{-dx, 2 * step, -dz}, Vec3d{0, 1, 0});
}

// A square of `triangles` triangles (rounded down to 2 n^2), centered on the origin.
Shape makeTerrain(ShapeParameters& parameters) {
  const Ground ground(parameters);
  const double triangles = parameters.number("triangles", 131072, 2, 2e8);
  const double repeat = parameters.number("uvRepeat", 0.01 * ground.size(), 1e-6, 1e9);
  const int n = std::max(1, static_cast<int>(std::sqrt(triangles / 2)));
  const double size = ground.size();
  MeshBuilder builder;
  builder.smoothSheet(
      n, n, false,
      [&](int i, int j) {
        const double x = (static_cast<double>(i) / n - 0.5) * size;
        const double z = (0.5 - static_cast<double>(j) / n) * size;
        return Vec3d{x, ground.height(x, z), z};
      },
      [&](int i, int j) {
        return Uv{size / repeat * i / n, size / repeat * j / n};
      });
  return singlePart(builder.take("terrain"));
}

// A boulder or a lump of ice: a sphere pushed in and out by noise, one closed surface.
Shape makeRock(ShapeParameters& parameters) {
  const double radius = parameters.number("radius", 1, 1e-6, 1e9);
  const double roughness = parameters.number("roughness", 0.3, 0, 0.9);
  const double frequency = parameters.number("frequency", 1.3, 0, 100);
  const Vec3d stretch = parameters.vector("stretch", {1, 1, 1});
  const auto seed = static_cast<std::uint32_t>(parameters.integer("seed", 1, 0, 1 << 30));
  auto [points, triangles] = icosphereMesh(parameters.integer("level", 4, 0, 8));
  const bool smooth = parameters.flag("smooth", true);
  std::vector<Vec3d> normals(points.size());
  std::vector<Uv> uvs;
  for (Vec3d& p : points) {
    uvs.push_back({0.5 + std::atan2(-p.z, p.x) / (2 * std::numbers::pi), 0.5 + p.y / 2});
    double push = 0, amplitude = 1;
    Vec3d q = p * frequency + Vec3d(0.37);
    for (std::uint32_t octave = 0; octave < 4; ++octave) {
      push += amplitude * gradientNoise3(seed + octave, q.x, q.y, q.z);
      amplitude *= 0.45;
      q = q * 2.1;
    }
    p = p * stretch * (radius * std::max(0.1, 1 + roughness * push));
  }
  for (const auto& [a, b, c] : triangles) {
    const Vec3d n = cross(points[b] - points[a], points[c] - points[a]);
    for (const std::uint32_t k : {a, b, c}) normals[k] += n;
  }
  MeshBuilder builder(smooth ? MeshBuilder::Shading::smooth : MeshBuilder::Shading::flat);
  for (std::size_t k = 0; k < points.size(); ++k) builder.vertex({points[k], normals[k], uvs[k]});
  for (const auto& [a, b, c] : triangles) builder.triangle(a, b, c);
  return singlePart(builder.take("rock"));
}

}  // namespace whit::procedural
