// Channels of scenes whose every pixel is known, by packets and by the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "core/option_table.h"
#include "io/scene_files.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"
#include "sampling/sample_pattern.h"

namespace whit::test {
namespace {

const std::string kAll = "depth,position,normal,albedo,uv,object,material,triangle,rays";

RenderOptions channelOptions(const std::string& channels = kAll,
                             ImageSize size = smallOptions().size.value()) {
  RenderOptions o = smallOptions(size);
  o.channels = parseChannels(channels);
  return o;
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

// Returns the values of a channel at pixel (x, y) of the whole image.
std::vector<double> valuesAt(const Film& film, Channel channel, int x, int y) {
  const ChannelInfo& info = infoOf(channel);
  const std::size_t first = info.components * film.image.index(x, y);

  std::vector<double> values;
  for (std::size_t i = first; i < first + info.components; ++i) {
    values.push_back(info.countsThings ? static_cast<double>(film.channels.numbers(channel)[i])
                                       : double{film.channels.floats(channel)[i]});
  }
  return values;
}

// What a channel should have at a pixel, and how near.
struct Wanted {
  Channel channel;
  std::vector<double> values;
  double bound = 0;
};

void expectAt(const Film& film, int x, int y, const std::vector<Wanted>& channels) {
  for (const Wanted& wanted : channels) {
    const std::vector<double> found = valuesAt(film, wanted.channel, x, y);
    const auto isNear = [&](double a, double b) {
      return a == b || std::abs(a - b) <= wanted.bound;  // infinite depths are equal
    };
    EXPECT_TRUE(std::ranges::equal(found, wanted.values, isNear))
        << infoOf(wanted.channel).name << " of pixel " << x << ',' << y << " begins with "
        << found[0] << " in place of " << wanted.values[0];
  }
}

Material painted() {
  Material m;
  m.diffuse = {0.5f, 0.25f, 0.1f};
  return m;
}

// A square of side 4 lies in the plane z = 0 and is seen from z = 5. It has uv from (0, 0) to
// (1, 1). Around it there is a sky, and there is no light.
SceneDescription squareScene(const Material& material = painted(), float sky = 0) {
  SceneDescription d;
  d.materials = {Material(), material};
  d.objects.push_back({"square", {quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, 1)}});
  d.instances.push_back({0, Affine{}});
  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = Rgb(sky);

  d.cameras.resize(1);  // at z = 5, looking along -z
  d.cameras[0].fov = 60;
  return d;
}

class Channels : public testing::TestWithParam<Mode> {
 protected:
  static RenderOptions options(const std::string& channels = kAll) {
    RenderOptions o = channelOptions(channels, kSmallSize);
    o.mode = GetParam();
    return o;
  }

  // Returns a picture of one pixel, whose ray goes through the middle of the view.
  static Film middleOf(const SceneDescription& description, RenderOptions o) {
    o.size = ImageSize{1, 1};
    return render(repaired(description), o);
  }
  static float alphaOf(const SceneDescription& description, const RenderOptions& o) {
    return middleOf(description, o).channels.floats(Channel::alpha)[0];
  }
};

// The square is 4 / (10 tan 30 degrees) of the height wide. The bound of 1 % allows for the 16
// samples of each pixel at its edges.
TEST_P(Channels, AlphaIsTheShareOfThePixelThatIsCovered) {
  RenderOptions o = options("alpha");
  o.spp = 16;
  o.adaptive = true;  // takes all samples
  const Film film = render(repaired(squareScene()), o);

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
  expectAt(film, 0, 0, {{Channel::alpha, {0}}});
  expectAt(film, film.image.width / 2, film.image.height / 2, {{Channel::alpha, {1}}});
}

using Codes = std::vector<std::uint8_t>;

// Surfaces keep their radiance, times their share of the pixel. Primary rays alone leave out the
// sky.
TEST_P(Channels, ABackgroundTakesThePlaceOfTheSky) {
  SceneDescription alone = squareScene(), d = squareScene(painted(), 3);
  d.ambient.up = d.ambient.down = Rgb(1.0f);
  alone.ambient = d.ambient;
  const Scene scene = repaired(d);

  RenderOptions o = options("");
  o.spp = 4;
  const Film black = render(repaired(alone), o);

  setOption(o, "background", "transparent");
  setOption(o, "exposure", "1");
  const Film clear = render(scene, o);
  EXPECT_EQ(clear.image.pixels, black.image.pixels);
  ASSERT_TRUE(clear.display.hasAlpha);

  setOption(o, "background", "#0080ff");
  setOption(o, "tonemap", "filmic");
  const Film colored = render(scene, o);
  EXPECT_EQ(colored.image.pixels, black.image.pixels);

  const auto codes = [](const Film& film, std::size_t i) {
    const auto at = film.display.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i);
    return Codes(at, at + 4);
  };

