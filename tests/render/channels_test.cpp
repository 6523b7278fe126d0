// Channels of scenes whose every pixel is known, by packets and by the reference.
#include <gtest/gtest.h>
#include <algorithm>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "core/option_table.h"
#include "has_text.h"
#include "pi.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"
#include "sampling/sample_pattern.h"

namespace whit::test {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
const std::string kAll = "depth,position,normal,albedo,uv,object,material,triangle,rays";

RenderOptions channelOptions(const std::string& channels = kAll) {
  RenderOptions o = smallOptions();
  o.channels = parseChannels(channels);
  return o;
}

Picture filmOf(const Scene& scene, const RenderOptions& options) {
  return render(scene, options, options.mode == Mode::packets);
}

// Returns the values of a channel at pixel (x, y) of the whole image.
std::vector<float> floatsAt(const Film& film, Channel channel, int x, int y) {
  const std::size_t n = infoOf(channel).components, first = n * film.image.index(x, y);
  const std::span<const float> all = film.channels.floats(channel);
  return {all.begin() + static_cast<std::ptrdiff_t>(first),
          all.begin() + static_cast<std::ptrdiff_t>(first + n)};
}
std::uint32_t numberAt(const Film& film, Channel channel, int x, int y) {
  return film.channels.numbers(channel)[film.image.index(x, y)];
}

// The ray through a point of the picture, in closed form, from a camera at the eye that looks along
// -z.
struct ViewRay {
  Vec3d origin, direction;
  ViewRay(const Camera& camera, const Image& image, double x, double y) : origin(camera.eye) {
    const double half = std::tan(double{camera.fov} * kPi / 360);
    const double right = (2 * x / image.width - 1) * half * image.width / image.height;
    direction = normalized(Vec3d{right, (1 - 2 * y / image.height) * half, -1});
  }
  Vec3d at(double t) const { return origin + direction * t; }
};

// A position is off by a few units in the last place of the numbers that make it up.
constexpr double kNear = 2.0e-6;

void expectNear(const std::vector<float>& found, const std::vector<double>& wanted, double bound) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], bound) << i;
}

// A square of side 4 lies in the plane z = 0 and is seen from z = 5. It has the color
// (0.5, 0.25, 0.1) and uv from (0, 0) to (1, 1). There is nothing around it and no light.
SceneDescription squareScene() {
  SceneDescription d;
  d.name = "square";
  d.materials.resize(2);
  d.materials[1].diffuse = {0.5f, 0.25f, 0.1f};

  d.objects.push_back({"square", {quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, 1)}});
  d.instances.push_back({0, Affine{}});

  d.cameras.resize(1);  // at z = 5, looking along -z
  d.cameras[0].fov = 60;
  return d;
}

SceneDescription loadText(const std::string& text) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("whit-channels-" + std::to_string(getpid()) + ".json");
  std::ofstream(path) << text;
  SceneDescription d = described(path.string());
  std::filesystem::remove(path);
  return d;
}

class Channels : public testing::TestWithParam<Mode> {
 protected:
  static RenderOptions options(const std::string& channels = kAll) {
    RenderOptions o = channelOptions(channels);
    o.size = kSmallSize;
    o.mode = GetParam();
    return o;
  }
};

// The square is 4 / (10 tan 30 degrees) of the height wide. The bound of 1 % allows for the 16
// samples of each pixel at its edges.
TEST_P(Channels, AlphaIsTheShareOfThePixelThatIsCovered) {
  const Scene scene = repaired(squareScene());
  RenderOptions o = options("alpha");
  o.spp = 16;
  o.adaptive = true;  // takes all samples
  const Film film = filmOf(scene, o);

  const double side = 4 / (10 * std::tan(kPi / 6)) * film.image.height;
  double sum = 0;
  int edges = 0;
  for (const float alpha : film.channels.floats(Channel::alpha)) {
    EXPECT_TRUE(alpha >= 0 && alpha <= 1);
    edges += alpha > 0 && alpha < 1;
    sum += double{alpha};
  }

  EXPECT_NEAR(sum, side * side, 0.01 * side * side);
  EXPECT_GT(edges, side);
  EXPECT_EQ(floatsAt(film, Channel::alpha, 0, 0)[0], 0);
  EXPECT_EQ(floatsAt(film, Channel::alpha, film.image.width / 2, film.image.height / 2)[0], 1);
}

