// Exact spheres: surfaces of every kind against triangles and against the reference, and which of
// several coincident ones is hit.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/edit_scene.h"
#include "brute_force.h"
#include "inspect/metrics.h"
#include "inspect/reference_frame.h"
#include "make/shape.h"
#include "reference/reference.h"
#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

std::int32_t addFields(SceneBuilder& builder, TexelFormat format) {
  constexpr int kWidth = 64, kHeight = 32;
  std::vector<std::uint32_t> texels;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const int field = (i / 8 % 2 + i / (8 * kWidth)) % 3;
    const float a = 0.3f + 0.3f * static_cast<float>(field), b = field == 1 ? 0.9f : 0.45f;
    texels.push_back(format == TexelFormat::data ? encodeDataTexel(a, b, 0.9f, 1)
                                                 : encodeColorTexel({a, b, 1 - a}));
  }
  return builder.add(makeTexture(format, kWidth, kHeight, std::move(texels)));
}

std::vector<Material> everyKind(SceneBuilder& builder) {
  const std::int32_t colors = addFields(builder, TexelFormat::color),
                     data = addFields(builder, TexelFormat::data);

  Material textured = diffuseMaterial(1);
  textured.diffuseMap = colors;
  Material bumpy = diffuseMaterial(0.7f);
  bumpy.normalMap = data;

  Material shiny = glossyMaterial(0.2f, 0.5f, 0.6f);
  shiny.roughnessMap = data;
  shiny.glossyReflection = false;
  Material lamp = emittingMaterial(0.8f);
  lamp.emissionMap = colors;

  Material masked = textured;
  masked.alphaMap = data;
  masked.alphaCutoff = 0.5f;
  Material veil = diffuseMaterial(0.5f);
  veil.coverage = 0.8f;
  veil.coverageMap = data;
  return {textured, bumpy, shiny, lamp, mirrorMaterial(0.8f), glassMaterial(1.5f), masked, veil};
}

// Places balls in two rows over a floor: round, stretched and mirrored, and each kind once as an
// instance. With `segments` above 0, triangles replace the spheres.
Scene ballsOfEveryKind(int segments = 0) {
  SceneBuilder builder;
  const std::vector<Material> kinds = everyKind(builder);
  const auto put = [&](Mesh mesh) {
    if (segments > 0) procedural::tessellateSpheres(mesh, segments);
    return mesh;
  };

  const Affine stretches[] = {Affine::scaling({0.6, 0.4, 0.6}), Affine::scaling({-0.5, 0.5, 0.5}),
                              Affine::scaling(Vec3d(0.55))};
  Object all;
  for (int i = 0; i < 8; ++i) {
    const double x = i % 4 * 1.3 - 2, z = i < 4 ? -1.2 : 0.4;
    const Affine map = Affine::translation({x, 0.62, z}) * Affine::rotation({1, 1, 0}, 35.0 * i) *
                       stretches[i % 3];
    all.meshes.push_back(put(exactSphere(builder.add(kinds[i]), map)));
  }

  builder.place(std::move(all),
                {Affine(), Affine::translation({0.4, 1.3, -2.5}) * Affine::rotation({0, 1, 0}, 20) *
                               Affine::scaling({1, 1.2, -1})});
  builder.add(floorAt(0, 6), diffuseMaterial(0.5f));
  builder.sky(0.4f);
  builder.description.lights = {lightAt({2, 5, 3}, 40)};
  builder.lookFrom({0, 2.5f, 5}, {0, 0.8f, 0});
  return builder.build();
}

TEST(Spheres, KeepTheLawsOfMaps) { expectTheLawsOfMaps(ballsOfEveryKind()); }

// Outlines differ by less than a hundredth of a pixel; other differences are at the borders of
// fields.
TEST(Spheres, LookLikeFineTriangles) {
  RenderOptions o = smallOptions();
  for (const TextureFilter filter :
       {TextureFilter::nearest, TextureFilter::bilinear, TextureFilter::trilinear}) {
    o.shading.textureFilter = filter;
    const ImageDifference d =
        compareImages(render(ballsOfEveryKind(), o).image, render(ballsOfEveryKind(96), o).image);
    EXPECT_LE(d.pixelsGe2CodesPct, 4) << static_cast<int>(filter);
    EXPECT_LE(d.rmse, 0.01) << static_cast<int>(filter);
  }
}