  const std::size_t middle = clear.image.index(clear.image.width / 2, clear.image.height / 2);
  EXPECT_EQ(codes(clear, 0), (Codes{0, 0, 0, 0}));
  EXPECT_EQ(codes(clear, middle), (Codes{255, 188, 124, 255}));  // 1, 0.5, 0.2
  EXPECT_EQ(codes(colored, 0), (Codes{0, 128, 255, 255})) << "whatever the tone curve";
}

// The square is a sheet before a sky of 1; behind it there may be a second square.
SceneDescription sheetBeforeSky(Material sheet, const Material* behind = nullptr) {
  sheet.diffuse = Rgb(0.0f);
  SceneDescription d = squareScene(sheet, 1);

  if (behind) {
    d.materials.push_back(*behind);
    Mesh mesh = d.objects[0].meshes[0];
    for (Vec3f& p : mesh.positions) p.z = -1;
    mesh.materials = {2};
    d.objects.push_back({"behind", {mesh}});
    d.instances.push_back({1, Affine{}});
  }
  return d;
}

// A sheet sends its own light, and 1 - alpha of the background passes it (Porter and Duff 1984).
TEST_P(Channels, ASheetShowsTheBackgroundInPlaceOfTheSky) {
  Material sheet;
  sheet.emission = {1, 0.5f, 0.25f};
  sheet.coverage = 0.5f;

  struct Case {
    const char* background;
    Rgb image;
    Codes codes;
  };
  // Over red, half of each is seen: 1, 0.25, 0.125. The sky is white.
  const Rgb half{0.5f, 0.25f, 0.125f};
  for (const Case& c :
       {Case{"transparent", half, {255, 188, 137, 128}}, Case{"ff0000", half, {255, 137, 99, 255}},
        Case{"sky", half + Rgb(0.5f), {255, 225, 207, 255}}}) {
    RenderOptions o = options("alpha");
    setOption(o, "background", c.background);
    const Film film = middleOf(sheetBeforeSky(sheet), o);
    EXPECT_EQ(film.image.pixels[0], c.image) << c.background;
    EXPECT_EQ(film.channels.floats(Channel::alpha)[0], 0.5f) << c.background;
    EXPECT_EQ(film.display.rgba, c.codes) << c.background;
  }
}

TEST_P(Channels, AlphaFollowsAllThatLightPassesStraight) {
  RenderOptions o = options("");
  setOption(o, "background", "transparent");
  const auto seen = [&](const Material& sheet, const Material* behind = nullptr) {
    return alphaOf(sheetBeforeSky(sheet, behind), o);
  };

  Material half;
  half.coverage = 0.5f;
  EXPECT_EQ(seen(half), 0.5f);
  EXPECT_EQ(seen(half, &half), 0.75f);

  const Material opaque;
  EXPECT_EQ(seen(half, &opaque), 1.0f);

  // A mask cuts everything, as glTF's MASK below its cutoff.
  Material gone;
  gone.coverage = 0;
  EXPECT_EQ(seen(gone), 0.0f);
  EXPECT_EQ(middleOf(sheetBeforeSky(gone), o).image.pixels[0], Rgb(0.0f));

  // The alpha of a tinted pane is the mean of its colors. Its ior is that of what surrounds it.
  Material pane;
  pane.transmission = {0.75f, 0.5f, 0.25f};
  pane.thin = true;
  pane.ior = 1;
  EXPECT_NEAR(seen(pane), 0.5f, 1e-6);

  // Light that is reflected or refracted brings the sky along, and counts as light of a surface.
  Material mirror;
  mirror.mirror = mirror.mirrorGrazing = Rgb(1.0f);
  EXPECT_EQ(seen(half, &mirror), 1.0f);
  EXPECT_EQ(middleOf(sheetBeforeSky(half, &mirror), o).image.pixels[0], Rgb(0.25f))
      << "through the sheet, and back through it";
}

// The samples of a rough sheet's lobe turn aside, so that they show no background, and neither does
// what lets them through farther back. The rest of the sheet lets light go straight on. Facets as
// good as smooth let it through, however many samples the lobe may have.
TEST_P(Channels, AlphaOfFrostedGlassIsWhatDoesNotGoStraightOn) {
  Material half;
  half.coverage = 0.5f;

  for (const auto& [roughness, coverage, alpha] :
       {std::array{0.4f, 1.0f, 1.0f}, {0.4f, 0.5f, 0.5f}, {0, 1.0f, 0.2f}, {0, 0.5f, 0.1f}}) {
    Material sheet;
    sheet.transmission = Rgb(0.8f);
    sheet.thin = sheet.frosted = true;
    sheet.roughness = roughness;
    sheet.coverage = coverage;

    for (const int samples : {1, 8}) {
      SCOPED_TRACE(testing::Message() << roughness << ' ' << coverage << ' ' << samples);
      RenderOptions o = options("alpha");
      o.glossy = samples;
      EXPECT_NEAR(alphaOf(sheetBeforeSky(sheet), o), alpha, 1e-6f);

      // Of the light that goes straight on, another sheet before it or behind it takes half.
      EXPECT_NEAR(alphaOf(sheetBeforeSky(sheet, &half), o), (1 + alpha) / 2, 1e-6f);
      EXPECT_NEAR(alphaOf(sheetBeforeSky(half, &sheet), o), (1 + alpha) / 2, 1e-6f);
    }
  }
}

// Neither the sky that the lobe reflects, nor a mirror, nor the view changes the albedo.
TEST_P(Channels, AlbedoIsTheMaterialsOwn) {
  Material material = painted();
  material.specular = Rgb(0.5f);
  material.mirrorGrazing = Rgb(1.0f);

  for (const float sky : {0.0f, 1.0f}) {
    material.mirror = Rgb{0.2f, 0.9f, 0.1f} * (0.5f - 0.25f * sky);
    SceneDescription d = squareScene(material, sky);
    d.cameras[0].eye = {3, 1, 2};

    for (const int rays : {0, 4}) {
      RenderOptions o = options("albedo");
      o.glossy = rays;
      expectAt(middleOf(d, o), 0, 0, {{Channel::albedo, {0.5, 0.25, 0.1f}}});
    }
  }
}

// In each channel mirror and diffuse color reflect 1 in sum, so neither is dimmed.
TEST_P(Channels, OfAColoredCoatAreLimitedOneByOne) {
  struct Case {
    Rgb diffuse, mirror, wanted;
  };
  // A gray coat leaves the hue as it is, and a red one takes nothing of green and blue.
  for (const Case& c : {Case{{1, 0.5f, 0}, {0, 0.5f, 1}, Rgb(1.0f)},
                        Case{{1, 0.5f, 0}, Rgb(0.75f), {1, 0.875f, 0.75f}},
                        Case{Rgb(1.0f), {1, 0, 0}, Rgb(1.0f)}}) {
    Material material;
    material.diffuse = c.diffuse;
    material.mirror = material.mirrorGrazing = c.mirror;
    SceneDescription d = squareScene(material, 1);
    d.ambient.up = d.ambient.down = Rgb(1.0f);
    EXPECT_EQ(middleOf(d, options("")).image.pixels[0], c.wanted);
  }
}

// glTF 2.0 makes this diffuse color and reflectance of a base color and a metallic share.
TEST_P(Channels, FinishIsTheMaterialsOwn) {
  const auto expectFinish = [&](const Material& material, double roughness, double metallic,
                                double bound = 0) {
    // The metallic share is a difference over 0.04, which multiplies roundings by 25.
    expectAt(
        middleOf(squareScene(material), options("roughness,metallic")), 0, 0,
        {{Channel::roughness, {roughness}, bound}, {Channel::metallic, {metallic}, 25 * bound}});
  };

  Material material;
  expectFinish(material, 1, 0);  // matte

  material.roughness = 0.4f;
  for (const float metal : {0.0f, 0.3f, 0.9f, 1.0f}) {
    const Rgb base{0.9f, 0.6f, 0.3f};
    material.diffuse = base * (1 - metal);
    material.specular = Rgb(0.04f * (1 - metal)) + base * metal;
    expectFinish(material, 0.4, double{metal}, kNear);
  }

  expectFinish(mirrorMaterial(0.9f), 0, 1);

  Material glass = glassMaterial(1.5f);
  glass.specular = Rgb(0.1f);
  glass.roughness = 0.25f;
  expectFinish(glass, 0.25, 0);
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

  Renderer renderer(scene, options("motion,position,object"));
  Camera before = scene.cameras[0];
  before.eye += {0.5f, 0.25f, 1};
  before.at += {0.5f, 0.25f, 1};
  moveScene(scene, 0.25);
  renderer.setEarlier(rememberView(scene, before));
  moveScene(scene, 1);
  renderer.sceneMoved();
  const Film film = render(renderer);

  const double focal = film.image.height / 2.0 / std::tan(kPi / 6);
  int seen = 0;
  forEachPixel(film.image, [&](int x, int y) {
    const std::vector<double> p = valuesAt(film, Channel::position, x, y);
    const bool isHit = valuesAt(film, Channel::object, x, y)[0] == 0;
    const double right = p[0] / 5.0 - (p[0] - 0.75 - 0.5) / 6.0;
    const double up = p[1] / 5.0 - (p[1] - 0.25) / 6.0;
    expectAt(
        film, x, y,
        {{Channel::motion, {isHit ? focal * right : 0, isHit ? -focal * up : 0}, focal * kNear}});
    seen += isHit;
  });
  EXPECT_GT(seen, 500);
}

TEST(EarlierView, AsksForALinearCamera) {
  const Scene scene = repaired(squareScene());
  Camera panorama = scene.cameras[0];
  panorama.projection = Projection::panorama;
  EXPECT_THROW(rememberView(scene, panorama), Error);
}

// Where nothing is hit, the channels say so. There is no light, so the primary ray is the only one.
TEST_P(Channels, OfASquareAreItsOwn) {
  const Scene scene = repaired(squareScene());
  const Film film = render(scene, options());

  int hits = 0;
  forEachPixel(film.image, [&](int x, int y) {
    const ViewRay ray(scene.cameras[0], film.image, x + 0.5, y + 0.5);
    const double t = -5 / ray.direction.z;
    const Vec3d p = ray.at(t);
    if (std::max(std::abs(p.x), std::abs(p.y)) > 2) {
      expectAt(film, x, y,
               {{Channel::depth, {kInfinity, kInfinity}},
                {Channel::position, {0, 0, 0}},
                {Channel::normal, {0, 0, 0}},
                {Channel::albedo, {0, 0, 0}},
                {Channel::uv, {0, 0}},
                {Channel::object, {kNoNumber}},
                {Channel::material, {kNoNumber}},
                {Channel::triangle, {kNoNumber}},
                {Channel::rays, {1}}});
      return;
    }

    ++hits;
    expectAt(film, x, y,
             {{Channel::depth, {5, t}, kNear},
              {Channel::position, {p.x, p.y, 0}, kNear},
              {Channel::normal, {0, 0, 1}},
              {Channel::albedo, {0.5, 0.25, 0.1f}},
              {Channel::uv, {(p.x + 2) / 4, (p.y + 2) / 4}, kNear},
              {Channel::object, {0}},
              {Channel::material, {1}},
              {Channel::rays, {1}}});

    // On the diagonal, either of the two triangles may be hit.
    if (std::abs(p.x - p.y) > kNear) {
      expectAt(film, x, y, {{Channel::triangle, {p.x > p.y ? 0.0 : 1.0}}});
    }
  });

  EXPECT_GT(hits, 500);
}

// A unit sphere about the origin is exact. Seen from z = 5, its depth is the nearer root of a
// quadratic.
TEST_P(Channels, OfASphereAreItsOwn) {
  SceneDescription d = squareScene();
  d.objects[0].meshes[0] = exactSphere(1);

  const Scene scene = repaired(std::move(d));
  const Film film = render(scene, options());
  int hits = 0;
  forEachPixel(film.image, [&](int x, int y) {
    const ViewRay ray(scene.cameras[0], film.image, x + 0.5, y + 0.5);
    const double b = dot(ray.origin, ray.direction), inside = b * b - 24;
    // Where rays graze the sphere, the root has no accuracy.
    if (inside < 0.01) return;
    ++hits;
    const double t = -b - std::sqrt(inside);
    const Vec3d p = ray.at(t);
    // The error of the root grows ten times at most.
    constexpr double kGrazing = 2.0e-5;

    expectAt(film, x, y,
             {{Channel::depth, {-t * ray.direction.z, t}, kGrazing},
              {Channel::position, {p.x, p.y, p.z}, kGrazing},
              {Channel::normal, {p.x, p.y, p.z}, kGrazing},
              {Channel::object, {0}},
              {Channel::triangle, {0}}});

    const std::vector<double> uv = valuesAt(film, Channel::uv, x, y);
    EXPECT_NEAR(uv[1], 0.5 + std::asin(p.y) / kPi, 1e-4);
    EXPECT_NEAR(std::cos(2 * kPi * uv[0]), p.x / std::hypot(p.x, p.z), 1e-4);
  });

  EXPECT_GT(hits, 100);
}

// There are three boxes of known depth, of which two are one object that is placed twice. Along
// parallel rays both depths are equal.
TEST_P(Channels, NumbersTellThingsApart) {
  const TemporaryFolder folder;
  const std::string path = folder / "boxes.json";
  std::ofstream(path) << asJson(
      "{'whit': 1,"
      " 'cameras': {'main': {'eye': [0, 0, 9], 'at': [0, 0, 0], 'orthographicHeight': 6.7}},"
      " 'materials': {'a': {'diffuse': 0.2}, 'b': {'diffuse': 0.4}, 'c': {'diffuse': 0.6}},"
      " 'objects': {'pair': [{'shape': 'box', 'size': [1, 1, 1], 'material': 'b'}]},"
      " 'scene': [{'shape': 'box', 'size': [1, 1, 1], 'material': 'a',"
      "            'transform': {'translate': [-2, 0, 0]}},"
      "           {'use': 'pair'},"
      "           {'use': 'pair', 'transform': {'translate': [2, 0, 0.5]}},"
      "           {'shape': 'quad', 'width': 0.5, 'depth': 0.5, 'material': 'c',"
      "            'transform': {'rotate': [1, 0, 0, 90], 'translate': [0, 1, 0]}}]}");
  const Scene scene = repaired(described(path));
  const Film film = render(scene, options());

  for (const int i : {0, 1, 2}) {
    // The boxes stand two units apart about the middle of the picture, and ten pixels are a unit.
    const int x = film.image.width / 2 + 20 * (i - 1), y = film.image.height / 2 + 2;
    const double depth = i == 2 ? 8 : 8.5;
    // Embree divides to find the depth, which rounds.
    expectAt(film, x, y, {{Channel::object, {double(i)}}, {Channel::depth, {depth, depth}, kNear}});
    EXPECT_LT(valuesAt(film, Channel::triangle, x, y)[0], 12);

    const auto material = static_cast<std::size_t>(valuesAt(film, Channel::material, x, y)[0]);
    EXPECT_EQ(scene.materials.at(material).name, i == 0 ? "a" : "b");
  }

  const std::vector<std::string> names{"/scene/0", "/objects/pair/0", "/objects/pair/0",
                                       "/scene/3"};
  EXPECT_EQ(scene.items.names, names);
}

INSTANTIATE_TEST_SUITE_P(Modes, Channels, testing::Values(Mode::packets, Mode::reference),
                         [](const auto& info) {
                           return info.param == Mode::packets ? "Packets" : "Reference";
                         });

TEST(ChannelLaws, H76_BitsOfPictureAndChannelsDependOnNothingAround) {
  for (const std::string& name : smallScenes()) {
    SCOPED_TRACE(name);
    RenderOptions o = channelOptions();
    o.spp = 3;
    expectBitsWhateverTheQueues(load(name), o);
  }
}

TEST(ChannelLaws, ACropHasTheBitsOfTheWhole) {
  for (const bool adaptive : {false, true}) {
    SCOPED_TRACE(adaptive ? "adaptive" : "all samples");
    RenderOptions o = channelOptions();
    o.size = kSmallSize;
    o.spp = 4;
    o.adaptive = adaptive;
    expectBitsOfTheWhole(load("whitted"), o, {31, 20, 80, 51});
  }
}

TEST(ChannelLaws, ThePictureIsTheSameWithThem) {
  for (const std::string& name : smallScenes()) {
    const Scene scene = load(name);
    EXPECT_EQ(firstDifference(render(scene, smallOptions()), render(scene, channelOptions())), "")
        << name;
  }
}

// Channels are never averaged: where the square ends, each pixel has the depth of the square or of
// nothing, at the sample that is nearest to its center.
TEST(ChannelLaws, AreThoseOfOneSample) {
  const Scene scene = repaired(squareScene());
  for (const int spp : {1, 2, 3, 4, 5, 16}) {
    RenderOptions o = channelOptions("depth,position");
    o.spp = spp;
    const std::vector<Vec2f> samples = samplePattern(spp);
    const Vec2f nearest = *std::ranges::min_element(samples, {}, [](const Vec2f& s) {
      return std::hypot(double{s.x} - 0.5, double{s.y} - 0.5);
    });

    const Film film = render(scene, o);
    forEachPixel(film.image, [&](int x, int y) {
      if (std::isinf(valuesAt(film, Channel::depth, x, y)[0])) return;
      const ViewRay ray(scene.cameras[0], film.image, x + double{nearest.x}, y + double{nearest.y});
      const double t = -5 / ray.direction.z;
      const Vec3d p = ray.at(t);
      expectAt(film, x, y,
               {{Channel::depth, {5, t}, kNear}, {Channel::position, {p.x, p.y, 0}, kNear}});
    });
  }
}

TEST(ChannelLaws, AdaptiveSamplingKeepsTheCenters) {
  for (const std::string& name : smallScenes()) {
    const Scene scene = load(name);
    RenderOptions o = channelOptions();
    const Picture centers = render(scene, o);
    o.spp = 9;
    o.adaptive = true;
    Picture adaptive = render(scene, o);
    adaptive.image = centers.image;
    EXPECT_EQ(firstDifference(centers, adaptive), "") << name;
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
      const auto both = renderBoth(scene, o);
      const ChannelLayers &packets = both.packets.channels, &reference = both.reference.channels;

      std::size_t parted = 0;
      for (const auto i : indices(packets.pixels())) {
        const auto same = [&](Channel c) {
          return packets.numbers(c)[i] == reference.numbers(c)[i];
        };
        if (!same(Channel::object) || !same(Channel::triangle) || !same(Channel::rays)) {
          ++parted;
          continue;
        }

        EXPECT_TRUE(same(Channel::material));
        const float z = packets.floats(Channel::depth)[2 * i];
        const float other = reference.floats(Channel::depth)[2 * i];
        EXPECT_TRUE(z == other || std::abs(z - other) <= 1e-4f * other) << name << ' ' << z;
      }

      EXPECT_LE(static_cast<double>(parted), kMostParted * static_cast<double>(packets.pixels()))
          << name;
    }
  }
}

