// Which triangles end in which geometry, and in which order.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "unit/scene_builder.h"

namespace whit {
namespace {

using test::corner;
using test::expectError;
using test::faceOf;
using test::finalized;
using test::normalOf;
using test::sceneOf;
using test::square;
using test::whiteTexture;

TEST(Bake, OneUseIsBakedIntoTheWorld) {
  SceneDescription d = sceneOf(square());
  d.instances[0].toWorld = Affine::translation({10, 0, 0}) * Affine::scaling({2, 3, 1});
  const Scene scene = finalized(std::move(d));

  ASSERT_EQ(scene.geometries.size(), 1u);
  EXPECT_TRUE(scene.instances.empty());
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(corner(scene.triangles[0], 2), (Vec3d{12, 3, 0}));
  EXPECT_EQ(scene.lower, (Vec3f{10, 0, 0}));
  EXPECT_EQ(scene.upper, (Vec3f{12, 3, 0}));
  EXPECT_EQ(scene.instancedTriangles, 2u);
}

TEST(Bake, VertexColorsAreClampedAndWhiteWhereThereAreNone) {
  Mesh colored = square();
  for (Vec3f& p : colored.positions) p.z = 1;
  colored.colors = {{1, 0.5f, 0}, {2, -1, std::nanf("")}, {0, 0, 1}, {1, 1, 1}};

  SceneDescription d = sceneOf(square());
  d.objects[0].meshes.push_back(colored);
  Warnings warnings;
  const Scene scene = Scene::finalize(std::move(d), warnings);
  ASSERT_EQ(scene.colors.size(), scene.triangles.size());

  for (const float channel : scene.colors[0].color) EXPECT_EQ(channel, 1);
  const float wanted[] = {1, 0.5f, 0, 1, 0, 0, 0, 0, 1};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(scene.colors[2].color[i], wanted[i]) << i;
  EXPECT_EQ(test::warned(warnings, "vertex color out of range clamped"), 3u);

  SceneDescription white = sceneOf(square());
  white.objects[0].meshes[0].colors.assign(4, Rgb(1.0f));
  EXPECT_TRUE(finalized(std::move(white)).colors.empty());
}

// Whole repeats are subtracted from each set of coordinates on its own.
TEST(Bake, SecondUvsAreKeptBesideTheFirst) {
  SceneDescription d = sceneOf(square());
  d.textures.push_back(whiteTexture(TexelFormat::color));
  d.materials[0].emissionMap = 0;
  d.objects[0].meshes[0].secondUvs = {{20, 0}, {20.5f, 0}, {20, 20}, {std::nanf(""), 1}};

  Mesh without = square();
  for (Vec3f& p : without.positions) p.z = 1;
  d.objects[0].meshes.push_back(without);

  Warnings warnings;
  const Scene scene = Scene::finalize(std::move(d), warnings);

  ASSERT_EQ(scene.secondUvs.size(), scene.triangles.size());
  const float wanted[] = {0, 0, 0.5f, 0, 0, 20};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(scene.uvsOf(0, true)[i], wanted[i]) << i;
  EXPECT_EQ(scene.uvsOf(0, false), scene.triangles[0].uv);

  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(scene.uvsOf(2, true)[i], 0) << i;
  EXPECT_EQ(test::warned(warnings, "non-finite texture coordinate set to 0"), 1u);
  EXPECT_TRUE(finalized(sceneOf(square())).secondUvs.empty());
}

TEST(Bake, RecordsAgreeWithTheGeometry) {
  SceneDescription d = sceneOf(square());
  d.objects[0].meshes.push_back(square());
  d.objects.push_back({"twice", {square()}});
  d.instances.push_back({1, {}});
  d.instances.push_back({1, Affine::translation({0, 0, 4})});

  const Scene scene = finalized(std::move(d));
  ASSERT_EQ(scene.geometries.size(), 2u);

  std::size_t total = 0;
  for (const Geometry& g : scene.geometries) {
    EXPECT_EQ(g.firstTriangle, total);
    EXPECT_EQ(g.classBegin.back(), g.index.size());
    EXPECT_GT(g.position.capacity(), g.position.size());
    for (std::size_t i = 0; i < g.index.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(Vec3d(g.position[g.index[i][static_cast<std::size_t>(k)]]),
                  corner(scene.triangles[total + i], k));
      }
    }

    total += g.index.size();
  }

  EXPECT_EQ(total, scene.triangles.size());
}

TEST(Bake, IdentityLeavesPositionsBitIdentical) {
  Mesh mesh = square();
  mesh.positions = {{-0.0f, 1e-41f, 1.0f / 3}, {1e18f, -0.0f, 0.1f}, {0, 1, -1e-30f}, {5, 6, 7}};
  const std::vector<Vec3f> before = mesh.positions;

  const Scene scene = finalized(sceneOf(std::move(mesh)));
  const std::vector<Vec3f>& after = scene.geometries[0].position;
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(after[i][k]),
                std::bit_cast<std::uint32_t>(before[i][k]));
    }
  }
}