// The samples of a rough sheet's lobe turn aside, so that they show no background. Facets as good
// as smooth let it through, however many samples the lobe may have.
TEST_P(Channels, AlphaOfFrostedGlassIsWhatDoesNotGoStraightOn) {
  for (const auto& [roughness, coverage, alpha] :
       {std::array{0.4f, 1.0f, 1.0f}, {0.4f, 0.5f, 0.5f}, {0, 1.0f, 0.2f}, {0, 0.5f, 0.1f}}) {
    SceneDescription d = squareScene();
    Material& sheet = d.materials[1];
    sheet.diffuse = Rgb(0.0f);
    sheet.transmission = Rgb(0.8f);
    sheet.thin = sheet.frosted = true;
    sheet.roughness = roughness;
    sheet.coverage = coverage;

    RenderOptions o = options("alpha");
    o.glossy = 8;
    const Film film = filmOf(repaired(d), o);
    const int x = film.image.width / 2, y = film.image.height / 2;
    EXPECT_NEAR(floatsAt(film, Channel::alpha, x, y)[0], alpha, 1e-6f) << roughness << coverage;
  }
}

// Surfaces keep their radiance, times their share of the pixel. Primary rays alone leave out the
// sky.
TEST_P(Channels, ABackgroundTakesThePlaceOfTheSky) {
  SceneDescription d = squareScene();
  d.ambient.up = d.ambient.down = Rgb(1.0f);
  const Scene alone = repaired(d);

  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = Rgb(3.0f);
  const Scene scene = repaired(d);
  RenderOptions o = options("");
  o.spp = 4;
  const Film black = filmOf(alone, o);

  setOption(o, "background", "transparent");
  setOption(o, "exposure", "1");
  const Film clear = filmOf(scene, o);
  EXPECT_EQ(clear.image.pixels, black.image.pixels);
  ASSERT_TRUE(clear.display.hasAlpha);

  setOption(o, "background", "#0080ff");
  setOption(o, "tonemap", "filmic");
  const Film colored = filmOf(scene, o);
  EXPECT_EQ(colored.image.pixels, black.image.pixels);

  const auto codes = [](const Film& film, std::size_t i) {
    const auto at = film.display.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i);
    return std::vector<int>(at, at + 4);
  };

  const std::size_t middle = clear.image.index(clear.image.width / 2, clear.image.height / 2);
  EXPECT_EQ(codes(clear, 0), (std::vector<int>{0, 0, 0, 0}));
  EXPECT_EQ(codes(clear, middle), (std::vector<int>{255, 188, 124, 255}));  // 1, 0.5, 0.2
  EXPECT_EQ(codes(colored, 0), (std::vector<int>{0, 128, 255, 255})) << "whatever the tone curve";

  const std::span<const float> alpha = clear.channels.floats(Channel::alpha);
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    EXPECT_EQ(codes(clear, i)[3], std::lround(255 * alpha[i]));

    // Colors are not multiplied by alpha: an edge has the color of the square, not a darker one.
    if (alpha[i] > 0) {
      EXPECT_EQ(codes(clear, i)[0], 255);
    }
  }
}

// A pixel in the middle of the square, whatever else the scene has.
struct SeenPixel {
  Rgb image;
  float alpha = 0;
  std::array<int, 4> codes{};
};

SeenPixel middleOf(const Scene& scene, const RenderOptions& o) {
  const Film film = filmOf(scene, o);
  const int x = film.image.width / 2, y = film.image.height / 2;
  const std::size_t pixel = film.image.index(x, y);
  SeenPixel seen{film.image.pixels[pixel], floatsAt(film, Channel::alpha, x, y)[0], {}};
  for (std::size_t i = 0; i < 4; ++i) seen.codes[i] = film.display.rgba[4 * pixel + i];
  return seen;
}

// The square is a sheet before a sky of 1; behind it there may be a second square.
Scene sheetBeforeSky(Material sheet, const Material* behind = nullptr) {
  SceneDescription d = squareScene();
  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = Rgb(1.0f);
  sheet.diffuse = Rgb(0.0f);
  d.materials[1] = sheet;

  if (behind) {
    d.materials.push_back(*behind);
    Mesh mesh = d.objects[0].meshes[0];
    for (Vec3f& p : mesh.positions) p.z = -1;
    mesh.materials = {2};
    d.objects.push_back({"behind", {mesh}});
    d.instances.push_back({1, Affine{}});
  }
  return repaired(std::move(d));
}

