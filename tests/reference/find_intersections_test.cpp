// Hits computed again, and surfels: position, normals, offset, textures.
#include "reference/find_intersections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

// Hard case H3: the point by its weights lies on the triangle, however far the eye is.
TEST(Triangle, RefinedHitStaysOnTheTriangle) {
  const Scene scene = withFloor(blackMaterial(), 0.5f).build();
  Numbers numbers(2);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    // Some rays aim a little beyond the border, like candidates found in float.
    const Vec3d target{numbers.in(-0.5001, 0.5001), 0, numbers.in(-0.5001, 0.5001)};
    const Vec3d eye{1e5, numbers.in(1, 100), numbers.in(-1e5, 1e5)};

    const TriangleHit hit = refineHit(scene, {eye, normalized(target - eye)}, {i % 2});
    EXPECT_GE(hit.u, 0);
    EXPECT_GE(hit.v, 0);
    EXPECT_LE(hit.u + hit.v, 1 + 1e-15);
    EXPECT_GT(hit.t, 0);
  }
}

TEST(Triangle, UselessCandidateKeepsItsHint) {
  const Scene scene = withFloor(blackMaterial()).build();
  // A ray along the plane has no intersection to compute.
  const Ray along{{-5, 0, 0}, {1, 0, 0}};
  const TriangleHit hit = refineHit(scene, along, {0, kNoHit, 0.25, 0.5});
  EXPECT_EQ(hit.u, 0.25);
  EXPECT_EQ(hit.v, 0.5);
  EXPECT_GT(hit.t, 0);

  const double nan = std::nan("");
  const TriangleHit lost = refineHit(scene, along, {0, kNoHit, nan, nan});
  EXPECT_GE(lost.u, 0);
  EXPECT_LE(lost.u + lost.v, 1);
}

// Returns the surfel that a ray hits, by brute force. The ray goes straight down by default.
Surfel surfelAlong(const Scene& scene, const Vec3d& origin, const Vec3d& towards = {0, -1, 0},
                   EffectSet effects = EffectSet::all()) {
  const Ray ray{origin, normalized(towards)};
  Candidate candidate;
  if (!BruteForce(scene, effects).closest(ray, candidate)) {
    ADD_FAILURE() << "the ray was meant to hit";
    return {};
  }
  return makeSurfel(scene, effects, candidate, refineHit(scene, ray, candidate), ray);
}

TEST(Surfel, NormalsFaceTheViewer) {
  const Scene scene = withFloor(blackMaterial()).build();
  for (const double side : {1.0, -1.0}) {
    const Surfel s = surfelAlong(scene, {0.5, 2 * side, 0.25}, {0, -side, 0});
    EXPECT_EQ(s.entering, side > 0);
    expectNear(s.position, {0.5, 0, 0.25}, 1e-15);
    for (const Vec3d& direction : {s.geometricNormal, s.shadingNormal, s.view}) {
      EXPECT_EQ(direction, Vec3d(0, side, 0));
    }
  }
}

TEST(Surfel, OffsetBoundsTheRounding) {
  const Scene scene = sceneOf(floorAt(3, 2), blackMaterial());

  // In the corner (-2, 3, 2) the edges add up to (8, 0, 4); the magnitude along the normal is 3.
  constexpr double u = 1 / 16777216.0, offset = u * (4 * 3 + (7 + 12) / 64.0);
  const Surfel s = surfelAlong(scene, {-2, 9, 2});
  EXPECT_DOUBLE_EQ(s.offset, offset);
  EXPECT_DOUBLE_EQ(s.viewOffset, u * (14 + 12));

  // In the middle of the diagonal the magnitudes of both corners are averaged, not their
  // coordinates.
  EXPECT_DOUBLE_EQ(surfelAlong(scene, {0, 9, 0}).offset, offset);

  // Where other surfaces are coplanar, all magnitudes count: those of the point (7) and of both
  // edges (4 and 4 + 4).
  const Surfel among =
      makeSurfel(scene, EffectSet::all(), {0}, {6, 0, 0}, {{-2, 9, 2}, {0, -1, 0}}, {}, true);
  EXPECT_DOUBLE_EQ(among.offset, u * (32 * 7 + 16 * 12));
  EXPECT_DOUBLE_EQ(among.viewOffset, u * (16 * 7 + 8 * 12));
}