// The sum of the channel over a picture is the number of rays that the frame has traced.
void expectAllRaysKept(const std::string& name, const RenderOptions& o) {
  const Picture film = render(load(name), o);
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
  EXPECT_EQ(ChannelLayers::bytesPerPixel(render(renderer).channels.channels()), 0u);
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
  Renderer renderer(scene, smallOptions());
  Picture film = render(renderer);

  renderer.setOptions(channelOptions());
  renderer.render(chooseCamera(scene, channelOptions()), film);
  EXPECT_EQ(firstDifference(render(scene, channelOptions()), film), "");
}

// Objects that move are instanced and objects that stand still are baked: numbers and names are
// the same in both, and after a move as well.
TEST(ChannelLaws, NumbersAreThoseOfTheSceneThatStandsStill) {
  LoadOptions moving;
  moving.instant.plays = true;
  Scene moved = repaired(described("orrery", moving));
  moveScene(moved, 0);
  const RenderOptions o = channelOptions("object,material,triangle");
  Renderer renderer(moved, o);

  for (const double seconds : {0.0, 3.0}) {
    LoadOptions then;
    then.instant.seconds = seconds;
    const Scene still = repaired(described("orrery", then));
    EXPECT_EQ(still.items.names, moved.items.names);

    moveScene(moved, seconds);
    renderer.sceneMoved();
    const ChannelLayers a = render(still, o).channels, b = render(renderer).channels;
    o.channels.forEach([&](Channel c) {
      // The bound allows for rays that pass an edge within rounding.
      EXPECT_LE(whit::differenceOf(a.numbers(c), b.numbers(c)).differing, a.pixels() / 500)
          << infoOf(c).name << " at " << seconds;
    });
  }
}

}  // namespace
}  // namespace whit::test