// --- Coincident spheres. The eye is at (0, 0, 3) and looks at the origin.

struct Piece {
  Affine map;
  std::uint32_t material = 0;
  bool isInstance = false;
  Affine toWorld = {};
};

const Affine kTurn = Affine::rotation({1, 2, 3}, 50),
             kOtherTurn = Affine::rotation({-2, 1, 0.5}, 117);

// Renders pictures by packets of all widths, by the reference, and by the reference with its own
// search.
std::vector<std::pair<std::string, Image>> picturesOf(const Scene& scene, RenderOptions o) {
  std::vector<std::pair<std::string, Image>> pictures;
  for (const int packet : {1, 4, 8, 16}) {
    o.packet = packet;
    pictures.emplace_back("packets of " + std::to_string(packet), render(scene, o).image);
  }

  Image image = render(scene, o, false).image;
  pictures.emplace_back("reference", image);

  reference::Settings settings;
  settings.options = o;
  reference::render(scene, BruteForce(scene), chooseCamera(scene, o), settings, image);
  pictures.emplace_back("brute force", image);
  return pictures;
}

class CoincidentSpheres : public testing::Test {
 protected:
  // Emissions of the materials are 0.25, 0.5 and 0.75; then there is glass, and 0.75 on the lower
  // half of z in the space of the unit sphere.
  enum : std::uint32_t { kDim, kMiddle, kBright, kGlass, kHalfBright };

  // Where a ray passes less of the ellipsoid, roundings decide whether it hits.
  static constexpr double kLimb = 1e-3;

  CoincidentSpheres() {
    for (const float e : {0.25f, 0.5f, 0.75f}) builder_.add(emittingMaterial(e));
    builder_.add(glassMaterial(1.5f, 3));
    Material half = emittingMaterial(0.75f);
    half.alphaMap = builder_.add(dataMap(2, {1, 0}));
    half.alphaCutoff = 0.5f;
    builder_.add(half);
  }

  SceneBuilder builderOf(const std::vector<Piece>& pieces) {
    SceneBuilder builder = builder_;
    for (const Piece& piece : pieces) {
      const Affine elsewhere = Affine::translation({40, 0, 0}) * piece.toWorld;
      std::vector<Affine> places{piece.toWorld};
      if (piece.isInstance) places.push_back(elsewhere);
      builder.place({"ball", {exactSphere(piece.material, piece.map)}}, places);
    }
    builder.lookFrom({0, 0, 3}).fov = 40;
    return builder;
  }

  Scene sceneOf(const std::vector<Piece>& pieces) { return builderOf(pieces).build(); }

  // Compares all pictures with expected(point). `axes` are those of an ellipsoid about the origin
  // along x, y and z, and `point` is the point of the ellipsoid that a pixel's center shows.
  template <typename Expected>
  void expectPictures(const char* what, const Scene& scene, const Vec3d& axes,
                      const Expected& expected) {
    SCOPED_TRACE(what);
    const Vec3d perAxis{1 / axes.x, 1 / axes.y, 1 / axes.z};
    for (const auto& [mode, image] : picturesOf(scene, smallOptions())) {
      int wrong = 0, seen = 0;
      forEachRay(scene, image, [&](const Ray& ray, const Rgb& pixel) {
        // Divided by its axes, the ellipsoid is the unit sphere.
        const Vec3d eye = ray.origin * perAxis, way = ray.direction * perAxis;
        const double a = dot(way, way), b = dot(eye, way);
        const double inside = b * b - a * (dot(eye, eye) - 1);
        const double half = std::sqrt(std::max(inside, 0.0)) / a;
        if (inside > 0 && 2 * half < kLimb) return;

        const std::optional<float> right =
            inside > 0 ? expected(ray.origin + ray.direction * (-b / a - half)) : 0.0f;
        wrong += right && *right != pixel.x;
        seen += inside > 0;
      });

      EXPECT_EQ(wrong, 0) << mode;
      EXPECT_GT(seen, 400) << mode;
    }
  }

