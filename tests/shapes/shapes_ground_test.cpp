// Terrain, trees and forests.
#include <gtest/gtest.h>

#include "make/shapes/terrain.h"
#include "shapes/map_parameters.h"
#include "shapes/mesh_measures.h"

namespace whit::test {
namespace {

TEST(Terrain, HasTheTrianglesAskedFor) {
  EXPECT_EQ(generate("terrain", {{"triangles", 20000.0}}).parts[0].mesh.triangles.size(), 20000u);
  EXPECT_EQ(generate("terrain", {{"triangles", 20100.0}}).parts[0].mesh.triangles.size(), 20000u);
}

TEST(Terrain, LiesOnTheSameGroundAtEveryResolution) {
  MapParameters parameters({{"seed", 5.0}, {"size", 300.0}});
  const procedural::Ground ground(parameters);
  for (const double triangles : {5000.0, 12800.0}) {
    const Shape shape =
        generate("terrain", {{"seed", 5.0}, {"size", 300.0}, {"triangles", triangles}});
    for (const Vec3f& p : shape.parts[0].mesh.positions) {
      // x and z were rounded to float by up to 8e-6; slopes stay below 10.
      ASSERT_NEAR(p.y, ground.height(p.x, p.z), 3e-4);
      ASSERT_LE(std::fabs(p.x), 150);
    }
  }
}

TEST(Terrain, FacesUpEverywhere) {
  const Mesh mesh = generate("terrain", {{"triangles", 8192.0}}).parts[0].mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) ASSERT_GT(areaVector(mesh, t).y, 0);
  for (const Vec3f& n : mesh.normals) ASSERT_GT(n.y, 0);
}

TEST(Terrain, ChangesWithItsSeed) {
  const Mesh a = generate("terrain", {{"triangles", 200.0}, {"seed", 1.0}}).parts[0].mesh;
  const Mesh b = generate("terrain", {{"triangles", 200.0}, {"seed", 2.0}}).parts[0].mesh;
  EXPECT_NE(a.positions, b.positions);
}

TEST(Forest, StandsOnTheGroundOfItsTerrain) {
  MapParameters parameters({{"seed", 3.0}, {"size", 500.0}});
  const procedural::Ground ground(parameters);
  const Shape shape =
      generate("forest", {{"seed", 3.0}, {"size", 500.0}, {"trees", 150.0}, {"leaves", 50.0}});
  ASSERT_EQ(shape.placements.size(), 150u);
  constexpr double kSink = 0.05;  // roots go in by up to two per cent of the largest scale
  for (const Affine& place : shape.placements) {
    const double y = ground.height(place.p.x, place.p.z);
    EXPECT_LE(place.p.y, y);
    EXPECT_GE(place.p.y, y - kSink);
    EXPECT_NEAR(place.y.x, 0, 1e-12) << "upright";
    EXPECT_GT(place.determinant(), 0);
  }
}

TEST(Forest, MultipliesOutToTheTrianglesAskedFor) {
  const Shape shape = generate("forest", {{"triangles", 200000.0}, {"leaves", 300.0}});
  std::size_t tree = 0;
  for (const ShapePart& part : shape.parts) tree += part.mesh.triangles.size();
  const std::size_t total = tree * shape.placements.size();
  EXPECT_LE(total, 200000u);
  EXPECT_GT(total + tree, 200000u);
}

TEST(Tree, HasItsLeavesAndReachesItsHeight) {
  for (const char* kind : {"broadleaf", "conifer"}) {
    const Shape shape =
        generate("tree", {{"kind", std::string(kind)}, {"leaves", 700.0}, {"height", 10.0}});
    ASSERT_EQ(shape.parts.size(), 2u);
    EXPECT_EQ(shape.parts[0].slot, "bark");
    EXPECT_EQ(shape.parts[1].slot, "leaves");
    EXPECT_EQ(shape.parts[1].mesh.triangles.size(), 1400u);
    float high = 0;
    for (const Vec3f& p : shape.parts[0].mesh.positions) high = std::max(high, p.y);
    EXPECT_GT(high, 6) << kind;
    EXPECT_LT(high, 15) << kind;
  }
}

}  // namespace
}  // namespace whit::test