// Returns a floor at height 0, 2 wide, with normals at its corners.
Mesh floorWith(const std::vector<Vec3f>& normals) {
  Mesh mesh = floorAt(0, 1, 0);
  mesh.normals = normals;
  return mesh;
}

TEST(Surfel, InterpolatesNormals) {
  const float s = std::sqrt(0.5f);
  // The normal of the first edge leans left, that of the opposite one right.
  const Scene scene =
      sceneOf(floorWith({{-s, s, 0}, {s, s, 0}, {s, s, 0}, {-s, s, 0}}), blackMaterial());
  expectNear(surfelAlong(scene, {0, 1, 0.5}).shadingNormal, {0, 1, 0}, 1e-7);

  // At three quarters of the way, the tangent is half of the border's.
  expectNear(surfelAlong(scene, {0.5, 1, 0.25}).shadingNormal, normalized(Vec3d{0.5, 1, 0}), 1e-7);

  const EffectSet flat = allBut(Effect::smoothNormals);
  expectNear(surfelAlong(scene, {0.5, 1, 0.25}, {0, -1, 0}, flat).shadingNormal, {0, 1, 0}, 0);
}

// Facing is decided by the geometric normal alone (hard case H33).
TEST(Surfel, ShadingNormalMayLookAway) {
  const Scene scene = sceneOf(floorWith(std::vector(4, Vec3f{0.8f, 0.6f, 0})), blackMaterial());
  const Surfel s = surfelAlong(scene, {-1, 0.1, 0}, {1, -0.1, 0});
  EXPECT_TRUE(s.entering);
  EXPECT_LT(dot(s.view, s.shadingNormal), 0);
  expectNear(s.shadingNormal, {0.8, 0.6, 0}, 1e-7);
}

// The texel centers at u = 1/4 and 3/4 have a green of 1 and 1/5, with 3/5 halfway between them.
TEST(Surfel, RoughnessIsTheFactorTimesItsMap) {
  SceneBuilder builder;
  Material m = glossyMaterial(0.5f, 0.5f, 0.75f);
  m.roughnessMap = builder.add(makeTexture(
      TexelFormat::data, 2, 1, {encodeDataTexel(0, 1, 0, 0), encodeDataTexel(1, 0.2f, 1, 1)}));

  builder.add(floorAt(0, 1), m);
  const Scene scene = builder.build();

  for (const auto& [x, roughness] : {std::pair{-0.5, 0.75}, {0.0, 0.45}, {0.5, 0.15}}) {
    EXPECT_NEAR(surfelAlong(scene, {x, 1, 0}).alpha, roughness * roughness, 1e-7) << x;
  }
}

// A channel of 8 bits is off by half a step of 2/255, before the normal is normalized.
constexpr double kCoding = 0.006;

// Expects the shading normals of a floor whose normal map is one texel in tangent space, which
// leans along u or v. On the floor u grows along +x and v along -z. `place` puts the floor into the
// scene.
void expectLeaning(const Vec3d& alongU, const Vec3d& alongV,
                   const std::function<void(SceneBuilder&, Mesh)>& place, double side = 1,
                   double tolerance = kCoding) {
  for (const bool leansAlongU : {true, false}) {
    SceneBuilder builder;
    Material m = diffuseMaterial(1);
    const float lean = 0.5f + 0.5f * 0.6f, level = 0.5f;
    m.normalMap = builder.add(makeTexture(
        TexelFormat::data, 1, 1,
        {encodeDataTexel(leansAlongU ? lean : level, leansAlongU ? level : lean, 0.9f, 1)}));
    place(builder, floorAt(0, 1, builder.add(m)));
    expectNear(surfelAlong(builder.build(), {0.1, side, 0.2}, {0, -side, 0}).shadingNormal,
               leansAlongU ? alongU : alongV, tolerance);
  }
}

