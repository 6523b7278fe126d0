#include "oracle/shapes.h"

#include <numbers>

namespace oracle {

Mesh box() {
  Mesh mesh;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) mesh.positions.push_back({x, y, z});
    }
  }

  // Each face as a quad, counter-clockwise from outside.
  for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{
           {0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

Mesh tetrahedron() {
  Mesh mesh;
  mesh.positions = {{0.5, 0.5, 0.5}, {0.5, -0.5, -0.5}, {-0.5, 0.5, -0.5}, {-0.5, -0.5, 0.5}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return mesh;
}

Mesh pane() {
  Mesh mesh;
  mesh.positions = {{-0.5, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 0, -0.5}, {-0.5, 0, -0.5}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh turnedPane(double repeats) {
  Mesh mesh = pane();
  for (auto& [u, v] : mesh.uvs) {
    const double across = u, up = v;
    u = asFloat(repeats * (1.7 * across + 0.6 * up - 0.9));
    v = asFloat(repeats * (1.2 * up - 0.5 * across - 0.3));
  }
  return mesh;
}

Mesh ball(int segments, int rings) {
  Mesh mesh;
  const auto add = [&](double polar, double turn) {
    const Vec n = asFloat(
        Vec{std::sin(polar) * std::cos(turn), std::cos(polar), -std::sin(polar) * std::sin(turn)});
    mesh.normals.push_back(n);
    mesh.positions.push_back(n * 0.5);
  };

  // The upper pole, the rings below it, and the lower pole.
  add(0, 0);
  for (int ring = 1; ring < rings; ++ring) {
    for (int i = 0; i < segments; ++i) {
      add(std::numbers::pi * ring / rings, 2 * std::numbers::pi * i / segments);
    }
  }
  add(std::numbers::pi, 0);

  // Fans at both poles, and two triangles for each quad between two rings.
  const int bottom = static_cast<int>(mesh.positions.size()) - 1;
  const auto at = [&](int ring, int i) { return 1 + (ring - 1) * segments + i % segments; };
  for (int i = 0; i < segments; ++i) {
    mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      const int a = at(ring, i), b = at(ring, i + 1), c = at(ring + 1, i), d = at(ring + 1, i + 1);
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
    mesh.triangles.push_back({at(rings - 1, i), bottom, at(rings - 1, i + 1)});
  }

  return mesh;
}

}  // namespace oracle
