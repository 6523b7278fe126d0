// Laws of every shape: solids are closed, normals are of unit length and point outwards, indices
// are in range, and the bits are the same each time.
#include <gtest/gtest.h>

#include "shapes/generated.h"
#include "shapes/mesh_measures.h"

namespace whit::test {
namespace {

struct Solid {
  std::string shape, members;  // of a scene file
};

// Expects each part to be closed and to face outwards, and each of its edges to be shared by
// exactly two triangles, or in an assembly by any number, half of them in each direction.
void expectClosed(const std::vector<Solid>& solids, bool isAssembly) {
  for (const std::size_t row : indices(solids)) {
    const auto& [name, members] = solids[row];
    for (const ShapePart& part : generate(name, members).parts) {
      if (part.slot == "leaves") continue;
      SCOPED_TRACE("row " + std::to_string(row) + ": " + part.slot + " of " + name);
      const auto edges = edgesOf(part.mesh);
      EXPECT_FALSE(edges.empty());
      EXPECT_TRUE(std::ranges::all_of(edges, [&](const auto& edge) {
        return edge.second.balance == 0 && (isAssembly || edge.second.triangles == 2);
      }));
      EXPECT_GT(volume(part.mesh), 0);
    }
  }
}

TEST(Shapes, SolidsAreClosedAndFaceOutwards) {
  expectClosed({{"sphere", "'segments': 64"},
                {"sphere", "'segments': 7, 'rings': 5, 'smooth': false"},
                {"sphere", "'radius': 1e-3, 'segments': 64"},
                {"icosphere", ""},
                {"icosphere", "'level': 0"},
                {"cylinder", ""},
                {"cone", ""},
                {"cone", "'topRadius': 0.4, 'segments': 5"},
                {"torus", ""},
                {"box", "'size': [1, 2, 3]"},
                {"roundedBox", "'size': [1, 2, 3], 'radius': 0.2"},
                {"roundedBox", "'size': [0.7, 0.7, 0.7], 'radius': 0.1, 'steps': 7"},
                {"stairs", ""},
                {"vase", ""},
                {"vase", "'profile': 'urn'"},
                {"vase", "'profile': 'pot'"},
                {"tumbler", ""},

                {"wall", "'bays': 3"},
                {"wall", "'sill': 0.8, 'bays': 2, 'margin': 0.5"},
                {"wall", "'rise': 0"},
                {"arch", ""},
                {"cornice", ""},
                {"cornice", "'inward': false"},
                {"rock", "'stretch': [1, 0.6, 1.2]"}},
               false);
}

// These have several closed solids in a part. They may touch, so that four triangles may share an
// edge.
TEST(Shapes, AssembliesAreClosedAndFaceOutwards) {
  expectClosed({{"column", "'leaves': 0"},
                {"column", "'leaves': 0, 'flutes': 20"},
                {"colonnade", "'leaves': 0, 'columns': 4"},
                {"colonnade", "'leaves': 0, 'engaged': true"},
                {"balustrade", ""},
                {"tree", "'leaves': 10"},
                {"tree", "'kind': 'conifer'"},
                {"tree", "'leafStyle': 'blobs'"},
                {"plant", ""}},
               true);
}

void expectIndicesInRangeAndCornersApart(const Mesh& mesh) {
  ASSERT_NE(mesh.triangles.empty(), mesh.spheres.empty());
  for (const Vec3f& p : mesh.positions) ASSERT_TRUE(isFinite(p));
  for (const std::size_t t : indices(mesh.triangles)) {
    for (const std::uint32_t k : mesh.triangles[t]) ASSERT_LT(k, mesh.positions.size());
    ASSERT_GT(length(areaVector(mesh, t)), 0) << "triangle " << t;
  }
}

void expectUnitNormalsThatAgreeWithTheWinding(const Mesh& mesh) {
  constexpr double kUnit = 1e-6;  // three roundings to float
  if (mesh.normals.empty()) return;
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Vec3f& n : mesh.normals) EXPECT_NEAR(length(Vec3d(n)), 1, kUnit);

  std::size_t against = 0;
  for (const std::size_t t : indices(mesh.triangles)) {
    Vec3d mean;
    for (const std::uint32_t k : mesh.triangles[t]) mean += Vec3d(mesh.normals[k]);
    against += dot(areaVector(mesh, t), mean) < 0;
  }

  // Strongly bent sheets (the tips of limbs, curled leaves) may have a few such triangles.
  EXPECT_LE(50 * against, mesh.triangles.size());
}

TEST(EveryShape, IsSoundAndComesOutTheSameEachTime) {
  for (const auto& [name, generator] : shapeGenerators()) {
    const Shape shape = generate(name), again = generate(name);
    ASSERT_EQ(shape.parts.size(), again.parts.size()) << name;
    EXPECT_EQ(shape.placements, again.placements) << name;

    for (const std::size_t k : indices(shape.parts)) {
      const auto& [slot, mesh] = shape.parts[k];
      SCOPED_TRACE(slot + " of " + name);
      EXPECT_TRUE(mesh.materials.empty());
      EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
      expectIndicesInRangeAndCornersApart(mesh);
      expectUnitNormalsThatAgreeWithTheWinding(mesh);

      const Mesh& other = again.parts[k].mesh;
      EXPECT_EQ(mesh.positions, other.positions);
      EXPECT_EQ(mesh.normals, other.normals);
      EXPECT_EQ(mesh.triangles, other.triangles);
      EXPECT_EQ(mesh.spheres, other.spheres);
    }
  }
}

TEST(Shapes, RefuseParametersOutOfRange) {
  EXPECT_THROW(generate("sphere", "'segments': 2"), Error);
  EXPECT_THROW(generate("sphere", "'radius': -1"), Error);
  EXPECT_THROW(generate("tumbler", "'wall': 5"), Error);
  EXPECT_THROW(generate("vase", "'profile': 'bucket'"), Error);
}

}  // namespace
}  // namespace whit::test