// H31: equal positions stay equal, shared or not, under a transform whose results are rounded.
TEST(Bake, UnsharedVerticesStayTogether) {
  Mesh mesh;
  mesh.name = "soup";
  mesh.positions = {{0.1f, 0.2f, 0.3f}, {1, 0, 0}, {0, 1, 0},
                    {0.1f, 0.2f, 0.3f}, {0, 1, 0}, {-1, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.materials = {0};

  SceneDescription d = sceneOf(mesh);
  d.instances[0].toWorld = Affine::rotation({1, 2, 3}, 17) * Affine::scaling({0.7, 1.3, 1.9});
  const Scene scene = finalized(std::move(d));

  EXPECT_EQ(corner(scene.triangles[0], 0), corner(scene.triangles[1], 0));
  EXPECT_EQ(corner(scene.triangles[0], 2), corner(scene.triangles[1], 1));
}

// H11: a mirroring transform keeps the outside.
TEST(Bake, MirroredObjectsKeepTheirOutside) {
  Mesh mesh = square();
  mesh.normals.assign(4, {1, 0, 1e-6f});
  SceneDescription d = sceneOf(mesh);
  d.instances[0].toWorld = Affine::scaling({-1e3, 1, 1e-3});

  const Scene scene = finalized(std::move(d));
  ASSERT_EQ(scene.normals.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(faceOf(scene.triangles[i]), (Vec3d{0, 0, 1}));
    // The inverse transpose gives (1 / -1e3, 0, 1e-6 * 1e3).
    EXPECT_FLOAT_EQ(normalOf(scene.normals[i], 0).x, -std::sqrt(0.5f));
    EXPECT_FLOAT_EQ(normalOf(scene.normals[i], 0).z, std::sqrt(0.5f));
  }
}

// The transform of normals is (1 / 2, 1, 1): the normal that leans along x keeps a length of 0.72,
// and the others have 1.
TEST(Bake, StretchedNormalsKeepTheProportionOfTheirLengths) {
  Mesh mesh = square();
  mesh.normals = {{0.8f, 0, 0.6f}, {0, 0.8f, 0.6f}, {0, 0, 1}, {0, 0, 1}};
  SceneDescription d = sceneOf(mesh);
  d.instances[0].toWorld = Affine::scaling({2, 1, 1});
  const NormalRecord record = finalized(std::move(d)).normals.at(0);

  const Vec3f wanted[] = {{0.4f, 0, 0.6f}, {0, 0.8f, 0.6f}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(length(Vec3d(normalOf(record, i)) - Vec3d(wanted[i])), 2e-7) << i;
  }
}

// A transform that keeps angles leaves unit vectors, and so does any transform if all three normals
// of a triangle have the same length.
TEST(Bake, NormalsOfEqualLengthsAreUnitVectors) {
  Mesh mesh = square();
  mesh.normals = {{0.8f, 0, 0.6f}, {0, 0.8f, 0.6f}, {0, 0, 1}, {0, 0, 1}};
  SceneDescription turned = sceneOf(mesh);
  turned.instances[0].toWorld = Affine::rotation({1, 2, 3}, 33) * Affine::scaling({-7, 7, 7});

  for (Vec3f& n : mesh.normals) n = {0.8f, 0, 0.6f};
  SceneDescription stretched = sceneOf(mesh);
  stretched.instances[0].toWorld = Affine::scaling({2, 1, 1});

  for (SceneDescription* d : {&turned, &stretched}) {
    const Scene scene = finalized(std::move(*d));
    ASSERT_EQ(scene.normals.size(), 2u);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(length(Vec3d(normalOf(scene.normals[0], i))), 1, 2e-7) << i;
    }
  }
}

TEST(Bake, ObjectsUsedMoreOftenAreInstanced) {
  SceneDescription d = sceneOf(square());
  d.objects.push_back({"unused", {square()}});
  d.materials.resize(2);
  d.objects.push_back({"pair", {square(), square()}});
  d.objects[2].meshes[1].materials = {1};  // otherwise its triangles would be duplicates
  d.instances.push_back({2, Affine::translation({0, 0, 5})});
  d.instances.push_back({2, Affine::translation({0, -3, 0}) * Affine::scaling({-1, 1, 1})});

  const Scene scene = finalized(std::move(d));
  ASSERT_EQ(scene.geometries.size(), 2u);
  EXPECT_EQ(scene.geometries[0].index.size(), 2u);
  EXPECT_EQ(scene.geometries[1].index.size(), 4u);
  EXPECT_EQ(scene.geometries[1].firstTriangle, 2u);
  EXPECT_EQ(scene.triangles.size(), 6u);

  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].geometry, 1u);
  EXPECT_EQ(scene.instances[0].toWorld, Affine::translation({0, 0, 5}));

  // An instanced object keeps its own space, whatever its first transform.
  EXPECT_EQ(corner(scene.triangles[2], 1), (Vec3d{1, 0, 0}));

  EXPECT_EQ(scene.instancedTriangles, 2u + 2 * 4);
  EXPECT_EQ(scene.lower, (Vec3f{-1, -3, 0}));
  EXPECT_EQ(scene.upper, (Vec3f{1, 1, 5}));
}