// A sheet sends its own light, and 1 - alpha of the background passes it (Porter and Duff 1984).
TEST_P(Channels, ASheetShowsTheBackgroundInPlaceOfTheSky) {
  Material sheet;
  sheet.emission = {1, 0.5f, 0.25f};
  sheet.coverage = 0.5f;
  const Scene scene = sheetBeforeSky(sheet);

  RenderOptions o = options("");
  setOption(o, "background", "transparent");
  const SeenPixel clear = middleOf(scene, o);
  EXPECT_EQ(clear.image, (Rgb{0.5f, 0.25f, 0.125f}));
  EXPECT_EQ(clear.alpha, 0.5f);
  EXPECT_EQ(clear.codes, (std::array<int, 4>{255, 188, 137, 128}));

  // Over red, half of each is seen.
  setOption(o, "background", "ff0000");
  const SeenPixel red = middleOf(scene, o);
  EXPECT_EQ(red.image, clear.image);
  EXPECT_EQ(red.codes, (std::array<int, 4>{255, 137, 99, 255}));  // 1, 0.25, 0.125

  setOption(o, "background", "sky");
  EXPECT_EQ(middleOf(scene, options("alpha")).alpha, 0.5f);
  EXPECT_EQ(middleOf(scene, options("alpha")).image, (Rgb{1, 0.75f, 0.625f}));
}

TEST_P(Channels, AlphaFollowsAllThatLightPassesStraight) {
  RenderOptions o = options("");
  setOption(o, "background", "transparent");
  const auto alphaOf = [&](const Material& sheet, const Material* behind = nullptr) {
    return middleOf(sheetBeforeSky(sheet, behind), o).alpha;
  };

  Material half;
  half.coverage = 0.5f;
  EXPECT_EQ(alphaOf(half), 0.5f);
  EXPECT_EQ(alphaOf(half, &half), 0.75f);

  const Material opaque;
  EXPECT_EQ(alphaOf(half, &opaque), 1.0f);

  // A mask cuts everything, as glTF's MASK below its cutoff.
  Material gone;
  gone.coverage = 0;
  const SeenPixel nothing = middleOf(sheetBeforeSky(gone), o);
  EXPECT_EQ(nothing.image, Rgb(0.0f));
  EXPECT_EQ(nothing.alpha, 0.0f);

  // The alpha of a tinted pane is the mean of its colors. Its ior is that of what surrounds it.
  Material pane;
  pane.transmission = {0.75f, 0.5f, 0.25f};
  pane.thin = true;
  pane.ior = 1;
  EXPECT_NEAR(alphaOf(pane), 0.5f, 1e-6);

  // Light that is reflected or refracted brings the sky along, and counts as light of a surface.
  Material mirror;
  mirror.mirror = mirror.mirrorGrazing = Rgb(1.0f);
  const SeenPixel reflected = middleOf(sheetBeforeSky(half, &mirror), o);
  EXPECT_EQ(reflected.alpha, 1.0f);
  EXPECT_EQ(reflected.image, Rgb(0.25f)) << "through the sheet, and back through it";
}

// The samples of a rough sheet's lobe have turned aside: what lets them through farther back shows
// no background. The rest of the sheet lets light go straight on.
TEST_P(Channels, AlphaBehindSeveralSamplesOfALobe) {
  Material half;
  half.coverage = 0.5f;

  for (const auto& [coverage, alpha] : {std::pair{1.0f, 1.0f}, {0.5f, 0.75f}}) {
    Material rough;
    rough.transmission = Rgb(0.8f);
    rough.thin = rough.frosted = true;
    rough.roughness = 0.4f;
    rough.coverage = coverage;

    for (const int samples : {1, 8}) {
      RenderOptions o = options("alpha");
      o.glossy = samples;
      EXPECT_NEAR(middleOf(sheetBeforeSky(rough, &half), o).alpha, alpha, 1e-6f) << samples;
      EXPECT_NEAR(middleOf(sheetBeforeSky(half, &rough), o).alpha, (1 + coverage) / 2, 1e-6f);
    }
  }
}

// Neither the sky that the lobe reflects, nor a mirror, nor the view changes the albedo.
TEST_P(Channels, AlbedoIsTheMaterialsOwn) {
  SceneDescription d = squareScene();
  d.materials[1].specular = Rgb(0.5f);
  d.materials[1].mirror = {0.2f, 0.9f, 0.1f};
  d.materials[1].mirrorGrazing = Rgb(1.0f);
  d.cameras[0].eye = {3, 1, 2};

  for (const float sky : {0.0f, 1.0f}) {
    d.sky.kind = Sky::Kind::color;
    d.sky.zenith = Rgb(sky);
    d.materials[1].mirror = d.materials[1].mirror * 0.5f;

    for (const char* const rays : {"0", "4"}) {
      RenderOptions o = options("albedo");
      setOption(o, "glossy", rays);
      const Film film = filmOf(repaired(d), o);
      expectNear(floatsAt(film, Channel::albedo, film.image.width / 2, film.image.height / 2),
                 {0.5, 0.25, 0.1f}, 0);
    }
  }
}