  void expectAll(const char* what, float expected, const std::vector<Piece>& pieces,
                 const Vec3d& axes = Vec3d(1)) {
    expectPictures(what, sceneOf(pieces), axes,
                   [&](const Vec3d&) { return std::optional(expected); });
  }

 private:
  SceneBuilder builder_;
};

// Hard case H71m has more pairs, in packets.
TEST_F(CoincidentSpheres, TheLastInTheSceneIsHitAndOpaqueOnesBeforeGlass) {
  expectAll("three", 0.5f, {{kTurn, kBright}, {{}, kDim}, {kOtherTurn, kMiddle}});
  expectAll("instances", 0.75f, {{{}, kDim, true, kOtherTurn}, {kTurn, kBright, true}});
  expectAll("an instance after the world", 0.25f, {{{}, kBright}, {kTurn, kDim, true, kOtherTurn}});
  expectAll("glass between", 0.75f, {{kTurn, kDim}, {{}, kGlass}, {kOtherTurn, kBright, true}});
  expectAll("glass last", 0.25f, {{{}, kDim}, {kTurn, kGlass}});

  const Affine far = Affine::translation({-7, 3, 11});
  expectAll("placed by an instance", 0.75f,
            {{{}, kDim}, {far * kTurn, kBright, true, Affine::translation({7, -3, -11})}});

  const Vec3d axes{1, 0.7, 0.05};
  const Affine flat = Affine::scaling(axes);
  expectAll("ellipsoids", 0.75f, {{flat * kTurn, kDim}, {flat * kOtherTurn, kBright}}, axes);
}

TEST_F(CoincidentSpheres, OthersAreHitWhereAMaskCutsThem) {
  for (const bool turned : {false, true}) {
    const Affine map = turned ? kTurn : Affine();
    expectPictures("masked", sceneOf({{kOtherTurn, kDim}, {map, kHalfBright}}), Vec3d(1),
                   [&](const Vec3d& point) -> std::optional<float> {
                     // The inverse of a rotation is its transpose.
                     const double z = dot(map.z, point);
                     if (std::fabs(z) < 1e-3) return std::nullopt;
                     return z < 0 ? 0.75f : 0.25f;
                   });
  }
  expectAll("masked first", 0.25f, {{kTurn, kHalfBright}, {{}, kDim}});
}

TEST_F(CoincidentSpheres, OthersKeepTheirDistance) {
  const Affine larger = Affine::scaling(Vec3d(1 + 2e-5));
  expectAll("larger first", 0.75f, {{larger * kTurn, kBright}, {{}, kDim}});
  expectAll("nearer first", 0.75f, {{Affine::translation({0, 0, 3e-5}), kBright}, {kTurn, kDim}});
  const Vec3d thin{1, 0.9, 0.01}, thinner{1, 0.9, 0.0099};
  expectAll("thicker first", 0.75f,
            {{Affine::scaling(thin), kBright}, {Affine::scaling(thinner) * kTurn, kDim}}, thin);
}

// The sphere comes from aside and reaches its place at 1 s.
Affine arrival(double seconds) { return Affine::translation({5 * (1 - seconds), 0, 0}) * kTurn; }

TEST_F(CoincidentSpheres, MoveIntoOnePlaceAndOut) {
  SceneBuilder builder = builderOf({{{}, kDim}, {{}, kBright, true}});
  RigNode node;
  node.motion = std::make_shared<const Motion>(arrival);
  builder.description.motion.rig = {node};
  for (Instance& instance : builder.description.instances) {
    if (instance.object == builder.description.instances.back().object) instance.mover = 0;
  }

  Scene scene = builder.build();
  for (const double seconds : {1.0, 0.0, 1.0}) {
    moveScene(scene, seconds);
    expectPictures("moved", scene, Vec3d(1),
                   [&](const Vec3d&) { return std::optional(seconds == 1 ? 0.75f : 0.25f); });
  }
}

}  // namespace
}  // namespace whit::test
