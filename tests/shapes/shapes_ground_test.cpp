// Terrain, trees and forests.
#include <gtest/gtest.h>

#include <cmath>

#include "shapes/generated.h"
#include "shapes/mesh_measures.h"

namespace whit::test {
namespace {

TEST(Terrain, HasTheTrianglesAskedFor) {
  for (const char* triangles : {"'triangles': 20000", "'triangles': 20100"}) {
    EXPECT_EQ(meshOf("terrain", triangles).triangles.size(), 20000u);
  }
}

// Returns the ground on a grid of `cells` x `cells`.
Mesh terrainOf(int size, int cells, int seed = 5) {
  return meshOf("terrain",
                joined("'seed': ", seed, ", 'size': ", size, ", 'triangles': ", 2 * cells * cells));
}

TEST(Terrain, LiesOnTheSameGroundAtEveryResolution) {
  const Mesh coarse = terrainOf(300, 40), fine = terrainOf(300, 80);
  for (std::size_t j = 0; j <= 40; ++j) {
    for (std::size_t i = 0; i <= 40; ++i) {
      const Vec3f& p = coarse.positions[j * 41 + i];
      ASSERT_EQ(p, fine.positions[2 * j * 81 + 2 * i]);
      ASSERT_LE(std::fabs(p.x), 150);
    }
  }
}

TEST(Terrain, FacesUpEverywhere) {
  const Mesh mesh = terrainOf(300, 64);
  for (const std::size_t t : indices(mesh.triangles)) ASSERT_GT(areaVector(mesh, t).y, 0);
  for (const Vec3f& n : mesh.normals) ASSERT_GT(n.y, 0);
}

TEST(Terrain, ChangesWithItsSeed) {
  EXPECT_NE(terrainOf(300, 10, 1).positions, terrainOf(300, 10, 2).positions);
}

TEST(Forest, StandsOnTheGroundOfItsTerrain) {
  constexpr int kCells = 1000;
  const Mesh terrain = terrainOf(100, kCells);
  const Shape shape = generate("forest", "'seed': 5, 'size': 100, 'trees': 150, 'leaves': 50");
  ASSERT_EQ(shape.placements.size(), 150u);

  // Roots go into the ground by up to two per cent of the largest scale. The terrain differs from
  // the ground between its nodes.
  constexpr double kSink = 0.05, kBetween = 0.05;

  for (const Affine& place : shape.placements) {
    const double u = (place.p.x / 100 + 0.5) * kCells, v = (0.5 - place.p.z / 100) * kCells;
    const auto at = [&](double i, double j) {
      return double{terrain.positions[static_cast<std::size_t>(j * (kCells + 1) + i)].y};
    };

    const double i = std::floor(u), j = std::floor(v);
    const double y = std::lerp(std::lerp(at(i, j), at(i + 1, j), u - i),
                               std::lerp(at(i, j + 1), at(i + 1, j + 1), u - i), v - j);

    EXPECT_LE(place.p.y, y + kBetween);
    EXPECT_GE(place.p.y, y - kBetween - kSink);
    EXPECT_NEAR(place.y.x, 0, 1e-12) << "upright";
    EXPECT_GT(place.determinant(), 0);
  }
}

TEST(Forest, MultipliesOutToTheTrianglesAskedFor) {
  const Shape shape = generate("forest", "'triangles': 200000, 'leaves': 300");
  std::size_t tree = 0;
  for (const ShapePart& part : shape.parts) tree += part.mesh.triangles.size();
  const std::size_t total = tree * shape.placements.size();
  EXPECT_LE(total, 200000u);
  EXPECT_GT(total + tree, 200000u);
}

TEST(Tree, HasItsLeavesAndReachesItsHeight) {
  for (const char* kind : {"broadleaf", "conifer"}) {
    const Shape shape =
        generate("tree", joined("'leaves': 700, 'height': 10, 'kind': '", kind, "'"));

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