// In each channel mirror and diffuse color reflect 1 in sum, so neither is dimmed.
TEST_P(Channels, OfAColoredCoatAreLimitedOneByOne) {
  SceneDescription d = squareScene();
  d.materials[1].diffuse = {1, 0.5f, 0};
  d.materials[1].mirror = d.materials[1].mirrorGrazing = {0, 0.5f, 1};
  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = Rgb(1.0f);
  d.ambient.up = d.ambient.down = Rgb(1.0f);

  EXPECT_EQ(middleOf(repaired(d), options("alpha")).image, Rgb(1.0f));

  // A gray coat leaves the hue as it is.
  d.materials[1].mirror = d.materials[1].mirrorGrazing = Rgb(0.75f);
  EXPECT_EQ(middleOf(repaired(d), options("alpha")).image, (Rgb{1, 0.875f, 0.75f}));

  // A red coat takes nothing of green and blue.
  d.materials[1].diffuse = Rgb(1.0f);
  d.materials[1].mirror = d.materials[1].mirrorGrazing = {1, 0, 0};
  EXPECT_EQ(middleOf(repaired(d), options("alpha")).image, Rgb(1.0f));
}

// glTF 2.0 makes this diffuse color and reflectance of a base color and a metallic share.
TEST_P(Channels, FinishIsTheMaterialsOwn) {
  const auto finishOf = [&](const Material& material) {
    SceneDescription d = squareScene();
    d.materials[1] = material;
    const Film film = filmOf(repaired(d), options("roughness,metallic"));
    const int x = film.image.width / 2, y = film.image.height / 2;
    return std::array{floatsAt(film, Channel::roughness, x, y)[0],
                      floatsAt(film, Channel::metallic, x, y)[0]};
  };
  // The metallic share is a difference over 0.04, which multiplies roundings by 25.
  constexpr double kQuotient = 25 * kNear;

  for (const float metal : {0.0f, 0.3f, 0.9f, 1.0f}) {
    const Rgb base{0.9f, 0.6f, 0.3f};
    Material material;
    material.diffuse = base * (1 - metal);
    material.specular = Rgb(0.04f * (1 - metal)) + base * metal;
    material.roughness = 0.4f;
    const auto [roughness, metallic] = finishOf(material);
    EXPECT_NEAR(roughness, 0.4, kNear);
    EXPECT_NEAR(metallic, metal, kQuotient);
  }

  Material mirror;
  mirror.diffuse = Rgb(0.0f);
  mirror.mirror = mirror.mirrorGrazing = Rgb(0.9f);
  EXPECT_EQ(finishOf(mirror), (std::array{0.0f, 1.0f}));

  Material glass;
  glass.diffuse = Rgb(0.0f);
  glass.specular = Rgb(0.1f);
  glass.transmission = Rgb(1.0f);
  glass.roughness = 0.25f;
  const auto [roughness, metallic] = finishOf(glass);
  EXPECT_NEAR(roughness, 0.25, kNear);
  EXPECT_EQ(metallic, 0);

  EXPECT_EQ(finishOf(Material()), (std::array{1.0f, 0.0f})) << "matte";
}

// The camera was (0.5, 0.25, 1) beside its present place; since then all vertices have moved by
// 0.75 along x.
TEST_P(Channels, MotionIsThatOfCameraAndVertices) {
  SceneDescription d = squareScene();
  Mesh& mesh = d.objects[0].meshes[0];
  auto bending = std::make_shared<Deformation>();
  bending->positions = mesh.positions;
  bending->targets.resize(1);
  bending->targets[0].positions.assign(4, {1, 0, 0});
  bending->movingWeights = Track{.components = 1, .times = {0, 1}, .values = {0, 1}};
  mesh.deformation = bending;
  Scene scene = repaired(d);

  const RenderOptions o = options("motion,position,object");
  Renderer renderer(scene, o);
  const Camera camera = chooseCamera(scene, o);
  Camera before = camera;
  before.eye += {0.5f, 0.25f, 1};
  before.at += {0.5f, 0.25f, 1};
  moveScene(scene, 0.25);
  renderer.setEarlier(rememberView(scene, before));
  moveScene(scene, 1);
  renderer.sceneMoved();
  Film film = makeFilm(scene, o);
  renderFrame(renderer, o.mode, camera, film);

  const int width = film.image.width, height = film.image.height;
  const double focal = height / 2.0 / std::tan(kPi / 6);
  int seen = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::vector<float> p = floatsAt(film, Channel::position, x, y);
      const bool isHit = numberAt(film, Channel::object, x, y) != kNoNumber;
      const double right = p[0] / 5.0 - (p[0] - 0.75 - 0.5) / 6.0;
      const double up = p[1] / 5.0 - (p[1] - 0.25) / 6.0;
      const std::vector<double> expected{isHit ? focal * right : 0, isHit ? -focal * up : 0};
      expectNear(floatsAt(film, Channel::motion, x, y), expected, focal * kNear);
      seen += isHit;
    }
  }
  EXPECT_GT(seen, 500);
}

