#include "scene/mesh.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace whit {
namespace {

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

Mesh triangle() {
  Mesh mesh;
  mesh.positions = {{-0.0f, 1e-40f, 0.1f}, {16777215, 0, 3e37f}, {1.0f / 3, 1, 0}};
  mesh.normals = {{0, 0, 2}, {0, 3e-30f, 4e-30f}, {0, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(TransformMesh, IdentityLeavesEveryBitOfThePositions) {
  const Mesh before = triangle();
  Mesh after = before;
  transform(after, Affine{});
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(bits(after.positions[i][k]), bits(before.positions[i][k]));
    }
  }
  EXPECT_EQ(after.triangles, before.triangles);
}

TEST(TransformMesh, NormalsBecomeUnitVectorsOrZero) {
  Mesh mesh = triangle();
  transform(mesh, Affine{});
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
  EXPECT_FLOAT_EQ(mesh.normals[1].y, 0.6f);
  EXPECT_FLOAT_EQ(mesh.normals[1].z, 0.8f);
  EXPECT_EQ(mesh.normals[2], Vec3f{});

  mesh.normals[0] = {0, std::nanf(""), 1};
  transform(mesh, Affine::scaling(Vec3d(1e-100)));  // cofactors of 1e-200
  EXPECT_EQ(mesh.normals[0], Vec3f{});
  EXPECT_FLOAT_EQ(mesh.normals[1].y, 0.6f);
}

TEST(TransformMesh, PositionsAreRoundedOnce) {
  Mesh mesh;
  mesh.positions = {{16777216, 0, 0}};
  // In float, 2^24 + 0.5 would be rounded before the second translation.
  transform(mesh, Affine::translation({-16777216, 0, 0}) * Affine::translation({0.5, 0, 0}));
  EXPECT_EQ(mesh.positions[0].x, 0.5f);
}

TEST(TransformMesh, MirroringFlipsTheWinding) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}};
  transform(mesh, Affine::scaling({-1, 1, 1}));

  const auto& t = mesh.triangles[0];
  const Vec3f face = cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                           mesh.positions[t[2]] - mesh.positions[t[0]]);
  EXPECT_EQ(face, (Vec3f{0, 0, 1}));
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));

  transform(mesh, Affine::scaling({1, 1, -1}));
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, -1}));
}

}  // namespace
}  // namespace whit