TEST(Bake, InstancedTrianglesAreCountedIn64Bits) {
  Mesh mesh;
  mesh.materials = {0};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  for (std::uint32_t i = 1; i <= 1u << 17; ++i) {
    mesh.positions.push_back({1, static_cast<float>(i), 0});
    mesh.triangles.push_back({0, i, i + 1});
  }

  SceneDescription d = sceneOf(mesh);  // 2^17 triangles
  for (int i = 1; i < 1 << 16; ++i) {
    d.instances.push_back({0, Affine::translation({0, 0, static_cast<double>(i)})});
  }
  EXPECT_EQ(finalized(std::move(d)).instancedTriangles, std::uint64_t{1} << 33);
}

TEST(Bake, GeometriesOfWhichNothingIsLeftTakeTheirInstancesAlong) {
  Mesh line = square();
  line.triangles = {{0, 1, 1}};
  SceneDescription d = sceneOf(line);
  d.objects.push_back({"good", {square()}});
  for (const std::uint32_t object : {0u, 1u, 1u}) d.instances.push_back({object, {}});

  const Scene scene = finalized(std::move(d));
  ASSERT_EQ(scene.geometries.size(), 2u);
  ASSERT_EQ(scene.instances.size(), 2u);
  for (const InstanceRecord& i : scene.instances) EXPECT_EQ(i.geometry, 1u);
  EXPECT_EQ(scene.geometries[1].index.size(), 2u);
}

TEST(Bake, InstancesMayNotLeaveTheRangeOfCoordinates) {
  Mesh mesh = square();
  for (Vec3f& p : mesh.positions) p *= 1e10f;
  SceneDescription d = sceneOf(mesh);
  d.instances.push_back({0, Affine::scaling(Vec3d(1e9))});
  expectError(ExitStatus::badScene, {"instance", "1.844e18"}, [&] { finalized(std::move(d)); });
}

TEST(Bake, TrianglesAreSortedByClassAndKeepTheirOrder) {
  SceneDescription d = sceneOf(square());
  d.textures.push_back(whiteTexture(TexelFormat::data));
  d.materials.resize(4);  // material i makes class i
  for (std::size_t i = 0; i < 4; ++i) {
    d.materials[i].castsShadow = (i & kNoShadowBit) == 0;
    if (i & kMaskedBit) d.materials[i].alphaMap = 0;
  }

  Mesh mesh;
  mesh.name = "mixed";
  for (int i = 0; i < 12; ++i) {
    const float x = static_cast<float>(i);
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
    const auto v = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({v, v + 1, v + 2});
    mesh.materials.push_back(static_cast<std::uint32_t>(i * 7 % 4));
  }

  Mesh behind = mesh;
  for (Vec3f& p : behind.positions) p.z = -1;
  d.objects[0].meshes = {mesh, square(), behind};
  d.objects[0].meshes[1].materials = {2};

  const Scene scene = finalized(std::move(d));
  const Geometry& g = scene.geometries[0];
  EXPECT_EQ(g.classBegin, (std::array<std::uint32_t, 5>{0, 6, 12, 20, 26}));

  for (std::uint32_t c = 0; c < 4; ++c) {
    for (std::uint32_t i = g.classBegin[c]; i < g.classBegin[c + 1]; ++i) {
      EXPECT_EQ(scene.triangles[i].material, c);
      // Within a class triangles are sorted by mesh and then by their place in the mesh, so that
      // indices of vertices grow.
      EXPECT_TRUE(i == g.classBegin[c] || g.index[i][0] >= g.index[i - 1][0]) << i;
    }
  }
}

// Rays are transformed into an instance by the inverse of its transform, which here has factors
// from 1 to 1e18 and more.
TEST(Bake, InstancesBeyondTheRangeOfRaysAreLeftOut) {
  const auto twoOf = [](const Vec3d& scale) {
    SceneDescription d = sceneOf(square());
    d.instances = {{0, Affine::translation({3, 0, 0})}, {0, Affine::scaling(scale)}};
    return d;
  };

  for (const Vec3d& scale : {Vec3d{1e-18, 1, 1}, Vec3d(1e-13), Vec3d{1, 1, 1e-18}, Vec3d(1e13)}) {
    Warnings warnings;
    const Scene scene = Scene::finalize(twoOf(scale), warnings);
    EXPECT_EQ(scene.instances.size(), 1u) << scale.x;
    EXPECT_EQ(scene.instancedTriangles, 2u) << scale.x;
    EXPECT_EQ(warnings.entries().count("instance too small or too flat to be traced left out"), 1u);

    Warnings strict(true);
    expectError(ExitStatus::badScene, {"too small or too flat"},
                [&] { Scene::finalize(twoOf(scale), strict); });
  }

  for (const Vec3d& scale : {Vec3d{1e-15, 1, 1}, Vec3d(1e-11), Vec3d(1e11), Vec3d{-1, 1, 1}}) {
    EXPECT_EQ(finalized(twoOf(scale)).instances.size(), 2u) << scale.x;
  }
}

}  // namespace
}  // namespace whit
