// How bad triangles, texture coordinates and normals are repaired.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "unit/scene_builder.h"
#include "verify/scene_builder.h"

namespace whit {
namespace {

using namespace test;

const std::string kDegenerate = "degenerate triangle dropped";
const std::string kBadCorner = "triangle with a non-finite or enormous corner dropped";
const std::string kBadIndex = "triangle with a vertex index out of range dropped";

// H23: degenerate triangles are dropped.
TEST(Repairing, DegenerateTrianglesAreDroppedAndCounted) {
  Mesh mesh = square();
  const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    verify::addTriangle(mesh, {a, b, c});
  };

  mesh.triangles.push_back({1, 1, 2});             // repeated index
  add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});            // collinear
  add({3, 3, 3}, {4, 4, 4}, {3, 3, 3});            // repeated position
  const float x = -1113.45459f, z = -56.2396317f;  // after pbrt's bad cases: one line
  add({x, -79.049614f, z}, {x, -87.0922699f, z}, {x, -79.2090149f, z});
  add({0, 0, 9}, {1, 0, 9}, {0, 1e-20f, 9});            // thin but with an area: stays
  add({0, 0, 9}, {1e-12f, 0, 9}, {0, 1e-12f, 9});       // tiny: stays (H24)
  add({1e-30f, 0, 0}, {0, 1e-30f, 0}, {0, 0, 1e-30f});  // squares vanish in float: stays

  Warnings warnings;
  const Scene scene = finalized(mesh, &warnings);
  EXPECT_EQ(scene.triangles.size(), 2u + 3);
  EXPECT_EQ(warned(warnings, kDegenerate), 4u);
  EXPECT_EQ(warnings.entries().at(kDegenerate).first, "mesh 'square', triangle 2");
  Warnings strict(true);
  expectError(ExitStatus::badScene, {"mesh 'square', triangle 2", kDegenerate},
              [&] { finalized(mesh, &strict); });
  EXPECT_EQ(scene.upper, (Vec3f{1, 1, 9}));
}

TEST(Repairing, MeshesOfWhichNothingIsLeftAreCounted) {
  constexpr char kNothing[] = "mesh with nothing to draw: all its triangles were dropped";
  Mesh mesh = square();
  Warnings some, all;

  mesh.triangles = {{0, 0, 1}, {0, 1, 2}};
  finalized(mesh, &some);
  EXPECT_EQ(warned(some, kNothing), 0u);

  mesh.triangles = {{0, 0, 1}, {0, 1, 9}};
  finalized(mesh, &all);
  EXPECT_EQ(warned(all, kNothing), 1u);
}

// H15: duplicates are dropped, except those of glass.
TEST(Repairing, TrianglesInEachOthersPlaceAreDroppedButOfGlass) {
  for (const bool glass : {false, true}) {
    Mesh mesh = square();
    for (const Vec3f& p : square().positions) {
      mesh.positions.push_back({p.x == 0 ? -0.0f : p.x, p.y, p.z});
    }
    mesh.triangles.push_back({1, 2, 0});  // the first, turned
    mesh.triangles.push_back({6, 5, 4});  // the first, reversed, with vertices of its own
    mesh.triangles.push_back({0, 1, 3});  // shares two corners with each

    SceneDescription description = sceneOf(mesh);
    description.materials[0].transmission = Rgb(glass ? 1.0f : 0.0f);
    Warnings warnings;
    const Scene scene = finalized(description, &warnings);

    EXPECT_EQ(scene.triangles.size(), 2u + (glass ? 3 : 1));
    EXPECT_EQ(warned(warnings, "triangle in the place of another of its material dropped"),
              glass ? 0u : 2u);
  }
}