TEST_P(Channels, MotionAsksForALinearCamera) {
  const Scene scene = repaired(squareScene());
  Camera panorama = scene.cameras[0];
  panorama.projection = Projection::panorama;
  EXPECT_THROW(rememberView(scene, panorama), Error);
}

TEST_P(Channels, OfASquareAreItsOwn) {
  const Scene scene = repaired(squareScene());
  const Film film = filmOf(scene, options());

  int met = 0;
  for (int y = 0; y < film.image.height; ++y) {
    for (int x = 0; x < film.image.width; ++x) {
      const ViewRay ray(scene.cameras[0], film.image, x + 0.5, y + 0.5);
      const double t = -5 / ray.direction.z;
      const Vec3d p = ray.at(t);
      if (std::max(std::abs(p.x), std::abs(p.y)) > 2) continue;
      ++met;
      expectNear(floatsAt(film, Channel::depth, x, y), {5, t}, kNear);
      expectNear(floatsAt(film, Channel::position, x, y), {p.x, p.y, 0}, kNear);
      expectNear(floatsAt(film, Channel::normal, x, y), {0, 0, 1}, 0);
      expectNear(floatsAt(film, Channel::albedo, x, y), {0.5, 0.25, 0.1f}, 0);
      expectNear(floatsAt(film, Channel::uv, x, y), {(p.x + 2) / 4, (p.y + 2) / 4}, kNear);
      EXPECT_EQ(numberAt(film, Channel::object, x, y), 0u);
      EXPECT_EQ(numberAt(film, Channel::material, x, y), 1u);

      // On the diagonal, either of the two triangles may be hit.
      if (std::abs(p.x - p.y) > kNear) {
        EXPECT_EQ(numberAt(film, Channel::triangle, x, y), p.x > p.y ? 0u : 1u);
      }
      // There is no light, so the primary ray is the only one.
      EXPECT_EQ(numberAt(film, Channel::rays, x, y), 1u);
    }
  }

  EXPECT_GT(met, 500);
}

TEST_P(Channels, WhereNothingIsMetSayItIsNot) {
  const Scene scene = repaired(squareScene());
  const Film film = filmOf(scene, options());

  expectNear(floatsAt(film, Channel::position, 0, 0), {0, 0, 0}, 0);
  expectNear(floatsAt(film, Channel::normal, 0, 0), {0, 0, 0}, 0);
  expectNear(floatsAt(film, Channel::albedo, 0, 0), {0, 0, 0}, 0);
  expectNear(floatsAt(film, Channel::uv, 0, 0), {0, 0}, 0);
  EXPECT_EQ(floatsAt(film, Channel::depth, 0, 0), (std::vector<float>{kNothing, kNothing}));
  for (const Channel c : {Channel::object, Channel::material, Channel::triangle}) {
    EXPECT_EQ(numberAt(film, c, 0, 0), kNoNumber);
  }
  EXPECT_EQ(numberAt(film, Channel::rays, 0, 0), 1u);
}

// Along parallel rays both depths are equal.
TEST_P(Channels, OfParallelRaysHaveOneDepth) {
  SceneDescription d = squareScene();
  d.cameras[0].orthographicHeight = 3;
  const Film film = filmOf(repaired(std::move(d)), options("depth"));
  // Embree divides to find the depth, which rounds.
  expectNear(floatsAt(film, Channel::depth, 53, 33), {5, 5}, kNear);
}

