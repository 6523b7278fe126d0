// Laws of every shape: solids are closed, normals are of unit length and point outwards, indices
// are in range, and the bits are the same each time.
#include <gtest/gtest.h>

#include "shapes/map_parameters.h"
#include "shapes/mesh_measures.h"

namespace whit::test {
namespace {

using Parameters = std::map<std::string, Value>;

struct Case {
  std::string shape;
  Parameters parameters;
  std::string label;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.shape << c.label; }

std::string caseName(const testing::TestParamInfo<Case>& info) {
  return info.param.shape + info.param.label;
}

// These are solids whose every edge is shared by exactly two triangles.
std::vector<Case> solids() {
  return {{"sphere", {{"segments", 64.0}}, ""},
          {"sphere", {{"segments", 7.0}, {"rings", 5.0}, {"smooth", false}}, "Coarse"},
          {"sphere", {{"radius", 1.0e-3}, {"segments", 64.0}}, "Small"},
          {"icosphere", {}, ""},
          {"icosphere", {{"level", 0.0}}, "Coarsest"},
          {"cylinder", {}, ""},
          {"cone", {}, ""},
          {"cone", {{"topRadius", 0.4}, {"segments", 5.0}}, "Cut"},
          {"torus", {}, ""},
          {"box", {{"size", Vec3d{1, 2, 3}}}, ""},
          {"roundedBox", {{"size", Vec3d{1, 2, 3}}, {"radius", 0.2}}, ""},
          {"roundedBox", {{"size", Vec3d{0.7, 0.7, 0.7}}, {"radius", 0.1}, {"steps", 7.0}}, "Cube"},
          {"stairs", {}, ""},
          {"vase", {}, ""},
          {"vase", {{"profile", std::string("urn")}}, "Urn"},
          {"vase", {{"profile", std::string("pot")}}, "Pot"},
          {"tumbler", {}, ""},
          {"wall", {{"bays", 3.0}}, ""},
          {"wall", {{"sill", 0.8}, {"bays", 2.0}, {"margin", 0.5}}, "Window"},
          {"wall", {{"rise", 0.0}}, "Lintel"},
          {"arch", {}, ""},
          {"cornice", {}, ""},
          {"cornice", {{"inward", false}}, "Outward"},
          {"rock", {{"stretch", Vec3d{1, 0.6, 1.2}}}, ""}};
}

class Solid : public testing::TestWithParam<Case> {};

TEST_P(Solid, EveryEdgeJoinsTwoTrianglesOfOppositeDirection) {
  for (const ShapePart& part : generate(GetParam().shape, GetParam().parameters).parts) {
    ASSERT_FALSE(part.mesh.triangles.empty());
    EXPECT_EQ(openEdges(part.mesh), 0u);
    EXPECT_EQ(unpairedEdges(part.mesh), 0u);
  }
}

TEST_P(Solid, FacesOutwards) {
  for (const ShapePart& part : generate(GetParam().shape, GetParam().parameters).parts) {
    EXPECT_GT(volume(part.mesh), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Solid, testing::ValuesIn(solids()), caseName);

// These have several closed solids in a part. They may touch, so that four triangles may share an
// edge.
class Assembly : public testing::TestWithParam<Case> {};

TEST_P(Assembly, IsClosed) {
  const Shape shape = generate(GetParam().shape, GetParam().parameters);
  for (const ShapePart& part : shape.parts) {
    if (part.slot == "leaves") continue;
    EXPECT_EQ(openEdges(part.mesh), 0u) << part.slot;
    EXPECT_GT(volume(part.mesh), 0) << part.slot;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Assembly,
    testing::Values(Case{"column", {{"leaves", 0.0}}, ""},
                    Case{"column", {{"leaves", 0.0}, {"flutes", 20.0}}, "Fluted"},
                    Case{"colonnade", {{"leaves", 0.0}, {"columns", 4.0}}, ""},
                    Case{"colonnade", {{"leaves", 0.0}, {"engaged", true}}, "Engaged"},
                    Case{"balustrade", {}, ""}, Case{"tree", {{"leaves", 10.0}}, ""},
                    Case{"tree", {{"kind", std::string("conifer")}}, "Conifer"},
                    Case{"tree", {{"leafStyle", std::string("blobs")}}, "Blobs"},
                    Case{"plant", {}, ""}),
    caseName);

class EveryShape : public testing::TestWithParam<std::string> {};

TEST_P(EveryShape, HasUnitNormalsThatAgreeWithTheWinding) {
  constexpr double kUnit = 1e-6;  // three roundings to float
  for (const ShapePart& part : generate(GetParam()).parts) {
    const Mesh& mesh = part.mesh;
    EXPECT_TRUE(mesh.materials.empty());
    EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());

    if (mesh.normals.empty()) continue;
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());

    std::size_t against = 0;
    for (const Vec3f& n : mesh.normals) EXPECT_NEAR(length(Vec3d(n)), 1, kUnit);

    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3d face = areaVector(mesh, t);
      Vec3d mean;
      for (const std::uint32_t k : mesh.triangles[t]) mean += Vec3d(mesh.normals[k]);
      against += dot(face, mean) < 0;
    }

    // Strongly bent sheets (the tips of limbs, curled leaves) may have a few such triangles.
    EXPECT_LE(static_cast<double>(against), 0.02 * static_cast<double>(mesh.triangles.size()))
        << part.slot;
  }
}

TEST_P(EveryShape, KeepsIndicesInRangeAndCornersApart) {
  for (const ShapePart& part : generate(GetParam()).parts) {
    ASSERT_NE(part.mesh.triangles.empty(), part.mesh.spheres.empty()) << part.slot;
    for (const Vec3f& p : part.mesh.positions) ASSERT_TRUE(isFinite(p));
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      for (const std::uint32_t k : part.mesh.triangles[t]) {
        ASSERT_LT(k, part.mesh.positions.size());
      }
      ASSERT_GT(length(areaVector(part.mesh, t)), 0) << part.slot << " triangle " << t;
    }
  }
}

TEST_P(EveryShape, ComesOutTheSameEachTime) {
  const Shape a = generate(GetParam()), b = generate(GetParam());
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t k = 0; k < a.parts.size(); ++k) {
    EXPECT_EQ(a.parts[k].mesh.positions, b.parts[k].mesh.positions);
    EXPECT_EQ(a.parts[k].mesh.normals, b.parts[k].mesh.normals);
    EXPECT_EQ(a.parts[k].mesh.triangles, b.parts[k].mesh.triangles);
    EXPECT_EQ(a.parts[k].mesh.spheres, b.parts[k].mesh.spheres);
  }
  EXPECT_EQ(a.placements, b.placements);
}

std::vector<std::string> shapeNames() {
  std::vector<std::string> names;
  for (const auto& [name, generator] : shapeGenerators()) names.push_back(name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(shapeNames()),
                         [](const auto& info) { return info.param; });

TEST(Shapes, RefuseParametersOutOfRange) {
  EXPECT_THROW(generate("sphere", {{"segments", 2.0}}), Error);
  EXPECT_THROW(generate("sphere", {{"radius", -1.0}}), Error);
  EXPECT_THROW(generate("tumbler", {{"wall", 5.0}}), Error);
  EXPECT_THROW(generate("vase", {{"profile", std::string("bucket")}}), Error);
}

}  // namespace
}  // namespace whit::test
