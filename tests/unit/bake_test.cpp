// Which triangles end in which geometry, and in which order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "unit/scene_builder.h"

namespace whit {
namespace {

using namespace test;

TEST(Bake, OneUseIsBakedIntoTheWorld) {
  const Scene scene =
      finalized(placedAs(square(), Affine::translation({10, 0, 0}) * Affine::scaling({2, 3, 1})));
  ASSERT_EQ(scene.geometries.size(), 1u);
  EXPECT_TRUE(scene.instances.empty());
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(corner(scene.triangles[0], 2), (Vec3d{12, 3, 0}));
  EXPECT_EQ(scene.lower, (Vec3f{10, 0, 0}));
  EXPECT_EQ(scene.upper, (Vec3f{12, 3, 0}));
  EXPECT_EQ(scene.instancedTriangles, 2u);
}

TEST(Bake, VertexColorsAreClampedAndWhiteWhereThereAreNone) {
  Mesh colored = above(square());
  colored.colors = {{1, 0.5f, 0}, {2, -1, NAN}, {0, 0, 1}, {1, 1, 1}};

  Warnings warnings;
  const Scene scene = finalized(sceneOf(square(), colored), &warnings);
  ASSERT_EQ(scene.colors.size(), scene.triangles.size());

  for (const float channel : scene.colors[0].color) EXPECT_EQ(channel, 1);
  const float wanted[] = {1, 0.5f, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_TRUE(std::ranges::equal(scene.colors[2].color, wanted));
  EXPECT_EQ(warned(warnings, "vertex color out of range clamped"), 3u);

  SceneDescription white = sceneOf(square());
  white.objects[0].meshes[0].colors.assign(4, Rgb(1.0f));
  EXPECT_TRUE(finalized(white).colors.empty());
}

// Whole repeats are subtracted from each set of coordinates on its own.
TEST(Bake, SecondUvsAreKeptBesideTheFirst) {
  SceneDescription d = sceneOf(square(), above(square()));
  d.textures.push_back(whiteTexture(TexelFormat::color));
  d.materials[0].emissionMap = 0;
  d.objects[0].meshes[0].secondUvs = {{20, 0}, {20.5f, 0}, {20, 20}, {NAN, 1}};

  Warnings warnings;
  const Scene scene = finalized(d, &warnings);

  ASSERT_EQ(scene.secondUvs.size(), scene.triangles.size());
  const float wanted[] = {0, 0, 0.5f, 0, 0, 20};
  EXPECT_TRUE(std::equal(wanted, wanted + 6, scene.uvsOf(0, true)));
  EXPECT_EQ(scene.uvsOf(0, false), scene.triangles[0].uv);

  for (const auto i : indices(6)) EXPECT_EQ(scene.uvsOf(2, true)[i], 0) << i;
  EXPECT_EQ(warned(warnings, "non-finite texture coordinate set to 0"), 1u);
  EXPECT_TRUE(finalized(square()).secondUvs.empty());
}

TEST(Bake, RecordsAgreeWithTheGeometry) {
  SceneDescription d = sceneOf(square(), square());
  d.objects.push_back({"twice", {square()}});
  d.instances.push_back({1, {}});
  d.instances.push_back({1, Affine::translation({0, 0, 4})});

  const Scene scene = finalized(d);
  ASSERT_EQ(scene.geometries.size(), 2u);

  std::size_t total = 0;
  for (const Geometry& g : scene.geometries) {
    EXPECT_EQ(g.firstTriangle, total);
    EXPECT_EQ(g.classBegin.back(), g.index.size());
    EXPECT_GT(g.position.capacity(), g.position.size());
    for (const auto i : indices(g.index)) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(Vec3d(g.position[g.index[i][k]]), corner(scene.triangles[total + i], k));
      }
    }

    total += g.index.size();
  }