// A unit sphere about the origin is exact. Seen from z = 5, its depth is the nearer root of a
// quadratic.
TEST_P(Channels, OfASphereAreItsOwn) {
  SceneDescription d = squareScene();
  d.objects[0].meshes[0] = exactSphere(1);

  const Scene scene = repaired(std::move(d));
  const Film film = filmOf(scene, options());
  int met = 0;
  for (int y = 0; y < film.image.height; ++y) {
    for (int x = 0; x < film.image.width; ++x) {
      const ViewRay ray(scene.cameras[0], film.image, x + 0.5, y + 0.5);
      const double b = dot(ray.origin, ray.direction), inside = b * b - 24;
      // Where rays graze the sphere, the root has no accuracy.
      if (inside < 0.01) continue;
      ++met;
      const double t = -b - std::sqrt(inside);
      const Vec3d p = ray.at(t);
      // The error of the root grows ten times at most.
      constexpr double kGrazing = 2.0e-5;

      expectNear(floatsAt(film, Channel::depth, x, y), {-t * ray.direction.z, t}, kGrazing);
      expectNear(floatsAt(film, Channel::position, x, y), {p.x, p.y, p.z}, kGrazing);
      expectNear(floatsAt(film, Channel::normal, x, y), {p.x, p.y, p.z}, kGrazing);
      EXPECT_EQ(numberAt(film, Channel::object, x, y), 0u);
      EXPECT_EQ(numberAt(film, Channel::triangle, x, y), 0u);

      const std::vector<float> uv = floatsAt(film, Channel::uv, x, y);
      EXPECT_NEAR(uv[1], 0.5 + std::asin(p.y) / kPi, 1e-4);
      EXPECT_NEAR(std::cos(2 * kPi * double{uv[0]}), p.x / std::hypot(p.x, p.z), 1e-4);
    }
  }

  EXPECT_GT(met, 100);
}

// There are three boxes of known depth, of which two are one object that is placed twice.
TEST_P(Channels, NumbersTellThingsApart) {
  const std::string text = R"({"whit": 1, "size": [107, 67],
    "cameras": {"main": {"eye": [0, 0, 9], "at": [0, 0, 0], "fov": 40}},
    "materials": {"a": {"diffuse": 0.2}, "b": {"diffuse": 0.4}, "c": {"diffuse": 0.6}},
    "objects": {"pair": [{"shape": "box", "size": [1, 1, 1], "material": "b"}]},
    "scene": [{"shape": "box", "size": [1, 1, 1], "material": "a",
               "transform": {"translate": [-2, 0, 0]}},
              {"use": "pair"},
              {"use": "pair", "transform": {"translate": [2, 0, 0.5]}},
              {"shape": "quad", "width": 0.5, "depth": 0.5, "material": "c",
               "transform": {"rotate": [1, 0, 0, 90], "translate": [0, 1, 0]}}]})";
  const Scene scene = repaired(loadText(text));
  const Film film = filmOf(scene, options());

  // Finds the column of the middle row that shows a point of a box's front.
  const auto column = [&](double x, double z) {
    const double half = std::tan(20 * kPi / 180) * film.image.width / film.image.height * (9 - z);
    return static_cast<int>((x / half + 1) / 2 * film.image.width);
  };

  const int row = film.image.height / 2;
  const std::array<double, 3> places{-2, 0, 2}, fronts{0.5, 0.5, 1.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const int x = column(places[i], fronts[i]);
    EXPECT_EQ(numberAt(film, Channel::object, x, row), i);
    EXPECT_NEAR(floatsAt(film, Channel::depth, x, row)[0], 9 - fronts[i], kNear);

    const std::uint32_t material = numberAt(film, Channel::material, x, row);
    EXPECT_EQ(scene.materials.at(material).name, i == 0 ? "a" : "b");
    EXPECT_LT(numberAt(film, Channel::triangle, x, row), 12u);
  }

  const std::vector<std::string> names{"/scene/0", "/objects/pair/0", "/objects/pair/0",
                                       "/scene/3"};
  EXPECT_EQ(scene.items.names, names);
}

INSTANTIATE_TEST_SUITE_P(Modes, Channels, testing::Values(Mode::packets, Mode::reference),
                         [](const auto& info) {
                           return info.param == Mode::packets ? "Packets" : "Reference";
                         });

void expectSame(const ChannelLayers& a, const ChannelLayers& b, const std::string& what) {
  ASSERT_EQ(a.channels(), b.channels());
  a.channels().forEach([&](Channel c) {
    const bool same = infoOf(c).countsThings ? std::equal(a.numbers(c).begin(), a.numbers(c).end(),
                                                          b.numbers(c).begin(), b.numbers(c).end())
                                             : std::memcmp(a.floats(c).data(), b.floats(c).data(),
                                                           a.floats(c).size_bytes()) == 0;
    EXPECT_TRUE(same) << infoOf(c).name << ": " << what;
  });
}

TEST(ChannelLaws, BitsDependOnNothingAround) {
  for (const std::string& name : smallScenes()) {
    const Scene scene = load(name);
    RenderOptions o = channelOptions();
    o.spp = 3;
    const ChannelLayers whole = filmOf(scene, o).channels;

    for (const Division& division : usualDivisions()) {
      RenderOptions other = o;
      division.set(other);
      expectSame(whole, filmOf(scene, other).channels, name + ", " + division.name);
    }
  }
}