// The same square three times, the last one with other texture coordinates or another alpha of its
// vertices: holes of an alpha map are elsewhere there.
TEST(Repairing, MaskedTrianglesInEachOthersPlaceAreDroppedIfTheirHolesAreInOnePlace) {
  for (const bool masked : {false, true}) {
    for (const auto coordinates : {&Mesh::uvs, &Mesh::secondUvs}) {
      SceneDescription description = sceneOf(square());
      std::vector<Mesh>& meshes = description.objects[0].meshes;
      meshes[0].*coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      meshes.resize(3, meshes[0]);
      (meshes[2].*coordinates)[0] = {0.5f, 0};
      description.textures = {whiteTexture(TexelFormat::data)};
      if (masked) description.materials[0].alphaMap = 0;

      // Both triangles of a square have the corner that differs.
      EXPECT_EQ(finalized(description).triangles.size(), masked ? 4u : 2u);
    }
  }
}

// H27: a bad vertex drops only its triangles.
TEST(Repairing, BadVerticesTakeOnlyTheirTriangles) {
  for (const float bad : {NAN, INFINITY, -INFINITY, 1e19f, -1e19f}) {
    Mesh mesh = square();
    mesh.positions[3].y = bad;  // of the second triangle only

    Warnings warnings;
    const Scene scene = finalized(mesh, &warnings);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(warned(warnings, kBadCorner), 1u);
    EXPECT_EQ(scene.lower, (Vec3f{0, 0, 0}));
    EXPECT_EQ(scene.upper, (Vec3f{1, 1, 0}));
  }

  Mesh large = square();
  large.positions[2].y = 1e18f;
  EXPECT_EQ(finalized(large).triangles.size(), 2u);
}

TEST(Repairing, IndicesOutOfRangeTakeTheirTriangle) {
  Mesh mesh = square();
  mesh.triangles.push_back({0, 1, 4});
  mesh.triangles.push_back({0xffffffffu, 1, 2});

  // The vertices of the other mesh must not be reached.
  Warnings warnings;
  EXPECT_EQ(finalized(sceneOf(mesh, above(square())), &warnings).triangles.size(), 4u);
  EXPECT_EQ(warned(warnings, kBadIndex), 2u);
}

TEST(Repairing, TextureCoordinatesThatAreNotFiniteBecomeZero) {
  Mesh mesh = square();
  mesh.uvs = {{0.25f, NAN}, {1, 0}, {1, 1}, {-INFINITY, 1}};

  Warnings warnings;
  const Scene scene = finalized(mesh, &warnings);
  EXPECT_EQ(scene.triangles[0].uv[0], 0.25f);
  EXPECT_EQ(scene.triangles[0].uv[1], 0);
  EXPECT_EQ(scene.triangles[1].uv[4], 0);
  // Triangles count each of their corners: vertex 0 has two bad ones, vertex 3 has one.
  EXPECT_EQ(warned(warnings, "non-finite texture coordinate set to 0"), 3u);
}

// H68: coordinates are moved by whole repeats, so that the picture is the same and all bits are
// left for the fraction.
TEST(Repairing, FarTextureCoordinatesAreRecenteredWhereTheyRepeat) {
  Mesh mesh = square();
  mesh.uvs = {{1000000.25f, -20.5f}, {1000001.5f, -17}, {1000000, -30}, {1000002, -18}};

  using Uv = std::vector<float>;
  const auto firstUv = [&](Wrap wrapU, Wrap wrapV = Wrap::repeat) {
    SceneDescription d = sceneOf(mesh);
    // Another texture of the material repeats.
    d.textures = {whiteTexture(TexelFormat::color), whiteTexture(TexelFormat::data)};
    d.textures[0].wrapU = wrapU;
    d.textures[0].wrapV = wrapV;
    d.materials[0].diffuseMap = 0;
    d.materials[0].alphaMap = 1;
    const Scene scene = finalized(d);
    return Uv(scene.triangles[0].uv, scene.triangles[0].uv + 6);
  };

  EXPECT_EQ(firstUv(Wrap::repeat), (Uv{0.25f, 9.5f, 1.5f, 13, 0, 0}));
  EXPECT_EQ(firstUv(Wrap::clamp), (Uv{1000000.25f, 9.5f, 1000001.5f, 13, 1000000, 0}));
  EXPECT_EQ(firstUv(Wrap::repeat, Wrap::mirror), (Uv{0.25f, -20.5f, 1.5f, -17, 0, -30}));

  mesh.uvs[1] = {16, -16};  // one corner is near 0: nothing is moved
  EXPECT_EQ(firstUv(Wrap::repeat), (Uv{1000000.25f, -20.5f, 16, -16, 1000000, -30}));
}