  EXPECT_EQ(total, scene.triangles.size());
}

TEST(Bake, IdentityLeavesPositionsBitIdentical) {
  Mesh mesh = square();
  mesh.positions = {{-0.0f, 1e-41f, 1.0f / 3}, {1e18f, -0.0f, 0.1f}, {0, 1, -1e-30f}, {5, 6, 7}};
  const std::vector<Vec3f> after = finalized(mesh).geometries[0].position;
  ASSERT_EQ(after.size(), 4u);
  EXPECT_EQ(std::memcmp(after.data(), mesh.positions.data(), 4 * sizeof(Vec3f)), 0);
}

// H31: equal positions stay equal, shared or not, under a transform whose results are rounded.
TEST(Bake, UnsharedVerticesStayTogether) {
  Mesh mesh = square();
  mesh.positions = {{0.1f, 0.2f, 0.3f}, {1, 0, 0}, {0, 1, 0},
                    {0.1f, 0.2f, 0.3f}, {0, 1, 0}, {-1, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Scene scene =
      finalized(placedAs(mesh, Affine::rotation({1, 2, 3}, 17) * Affine::scaling({0.7, 1.3, 1.9})));

  EXPECT_EQ(corner(scene.triangles[0], 0), corner(scene.triangles[1], 0));
  EXPECT_EQ(corner(scene.triangles[0], 2), corner(scene.triangles[1], 1));
}

// H11: a mirroring transform keeps the outside.
TEST(Bake, MirroredObjectsKeepTheirOutside) {
  Mesh mesh = square();
  mesh.normals.assign(4, {1, 0, 1e-6f});
  const Scene scene = finalized(placedAs(mesh, Affine::scaling({-1e3, 1, 1e-3})));
  ASSERT_EQ(scene.normals.size(), 2u);
  for (const auto i : indices(2)) {
    EXPECT_EQ(faceOf(scene.triangles[i]), (Vec3d{0, 0, 1}));
    // The inverse transpose gives (1 / -1e3, 0, 1e-6 * 1e3).
    EXPECT_FLOAT_EQ(normalOf(scene.normals[i], 0).x, -std::sqrt(0.5f));
    EXPECT_FLOAT_EQ(normalOf(scene.normals[i], 0).z, std::sqrt(0.5f));
  }
}

// The transform of normals is (1 / 2, 1, 1): the normal that leans along x keeps a length of 0.72,
// and the others have 1. A transform that keeps angles leaves unit vectors, and so does any
// transform if all three normals of a triangle have the same length.
TEST(Bake, StretchedNormalsKeepTheProportionOfTheirLengths) {
  Mesh mesh = square();
  const auto expectNormals = [&](const Affine& map, const std::array<Vec3d, 3>& wanted) {
    const NormalRecord record = finalized(placedAs(mesh, map)).normals.at(0);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE(length(Vec3d(normalOf(record, i)) - wanted[i]), 2e-7) << i;
    }
  };

  const Affine stretch = Affine::scaling({2, 1, 1}), turn = Affine::rotation({1, 2, 3}, 33);
  const Vec3d leansX{0.8, 0, 0.6}, leansY{0, 0.8, 0.6}, up{0, 0, 1};
  mesh.normals = {Vec3f(leansX), Vec3f(leansY), Vec3f(up), Vec3f(up)};
  expectNormals(stretch, {Vec3d{0.4, 0, 0.6}, leansY, up});
  expectNormals(turn * Affine::scaling(Vec3d(7)),
                {turn.vector(leansX), turn.vector(leansY), turn.vector(up)});

  const Vec3d leans = normalized(Vec3d{0.4, 0, 0.6});
  mesh.normals.assign(4, Vec3f(leansX));
  expectNormals(stretch, {leans, leans, leans});
}

TEST(Bake, ObjectsUsedMoreOftenAreInstanced) {
  SceneDescription d = sceneOf(square());
  d.objects.push_back({"unused", {square()}});
  d.materials.resize(2);
  d.objects.push_back({"pair", {square(), square()}});
  d.objects[2].meshes[1].materials = {1};  // otherwise its triangles would be duplicates
  d.instances.push_back({2, Affine::translation({0, 0, 5})});
  d.instances.push_back({2, Affine::translation({0, -3, 0}) * Affine::scaling({-1, 1, 1})});

  const Scene scene = finalized(d);
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
  constexpr std::uint32_t kTriangles = 1u << 17, kInstances = 1u << 16;
  Mesh mesh = square();
  mesh.triangles.clear();
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    mesh.positions.push_back({2, static_cast<float>(i), 0});
    mesh.triangles.push_back({0, i + 3, i + 4});
  }
  mesh.positions.push_back({3, 0, 0});

  SceneDescription d = sceneOf(mesh);
  for (std::uint32_t i = 1; i < kInstances; ++i) {
    d.instances.push_back({0, Affine::translation({0, 0, 1.0 * i})});
  }
  EXPECT_EQ(finalized(d).instancedTriangles, std::uint64_t{kTriangles} * kInstances);
}

TEST(Bake, GeometriesOfWhichNothingIsLeftTakeTheirInstancesAlong) {
  Mesh line = square();
  line.triangles = {{0, 1, 1}};
  SceneDescription d = sceneOf(line);
  d.objects.push_back({"good", {square()}});
  for (const std::uint32_t object : {0u, 1u, 1u}) d.instances.push_back({object, {}});

  const Scene scene = finalized(d);
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
  expectError(ExitStatus::badScene, {"instance", "1.844e18"}, [&] { finalized(d); });
}

TEST(Bake, TrianglesAreSortedByClassAndKeepTheirOrder) {
  SceneDescription d = sceneOf(square());
  d.textures.push_back(whiteTexture(TexelFormat::data));
  d.materials.resize(4);  // material i makes class i
  for (const auto i : indices(4)) {
    d.materials[i].castsShadow = (i & kNoShadowBit) == 0;
    if (i & kMaskedBit) d.materials[i].alphaMap = 0;
  }

  Mesh mesh;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const float x = static_cast<float>(i);
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    mesh.materials.push_back(i * 7 % 4);
  }

  d.objects[0].meshes = {mesh, square(), above(mesh)};
  d.objects[0].meshes[1].materials = {2};
  const Scene scene = finalized(d);
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
    Warnings warnings, strict(true);
    const Scene scene = finalized(twoOf(scale), &warnings);
    EXPECT_EQ(scene.instances.size(), 1u) << scale.x;
    EXPECT_EQ(scene.instancedTriangles, 2u) << scale.x;
    EXPECT_EQ(warned(warnings, "instance too small or too flat to be traced left out"), 1u);
    expectError(ExitStatus::badScene, {"too small or too flat"},
                [&] { finalized(twoOf(scale), &strict); });
  }

  for (const Vec3d& scale : {Vec3d{1e-15, 1, 1}, Vec3d(1e-11), Vec3d(1e11), Vec3d{-1, 1, 1}}) {
    EXPECT_EQ(finalized(twoOf(scale)).instances.size(), 2u) << scale.x;
  }
}

}  // namespace
}  // namespace whit