TEST(ChannelLaws, ACropHasTheBitsOfTheWhole) {
  const Scene scene = load("whitted");
  for (const bool adaptive : {false, true}) {
    RenderOptions o = channelOptions();
    o.size = kSmallSize;
    o.spp = 4;
    o.adaptive = adaptive;
    const Film whole = filmOf(scene, o);
    o.crop = Crop{31, 20, 80, 51};
    const Film part = filmOf(scene, o);
    ChannelLayers same;
    same.resize(o.channels, part.image.pixels.size());

    // The rows of the crop are copied from the whole image.
    for (int y = 20; y < 51; ++y) {
      const std::size_t first = whole.image.index(31, y), to = part.image.index(31, y);
      o.channels.forEach([&](Channel c) {
        const std::size_t components = infoOf(c).components;
        const auto copyRow = [&](const auto& from, const auto& into) {
          std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(first * components),
                      49 * components, into.begin() + static_cast<std::ptrdiff_t>(to * components));
        };

        if (infoOf(c).countsThings) {
          copyRow(whole.channels.numbers(c), same.numbers(c));
        } else {
          copyRow(whole.channels.floats(c), same.floats(c));
        }
      });
    }
    expectSame(same, part.channels, adaptive ? "adaptive" : "all samples");
  }
}

TEST(ChannelLaws, ThePictureIsTheSameWithThem) {
  for (const std::string& name : smallScenes()) {
    const Scene scene = load(name);
    RenderOptions o = smallOptions();
    const Image plain = render(scene, o).image;
    o.channels = parseChannels(kAll);
    EXPECT_EQ(firstDifference(plain, render(scene, o).image), "") << name;
  }
}

// Channels are never averaged: where the square ends, each pixel has the depth of the square or of
// nothing, at the sample that is nearest to its center.
TEST(ChannelLaws, AreThoseOfOneSample) {
  const Scene scene = repaired(squareScene());
  for (const int spp : {1, 2, 3, 4, 5, 16}) {
    RenderOptions o = channelOptions("depth,position");
    o.spp = spp;
    // Finds the sample that is nearest to the center of a pixel.
    const std::vector<Vec2f> samples = samplePattern(spp);
    double best = 1;
    Vec2f nearest;
    for (const Vec2f& s : samples) {
      const double away = std::hypot(double{s.x} - 0.5, double{s.y} - 0.5);
      if (away < best) {
        best = away;
        nearest = s;
      }
    }

    const Film film = filmOf(scene, o);
    for (int y = 0; y < film.image.height; ++y) {
      for (int x = 0; x < film.image.width; ++x) {
        const float z = floatsAt(film, Channel::depth, x, y)[0];
        if (z == kNothing) continue;
        const ViewRay ray(scene.cameras[0], film.image, x + double{nearest.x},
                          y + double{nearest.y});
        const Vec3d p = ray.at(-5 / ray.direction.z);
        EXPECT_NEAR(z, 5, kNear);
        expectNear(floatsAt(film, Channel::position, x, y), {p.x, p.y, 0}, kNear);
      }
    }
  }
}

TEST(ChannelLaws, AdaptiveSamplingKeepsTheCenters) {
  for (const std::string& name : smallScenes()) {
    const Scene scene = load(name);
    RenderOptions o = channelOptions();
    const ChannelLayers centers = filmOf(scene, o).channels;
    o.spp = 9;
    o.adaptive = true;
    expectSame(centers, filmOf(scene, o).channels, name);
  }
}

// Packets and the reference keep the same numbers, but where paths diverge by rounding.
TEST(ChannelLaws, AgreeWithTheReference) {
  // At most 1 % of the pixels have rays that pass an edge or a cutoff.
  constexpr double kMostParted = 0.01;
  for (const std::string& name : smallScenes()) {
    const Scene scene = load(name);
    for (const bool adaptive : {false, true}) {
      RenderOptions o = channelOptions();
      o.spp = 3;
      o.adaptive = adaptive;
      const Film packets = filmOf(scene, o);
      o.mode = Mode::reference;
      const Film reference = filmOf(scene, o);

      std::size_t parted = 0;
      for (std::size_t i = 0; i < packets.image.pixels.size(); ++i) {
        const auto same = [&](Channel c) {
          return packets.channels.numbers(c)[i] == reference.channels.numbers(c)[i];
        };
        if (!same(Channel::object) || !same(Channel::triangle) || !same(Channel::rays)) {
          ++parted;
          continue;
        }

        EXPECT_TRUE(same(Channel::material));
        const float z = packets.channels.floats(Channel::depth)[2 * i];
        const float other = reference.channels.floats(Channel::depth)[2 * i];
        if (z != kNothing) {
          EXPECT_NEAR(z, other, 1e-4 * double{other}) << name;
        }
      }

      EXPECT_LE(static_cast<double>(parted),
                kMostParted * static_cast<double>(packets.image.pixels.size()))
          << name;
    }
  }
}