void addToWorld(SceneBuilder& builder, Mesh mesh) { builder.add(std::move(mesh)); }

TEST(NormalMap, LeansAlongTextureAxesAndTurnsOverWithTheSurface) {
  expectLeaning({0.6, 0.8, 0}, {0, 0.8, -0.6}, addToWorld);
  expectLeaning({-0.6, -0.8, 0}, {0, -0.8, 0.6}, addToWorld, -1);
}

TEST(NormalMap, MirroredTextureLeansTheOtherWay) {
  expectLeaning({-0.6, 0.8, 0}, {0, 0.8, -0.6}, [](SceneBuilder& builder, Mesh mesh) {
    for (Vec2f& uv : mesh.uvs) uv.x = -uv.x;
    builder.add(std::move(mesh));
  });
}

TEST(NormalMap, CollapsedTextureSpaceChangesNothing) {
  const auto collapsed = [](SceneBuilder& builder, Mesh mesh) {
    for (Vec2f& uv : mesh.uvs) uv = {0.5f, uv.y};
    builder.add(std::move(mesh));
  };
  expectLeaning({0, 1, 0}, {0, 1, 0}, collapsed, 1, 0);
}

// A mirrored instance looks like the mirrored surface: its tilt along v stays.
TEST(NormalMap, MirroredInstance) {
  expectLeaning({-0.6, 0.8, 0}, {0, 0.8, -0.6}, [](SceneBuilder& builder, const Mesh& mesh) {
    builder.place({"floor", {mesh}},
                  {Affine::scaling({-1, 1, 1}), Affine::translation({0, 0, 50})});
  });
}

// Hard case H11: an instance looks like its mesh moved beforehand.
TEST(Surfel, InstancesMatchBakedGeometry) {
  const Affine map = Affine::translation({3, -2, 5}) * Affine::rotation({1, 2, 3}, 40) *
                     Affine::scaling({-1000, 0.5, 2});
  const Mesh mesh = floorWith({{0, 0.8f, 0.6f}, {0.6f, 0.8f, 0}, {0, 1, 0}, {-0.28f, 0.96f, 0}});

  SceneBuilder instanced, baked;
  instanced.place({"floor", {mesh}}, {map, Affine::translation({0, 1e6, 0})});
  baked.place({"floor", {mesh}}, {map});
  const Scene a = instanced.build(), b = baked.build();

  ASSERT_EQ(a.instances.size(), 2u);
  ASSERT_TRUE(b.instances.empty());

  const Vec3d target = map.point({0.3, 0, 0.4});
  for (const double side : {1.0, -1.0}) {
    const Vec3d eye = target + map.normal({0, 1, 0}) * (side * 1e-3) + Vec3d{0.1, 0.2, 0.3};
    const Surfel s = surfelAlong(a, eye, target - eye), t = surfelAlong(b, eye, target - eye);

    // The baked corners, 1000 from the origin, are rounded to float: to 3e-5, on edges 1 long.
    expectNear(s.position, t.position, 1e-4);
    expectNear(s.geometricNormal, t.geometricNormal, 1e-4);
    expectNear(s.shadingNormal, t.shadingNormal, 1e-6);
    EXPECT_EQ(s.entering, t.entering);
    EXPECT_EQ(s.entering, side > 0);

    // |M| times the magnitudes is at least the magnitude of the moved corners.
    EXPECT_GE(s.offset, t.offset * (1 - 1e-6));
  }
}