// H34: unusable normals are replaced by the face's.
TEST(Repairing, NormalsOfNoUseBecomeTheFaces) {
  Mesh mesh = square();
  mesh.normals = {{0, 0, 0}, {0, 3, 4}, {NAN, 0, 1}, {0, 0, -1}};
  Warnings warnings;
  const Scene scene = finalized(mesh, &warnings);

  ASSERT_EQ(scene.normals.size(), 2u);
  EXPECT_EQ(normalOf(scene.normals[0], 0), (Vec3f{0, 0, 1}));
  EXPECT_EQ(normalOf(scene.normals[0], 1), (Vec3f{0, 0.6f, 0.8f}));
  EXPECT_EQ(normalOf(scene.normals[0], 2), (Vec3f{0, 0, 1}));
  EXPECT_EQ(normalOf(scene.normals[1], 2), (Vec3f{0, 0, -1}));  // opposite, but a direction
  EXPECT_EQ(warned(warnings, "zero or non-finite normal replaced by the face's"), 4u);
}

TEST(Repairing, FlatNormalsAreNotKept) {
  Mesh flat = square();
  flat.normals.assign(4, {0, 0, 7});
  EXPECT_TRUE(finalized(flat).normals.empty());
}

TEST(Repairing, MeshesWithoutNormalsHaveTheFacesBesideOnesThatHave) {
  Mesh smooth = above(square());
  smooth.normals.assign(4, {1, 0, 1});

  const Scene scene = finalized(sceneOf(square(), smooth));
  ASSERT_EQ(scene.normals.size(), 4u);
  EXPECT_EQ(normalOf(scene.normals[0], 1), (Vec3f{0, 0, 1}));
  EXPECT_FLOAT_EQ(normalOf(scene.normals[2], 1).x, std::sqrt(0.5f));
}

// H29: whatever bits a mesh has, there is an error or a scene that can be rendered.
TEST(Repairing, GarbageNeverReachesTheTables) {
  std::mt19937 random(29);
  const auto word = [&] { return static_cast<std::uint32_t>(random()); };
  const auto anyFloat = [&] {
    return word() % 4 ? std::bit_cast<float>(word()) : static_cast<float>(word() % 5);
  };
  const auto anyVec = [&] { return Vec3f{anyFloat(), anyFloat(), anyFloat()}; };

  std::size_t kept = 0;
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE(round);
    Mesh mesh;
    for (std::uint32_t i = word() % 40; i-- > 0;) {
      mesh.positions.push_back(anyVec());
      mesh.normals.push_back(anyVec());
      mesh.uvs.push_back({anyFloat(), anyFloat()});
    }
    for (std::uint32_t i = word() % 60; i-- > 0;) {
      mesh.triangles.push_back({word() % 41, word() % 41, word() % 41});
    }

    mesh.materials = {0};
    SceneDescription d = sceneOf(mesh);
    d.textures.push_back(whiteTexture(TexelFormat::color));
    d.materials[0].diffuseMap = 0;
    const Scene scene = finalized(d);

    ASSERT_TRUE(isFinite(scene.lower) && isFinite(scene.upper));
    for (const TriangleRecord& t : scene.triangles) {
      for (const float x : t.position) ASSERT_LE(std::abs(x), 1.844e18f);
      for (const float x : t.uv) ASSERT_TRUE(std::isfinite(x));
    }

    for (const NormalRecord& n : scene.normals) {
      for (int i = 0; i < 3; ++i) {
        // Each of three components is rounded to float by half an ulp.
        ASSERT_NEAR(length(Vec3d(normalOf(n, i))), 1, 2e-7);
      }
    }

    kept += scene.triangles.size();
  }
  EXPECT_GT(kept, 500u);  // so that there was something to check
}

}  // namespace
}  // namespace whit
