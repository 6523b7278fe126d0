#include "scene/mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit {
namespace {

TEST(TransformMesh, NormalsBecomeUnitVectorsOrZero) {
  Mesh mesh;
  mesh.normals = {{0, 0, 2}, {0, 3e-30f, 4e-30f}, {0, 0, 0}};
  transform(mesh, Affine{});
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
  EXPECT_FLOAT_EQ(mesh.normals[1].y, 0.6f);
  EXPECT_FLOAT_EQ(mesh.normals[1].z, 0.8f);
  EXPECT_EQ(mesh.normals[2], Vec3f{});

  mesh.normals[0] = {0, NAN, 1};
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

}  // namespace
}  // namespace whit