// Normals are interpolated in the model and then transformed by the inverse transpose, for
// instances too, which match baked meshes.
TEST(Surfel, NormalsAreInterpolatedAsModelled) {
  const Affine map = Affine::rotation({1, 2, 3}, 40) * Affine::scaling({1, 4, 0.25});
  const float s = std::sqrt(0.5f);

  // The normals of the corners differ, so that the order of the two steps matters.
  const Mesh mesh = floorWith({{-s, s, 0}, {0, s, s}, {0, 1, 0}, {0, 1, 0}});

  SceneBuilder builder;
  builder.place({"floor", {mesh}}, {map});
  const Scene scene = builder.build();

  // The weights belong to the triangle of the corners 0, 1 and 2 at (-1, 0, 1), (1, 0, 1) and (1,
  // 0, -1).
  constexpr double kWeights[][2] = {{0.25, 0.25}, {0.5, 0.1}, {0.05, 0.05}, {0.9, 0.05}};
  for (const auto& [u, v] : kWeights) {
    const double w = 1 - u - v;
    const Vec3d mean =
        Vec3d(mesh.normals[0]) * w + Vec3d(mesh.normals[1]) * u + Vec3d(mesh.normals[2]) * v;
    const Vec3d at = map.point({-w + u + v, 0, w + u - v}), up = map.normal({0, 1, 0});

    // Baked corners are rounded to float, and the map stretches lengths by up to 16.
    expectNear(surfelAlong(scene, at + up, -up).shadingNormal, normalized(map.normal(mean)), 1e-5);
  }
}

TEST(Surfel, TexturesMultiplyColors) {
  SceneBuilder builder;
  Material m = diffuseMaterial(0.5f);
  m.specular = Rgb(0.25f);
  m.diffuseMap = m.specularMap = builder.add(makeTexture(
      TexelFormat::color, 2, 1, {encodeColorTexel(Rgb(0.0f)), encodeColorTexel({1, 1, 0})}));
  builder.add(floorAt(0, 1), m);
  const Scene scene = builder.build();

  // u = 0.5 is halfway between black and yellow.
  const Surfel s = surfelAlong(scene, {0, 1, 0.5});
  expectNear(s.diffuse, {0.25, 0.25, 0}, 1e-12);
  expectNear(s.specular, {0.125, 0.125, 0}, 1e-12);

  EXPECT_EQ(surfelAlong(scene, {0, 1, 0.5}, {0, -1, 0}, allBut(Effect::textures)).diffuse,
            RgbD(0.5));
}

TEST(Surfel, RoughnessIsSquaredAndBounded) {
  for (const auto& [roughness, used] : {std::pair{0.5f, 0.5f}, {0.0f, kMinRoughness}}) {
    Material m = diffuseMaterial(1);
    m.roughness = roughness;
    EXPECT_DOUBLE_EQ(surfelAlong(withFloor(m).build(), {0, 1, 0}).alpha, double{used} * used);
  }
}

// The mask rises linearly from 0 at u = 1/4 to 1 at u = 3/4, and is cut at 1/2.
TEST(AlphaMask, CutsWhereItFallsBelowTheCutoff) {
  SceneBuilder builder;
  Material m = diffuseMaterial(1);
  m.alphaMap = builder.add(makeTexture(TexelFormat::data, 2, 1, {0x00u, 0xffu}));
  m.alphaCutoff = 0.5f;
  builder.add(floorAt(0, 1), m);
  builder.add(floorAt(-1, 1), diffuseMaterial(1));
  const Scene scene = builder.build();

  const auto heightSeen = [&](double x, EffectSet effects) {
    return surfelAlong(scene, {x, 1, 0.3}, {0, -1, 0}, effects).position.y;
  };
  EXPECT_NEAR(heightSeen(-1e-9, EffectSet::all()), -1, 1e-12);
  EXPECT_NEAR(heightSeen(1e-9, EffectSet::all()), 0, 1e-12);
  EXPECT_NEAR(heightSeen(-1e-9, allBut(Effect::alphaMasks)), 0, 1e-12);

  const BruteForce bruteForce(scene);
  EXPECT_FALSE(bruteForce.occluded({{-1e-9, 1, 0.3}, {0, -1, 0}}, 1.5));
  EXPECT_TRUE(bruteForce.occluded({{1e-9, 1, 0.3}, {0, -1, 0}}, 1.5));
}

}  // namespace
}  // namespace whit::reference
