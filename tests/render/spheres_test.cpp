// Exact spheres: a glass ball against the two refractions of each pixel, computed here; surfaces of
// every kind against triangles, and against the reference.
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
#include "pi.h"
#include "reference/reference.h"
#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

Affine placedBall(const Vec3d& center, double radius) {
  return Affine::translation(center) * Affine::scaling(Vec3d(radius));
}

// --- A glass ball of radius 1 about the origin stands before a checkered wall that emits light.

constexpr double kGlassIndex = 1.5, kWallDistance = 3, kEyeDistance = 5;
constexpr int kWallHalf = 32;  // fields from the middle to an end
constexpr int kBallWidth = 480, kBallHeight = 300;

double wallRadiance(const Vec3d& from, const Vec3d& direction) {
  if (!(direction.z < 0)) return 0;
  const double t = (-kWallDistance - from.z) / direction.z;
  const double x = from.x + t * direction.x, y = from.y + t * direction.y;
  if (std::fabs(x) > kWallHalf || std::fabs(y) > kWallHalf) return 0;
  const auto field = static_cast<long>(std::floor(x)) + static_cast<long>(std::floor(y));
  return field % 2 == 0 ? 0 : 1;
}

// Fresnel's equations for unpolarized light; `cosine` is on the side of the index `from`.
double fresnelReflectance(double cosine, double from, double to) {
  const double sine2 = (1 - cosine * cosine) * (from / to) * (from / to);
  if (sine2 >= 1) return 1;
  const double c = std::sqrt(1 - sine2);
  const double s = (from * cosine - to * c) / (from * cosine + to * c);
  const double p = (from * c - to * cosine) / (from * c + to * cosine);
  return (s * s + p * p) / 2;
}

Vec3d refractedAlong(const Vec3d& d, const Vec3d& n, double from, double to) {
  const double ratio = from / to, cosine = -dot(d, n);
  return d * ratio + n * (ratio * cosine - std::sqrt(1 - ratio * ratio * (1 - cosine * cosine)));
}

// Impulses up to depth 2 see the wall through both faces, and by reflection at the first.
double ballRadiance(const Vec3d& eye, const Vec3d& d) {
  const double b = dot(eye, d), inside = b * b - dot(eye, eye) + 1;
  if (inside < 0) return wallRadiance(eye, d);
  const Vec3d in = eye + d * (-b - std::sqrt(inside));
  const double cosine = -dot(d, in), mirror = fresnelReflectance(cosine, 1, kGlassIndex);
  const Vec3d across = refractedAlong(d, in, 1, kGlassIndex);
  const Vec3d out = in - across * (2 * dot(in, across));
  const double inner = dot(across, out), left = 1 - fresnelReflectance(inner, kGlassIndex, 1);
  return mirror * wallRadiance(in, d + in * (2 * cosine)) +
         (1 - mirror) * left * wallRadiance(out, refractedAlong(across, -out, kGlassIndex, 1));
}

int displayCode(double radiance) {
  const double v =
      radiance <= 0.0031308 ? 12.92 * radiance : 1.055 * std::pow(radiance, 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255 * std::min(1.0, std::max(0.0, v))));
}

Scene ballBeforeWall() {
  SceneBuilder builder;
  Texture fields = makeTexture(TexelFormat::color, 2, 2,
                               {encodeColorTexel(Rgb(1.0f)), encodeColorTexel(Rgb(0.0f)),
                                encodeColorTexel(Rgb(0.0f)), encodeColorTexel(Rgb(1.0f))});

  Material wall = emittingMaterial(1);
  wall.emissionMap = builder.add(std::move(fields));
  constexpr float kHalf = kWallHalf, kZ = -kWallDistance;
  Mesh mesh = quad({-kHalf, -kHalf, kZ}, {kHalf, -kHalf, kZ}, {kHalf, kHalf, kZ},
                   {-kHalf, kHalf, kZ}, builder.add(wall));
  for (Vec2f& uv : mesh.uvs) uv = {uv.x * kHalf, uv.y * kHalf};
  builder.add(std::move(mesh));

  builder.add(exactSphere(builder.add(glassMaterial(kGlassIndex))));
  builder.description.cameras = {{.eye = {0, 0, kEyeDistance}, .at = {0, 0, 0}, .fov = 40}};
  return builder.build();
}

