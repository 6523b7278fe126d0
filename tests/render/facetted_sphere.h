// A polyhedron with the vertex normals of a sphere.
#pragma once

#include <cmath>
#include <cstdint>

#include "pi.h"
#include "scene/mesh.h"

namespace whit::test {

// Approximates a sphere of radius 1 about the origin and has the sphere's own normals.
inline Mesh facettedSphere(std::uint32_t material, std::uint32_t rows = 16,
                           std::uint32_t columns = 32) {
  Mesh mesh;

  for (std::uint32_t row = 0; row <= rows; ++row) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      const double polar = kPi * row / rows, turn = 2 * kPi * column / columns;
      const Vec3f n(Vec3d(std::sin(polar) * std::cos(turn), std::cos(polar),
                          -std::sin(polar) * std::sin(turn)));
      mesh.positions.push_back(n);
      mesh.normals.push_back(n);
    }
  }

  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
      if (row != 0) mesh.triangles.push_back({a, b, a + 1});
      if (row != rows - 1) mesh.triangles.push_back({a + 1, b, b + 1});
    }
  }

  mesh.materials = {material};
  return mesh;
}

}  // namespace whit::test