// The sum of the channel over a picture is the number of rays that the frame has traced.
void expectAllRaysKept(const std::string& name, const RenderOptions& o) {
  const Picture film = filmOf(load(name), o);
  std::uint64_t kept = 0;
  for (const std::uint32_t n : film.channels.numbers(Channel::rays)) kept += n;
  EXPECT_EQ(kept, film.stats.allRays()) << name;
}

TEST(ChannelLaws, RaysAreAllThatWereTraced) {
  for (const Mode mode : {Mode::packets, Mode::reference}) {
    RenderOptions o = channelOptions("rays");
    o.mode = mode;
    for (const std::string& name : smallScenes()) expectAllRaysKept(name, o);

    // These options trace rays of every kind.
    o.indirect = o.ambientSamples = 2;
    o.depth = 2;
    expectAllRaysKept("cornell", o);
  }
}

TEST(ChannelLaws, PlansWithoutThemHaveNothingMore) {
  const Scene scene = load("glass");
  RenderOptions o = smallOptions();
  const auto steps = [&] {
    std::string names;
    makePlan(scene, o).forEachStep([&](const Step& s) { names += s.name + " "; });
    return names;
  };

  const std::string plain = steps();
  EXPECT_FALSE(hasText(plain, "keep"));
  EXPECT_FALSE(hasText(plain, "Counts"));

  Renderer renderer(scene, o);
  Film film = makeFilm(scene, o);
  renderer.render(chooseCamera(scene, o), film);
  EXPECT_EQ(ChannelLayers::bytesPerPixel(film.channels.channels()), 0u);
  for (const auto& tracer : renderer.scheduler().tracers()) {
    EXPECT_EQ(tracer->bufferBytes().rayCounts, 0u);
  }

  o.channels = parseChannels("depth");
  EXPECT_FALSE(hasText(steps(), "countRays"));
  o.channels = parseChannels("rays");
  EXPECT_TRUE(hasText(steps(), "countRays"));
}

TEST(ChannelLaws, ARendererTakesOthersOver) {
  const Scene scene = load("whitted");
  RenderOptions o = channelOptions();
  const ChannelLayers wanted = filmOf(scene, o).channels;
  RenderOptions plain = smallOptions();
  Renderer renderer(scene, plain);
  Film film = makeFilm(scene, plain);
  renderer.render(chooseCamera(scene, plain), film);

  renderer.setOptions(o);
  renderer.render(chooseCamera(scene, o), film);
  expectSame(wanted, film.channels, "set later");
}

Scene movingOrrery() {
  LoadOptions moving;
  moving.instant.plays = true;
  return repaired(described("orrery", moving));
}

// Objects that move are instanced and objects that stand still are baked: numbers and names are
// the same in both.
TEST(ChannelLaws, NumbersAreThoseOfTheSceneThatStandsStill) {
  const Scene still = load("orrery");
  Scene moved = movingOrrery();
  moveScene(moved, 0);
  EXPECT_EQ(still.items.names, moved.items.names);

  const RenderOptions o = channelOptions("object,material,triangle");
  const Film a = filmOf(still, o), b = filmOf(moved, o);
  for (const Channel c : {Channel::object, Channel::material, Channel::triangle}) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.channels.pixels(); ++i) {
      differing += a.channels.numbers(c)[i] != b.channels.numbers(c)[i];
    }

    // The bound allows for rays that pass an edge within rounding.
    EXPECT_LE(differing, a.channels.pixels() / 500) << infoOf(c).name;
  }
}

TEST(ChannelLaws, MovedThingsKeepTheirNumbers) {
  Scene scene = movingOrrery();
  const RenderOptions o = channelOptions("object,position");
  moveScene(scene, 3);
  const Film fresh = filmOf(scene, o);

  moveScene(scene, 0);
  Renderer renderer(scene, o);
  Film film = makeFilm(scene, o);
  renderer.render(chooseCamera(scene, o), film);
  moveScene(scene, 3);
  renderer.sceneMoved();
  renderer.render(chooseCamera(scene, o), film);
  expectSame(fresh.channels, film.channels, "at 3 s");
}

}  // namespace
}  // namespace whit::test