TEST(Spheres, GlassBallShowsWhatTwoRefractionsShow) {
  RenderOptions o;
  o.size = ImageSize{kBallWidth, kBallHeight};
  o.depth = 2;
  o.cutoff = 0;
  o.shading.textureFilter = TextureFilter::nearest;
  const Image image = render(ballBeforeWall(), o).image;

  // The camera's field of view is 40 degrees high.
  const double half = std::tan(20 * kPi / 180);
  int off = 0, seen = 0;
  for (int y = 0; y < kBallHeight; ++y) {
    for (int x = 0; x < kBallWidth; ++x) {
      const double right = (x + 0.5 - kBallWidth / 2.0) / (kBallHeight / 2.0) * half,
                   up = (kBallHeight / 2.0 - y - 0.5) / (kBallHeight / 2.0) * half;

      const double expected = ballRadiance({0, 0, kEyeDistance}, normalized(Vec3d{right, up, -1}));
      const Rgb& got = image.pixels[static_cast<std::size_t>(y * kBallWidth + x)];
      off += std::abs(displayCode(double{got.x}) - displayCode(expected)) > 1;
      seen += expected > 0;
    }
  }

  EXPECT_GT(seen, kBallWidth * kBallHeight / 3);

  // At the borders of the wall's fields and of the ball, rounding decides.
  EXPECT_LE(off, kBallWidth * kBallHeight / 1000);
}

// --- Surfaces of every kind.

std::int32_t addFields(SceneBuilder& builder, TexelFormat format, int width, int height) {
  std::vector<std::uint32_t> texels;
  for (int i = 0; i < width * height; ++i) {
    const int field = (i / 8 % 2 + i / (8 * width)) % 3;
    const float a = 0.3f + 0.3f * static_cast<float>(field), b = field == 1 ? 0.9f : 0.45f;
    texels.push_back(format == TexelFormat::data ? encodeDataTexel(a, b, 0.9f, 1)
                                                 : encodeColorTexel({a, b, 1 - a}));
  }
  return builder.add(makeTexture(format, width, height, std::move(texels)));
}

std::vector<Material> everyKind(SceneBuilder& builder) {
  const std::int32_t colors = addFields(builder, TexelFormat::color, 64, 32),
                     data = addFields(builder, TexelFormat::data, 64, 32);

  Material textured = diffuseMaterial(1);
  textured.diffuseMap = colors;
  Material bumpy = diffuseMaterial(0.7f);
  bumpy.normalMap = data;

  Material shiny = diffuseMaterial(0.2f);
  shiny.specular = Rgb(0.5f);
  shiny.roughness = 0.6f;
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

  Object all;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const double x = static_cast<double>(i % 4) * 1.3 - 2, z = i < 4 ? -1.2 : 0.4;
    const Affine stretch = i % 3 == 0   ? Affine::scaling({0.6, 0.4, 0.6})
                           : i % 3 == 1 ? Affine::scaling({-0.5, 0.5, 0.5})
                                        : Affine::scaling(Vec3d(0.55));

    const Affine map = Affine::translation({x, 0.62, z}) *
                       Affine::rotation({1, 1, 0}, 35.0 * static_cast<double>(i)) * stretch;
    all.meshes.push_back(put(exactSphere(builder.add(kinds[i]), map)));
  }

  builder.place(std::move(all),
                {Affine(), Affine::translation({0.4, 1.3, -2.5}) * Affine::rotation({0, 1, 0}, 20) *
                               Affine::scaling({1, 1.2, -1})});
  builder.add(floorAt(0, 6, builder.add(diffuseMaterial(0.5f))));
  builder.sky(0.4f);
  builder.description.lights = {lightAt({2, 5, 3}, 40)};
  builder.description.cameras = {{.eye = {0, 2.5f, 5}, .at = {0, 0.8f, 0}}};
  return builder.build();
}

class SpheresOfEveryKind : public testing::TestWithParam<TextureFilter> {
 protected:
  static RenderOptions options() {
    RenderOptions o = smallOptions();
    o.shading.textureFilter = GetParam();
    return o;
  }
};

TEST_P(SpheresOfEveryKind, AgreeWithTheReferenceOnEveryTarget) {
  expectTheReferenceOnEveryTarget(ballsOfEveryKind(), options());
}

// Outlines differ by less than a hundredth of a pixel; other differences are at the borders of
// fields.
TEST_P(SpheresOfEveryKind, LookLikeFineTriangles) {
  const ImageDifference d = compareImages(render(ballsOfEveryKind(), options()).image,
                                          render(ballsOfEveryKind(96), options()).image);
  EXPECT_LE(d.pixelsGe2CodesPct, 4);
  EXPECT_LE(d.rmse, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Filters, SpheresOfEveryKind,
                         testing::Values(TextureFilter::nearest, TextureFilter::bilinear,
                                         TextureFilter::trilinear));

TEST(Spheres, KeepTheirBitsWhateverTheQueues) {
  expectBitsWhateverTheQueues(ballsOfEveryKind(), smallOptions());
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

  CoincidentSpheres() {
    for (const float e : {0.25f, 0.5f, 0.75f}) builder_.add(emittingMaterial(e));
    builder_.add(glassMaterial(1.5f, 3));
    Material half = emittingMaterial(0.75f);
    half.alphaMap = builder_.add(makeTexture(
        TexelFormat::data, 2, 1, {encodeDataTexel(1, 1, 1, 1), encodeDataTexel(0, 0, 0, 0)}));
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
    builder.description.cameras = {{.eye = {0, 0, 3}, .at = {0, 0, 0}, .fov = 40}};
    return builder;
  }

  Scene sceneOf(const std::vector<Piece>& pieces) { return builderOf(pieces).build(); }

  // Compares all pictures with expected(point). `axes` are those of an ellipsoid about the origin
  // along x, y and z, and `point` is the point of the ellipsoid that a pixel's center shows.
  template <typename Expected>
  void expectPictures(const char* what, const Scene& scene, const Vec3d& axes,
                      const Expected& expected) {
    SCOPED_TRACE(what);

    RenderOptions o = smallOptions();
    const double half = std::tan(20 * kPi / 180), height = o.size->height, width = o.size->width;
    for (const auto& [mode, image] : picturesOf(scene, o)) {
      int wrong = 0, seen = 0;
      for (int y = 0; y < o.size->height; ++y) {
        for (int x = 0; x < o.size->width; ++x) {
          const Vec3d d{(x + 0.5 - width / 2) / (height / 2) * half,
                        (height / 2 - y - 0.5) / (height / 2) * half, -1};
          // The ellipsoid is a unit sphere in the space that is scaled by its axes.
          const Vec3d eye{0, 0, 3}, e{0, 0, 3 / axes.z}, v{d.x / axes.x, d.y / axes.y, -1 / axes.z};
          const double a = dot(v, v), b = dot(e, v), inside = b * b - a * (dot(e, e) - 1);
          if (std::fabs(inside) < 1e-3) continue;

          const float got = image.pixels[static_cast<std::size_t>(y * o.size->width + x)].x;
          const Vec3d point = eye + d * ((-b - std::sqrt(std::max(inside, 0.0))) / a);
          const std::optional<float> right = inside < 0 ? 0.0f : expected(point);
          wrong += right && *right != got;
          seen += inside > 0;
        }
      }

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

TEST_F(CoincidentSpheres, TheLastInTheSceneIsHit) {
  expectAll("equal", 0.75f, {{{}, kDim}, {{}, kBright}});
  expectAll("the last is turned", 0.75f, {{{}, kDim}, {kTurn, kBright}});
  expectAll("the first is turned", 0.25f, {{kTurn, kBright}, {{}, kDim}});
  expectAll("three", 0.5f, {{kTurn, kBright}, {{}, kDim}, {kOtherTurn, kMiddle}});
  expectAll("instances", 0.75f, {{{}, kDim, true, kOtherTurn}, {kTurn, kBright, true}});
  expectAll("an instance after the world", 0.25f, {{{}, kBright}, {kTurn, kDim, true, kOtherTurn}});
  expectAll("the world after an instance", 0.75f, {{{}, kDim, true, kTurn}, {{}, kBright}});

  const Affine far = Affine::translation({-7, 3, 11});
  expectAll("placed by an instance", 0.75f,
            {{{}, kDim}, {far * kTurn, kBright, true, Affine::translation({7, -3, -11})}});

  const Vec3d axes{1, 0.7, 0.05};
  const Affine flat = Affine::scaling(axes);
  expectAll("ellipsoids", 0.75f, {{flat * kTurn, kDim}, {flat * kOtherTurn, kBright}}, axes);
}

TEST_F(CoincidentSpheres, OpaqueOnesAreHitBeforeGlass) {
  expectAll("glass last", 0.25f, {{{}, kDim}, {kTurn, kGlass}});
  expectAll("glass first", 0.75f, {{kTurn, kGlass}, {{}, kBright}});
  expectAll("glass between", 0.75f, {{kTurn, kDim}, {{}, kGlass}, {kOtherTurn, kBright, true}});
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

TEST(Spheres, LeftOutAreNotThereInEitherMode) {
  const Scene scene = ballsOfEveryKind();
  RenderOptions o = smallOptions();
  o.disable = EffectSet().with(Effect::spheres);
  EXPECT_LE(differenceFromReference(scene, o).pixelsGe2CodesPct, 0.1);
}

// An eye on the sphere sees what lies beyond it, whichever way it looks.
TEST(Spheres, TheEyeSeesNothingOfWhatItLiesIn) {
  for (const float z : {3.0f, -3.0f, 1.0f}) {
    SceneBuilder builder;
    builder.add(exactSphere(builder.add(emittingMaterial(0.25f)), placedBall({0, 0, 1}, 1)));
    builder.add(floorAt(-40, 100, builder.add(emittingMaterial(0.5f))));
    builder.sky(0.75f);
    builder.description.cameras = {{.eye = {0, 1, 1}, .at = {0, 4, z}, .up = {1, 0, 0}, .fov = 5}};

    for (const Rgb& pixel : render(builder.build(), smallOptions()).image.pixels) {
      ASSERT_EQ(pixel.x, 0.75f) << z;
    }
  }
}

}  // namespace
}  // namespace whit::test
