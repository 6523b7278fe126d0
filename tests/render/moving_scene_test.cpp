// Scenes that move: pictures against closed forms, and that pictures depend on the time alone.
#include "bake/edit_scene.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "inspect/reference_frame.h"
#include "pi.h"
#include "reference/small_scenes.h"
#include "render/frame.h"
#include "shipped_scene.h"
#include "verify/scene_builder.h"

namespace whit {
namespace {

using test::described;
using test::firstDifference;
using test::repaired;
using test::smallOptions;

Scene orreryAt(double seconds) {
  LoadOptions options;
  options.instant.seconds = seconds;
  return repaired(described("orrery", options));
}

Image pictureOf(Renderer& renderer) { return test::render(renderer).image; }

Image pictureOf(const Scene& scene, const RenderOptions& options) {
  return test::render(scene, options).image;
}

TEST(MovingScene, PicturesFollowFromTheTimeAlone) {
  const RenderOptions options = smallOptions();
  Scene scene = orreryAt(0);
  Renderer renderer(scene, options);
  const Image first = pictureOf(renderer);
  for (const double seconds : {7.25, 2.4, 0.0, 2.4}) {
    moveScene(scene, seconds);
    renderer.sceneMoved();
    const Image moved = pictureOf(renderer);
    EXPECT_EQ(firstDifference(moved, pictureOf(orreryAt(seconds), options)), "") << seconds;
    EXPECT_EQ(firstDifference(moved, first).empty(), seconds == 0) << seconds;
  }
}

TEST(MovingScene, PicturesDoNotDependOnThreadsOrPackets) {
  RenderOptions options = smallOptions();
  const Scene scene = orreryAt(3.1);
  const Image expected = pictureOf(scene, options);
  for (const int threads : {1, 8}) {
    options.threads = threads;
    EXPECT_EQ(firstDifference(pictureOf(scene, options), expected), "") << threads;
  }

  for (const int packet : {1, 4}) {
    options.packet = packet;
    EXPECT_EQ(firstDifference(pictureOf(scene, options), expected), "") << packet;
  }
}

TEST(MovingScene, LightsAndCamerasOfFilesKeepWhatWasEdited) {
  Scene scene = orreryAt(0);
  scene.lights.at(1).intensity = Rgb(7.0f);
  moveScene(scene, 2.5);

  EXPECT_EQ(scene.lights[1].intensity, Rgb(7.0f));
  // The lamp goes once around in ten seconds.
  const double turn = -kPi / 2;
  const Vec3d expected{4.5 * std::cos(turn) + 3 * std::sin(turn), 8,
                       -4.5 * std::sin(turn) + 3 * std::cos(turn)};
  EXPECT_LT(length(Vec3d(scene.lights[1].position) - expected), 1e-6);
}

class MovingFile : public testing::Test {
 protected:
  MovingFile() : file_(std::filesystem::temp_directory_path() / ("whit-moving-" + name())) {}
  ~MovingFile() override { std::filesystem::remove(file_); }

  static std::string name() {
    return std::to_string(getpid()) +
           testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
  }

  Scene at(double seconds, const std::string& members) const {
    std::ofstream(file_)
        << "{\"whit\": 1, \"size\": [64, 64], \"cameras\": {\"c\": {\"eye\": [0, "
           "0, 9], \"at\": [0, 0, 0], \"orthographicHeight\": 8}}, \"materials\": "
           "{\"lit\": {\"diffuse\": 0, \"emission\": 1}, \"red\": {\"diffuse\": 0, "
           "\"emission\": [1, 0, 0]}}, "
        << members << "}";

    LoadOptions options;
    options.instant.seconds = seconds;
    return repaired(described(file_.string(), options));
  }

  std::filesystem::path file_;
};

// Center and area of the bright pixels, measured from the middle of the picture.
struct Seen {
  double x = 0, y = 0, area = 0;
};
Seen seenIn(const Image& image) {
  Seen seen;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!(image.at(x, y).x > 0.5f)) continue;
      seen.area += 1;
      seen.x += x + 0.5 - image.width / 2.0;
      seen.y += image.height / 2.0 - y - 0.5;
    }
  }

  seen.x /= seen.area;
  seen.y /= seen.area;
  return seen;
}

// An emitting ball in parallel rays is seen as a disc, eight pixels a unit.
TEST_F(MovingFile, ABallIsSeenWhereItIs) {
  constexpr double kPixels = 8;
  Scene scene =
      at(0,
         "\"scene\": [{\"shape\": \"sphere\", \"material\": \"lit\", \"motion\": {\"keys\": "
         "[{\"time\": "
         "0}, {\"time\": 4, \"translate\": [2, -1, 0], \"scale\": 2}]}}, {\"shape\": \"box\", "
         "\"material\": \"lit\", \"transform\": {\"translate\": [0, 0, 40]}}]");

  const RenderOptions options;
  Renderer renderer(scene, options);
  for (const double seconds : {3.0, 1.0, 4.0}) {
    moveScene(scene, seconds);
    renderer.sceneMoved();
    const Seen seen = seenIn(pictureOf(renderer));
    const double t = seconds / 4, radius = (1 + t) * kPixels;

    // About as many pixels at the edge of the disc are counted that are less than half covered as
    // are left out that are more than half covered: the error grows as that of a random walk.
    const double rim = std::sqrt(2 * kPi * radius);

    EXPECT_NEAR(seen.x, 2 * t * kPixels, 0.1) << seconds;
    EXPECT_NEAR(seen.y, -t * kPixels, 0.1) << seconds;
    EXPECT_NEAR(seen.area, kPi * radius * radius, rim) << seconds;
  }
}

// The ball moves by (0.5, -0.25) a second and grows by a quarter of its size at 0 s.
TEST_F(MovingFile, MotionOfABallIsThatOfItsPoints) {
  constexpr double kPixels = 8;
  Scene scene =
      at(0,
         "\"scene\": [{\"shape\": \"sphere\", \"material\": \"lit\", \"motion\": "
         "{\"keys\": [{\"time\": 0}, {\"time\": 4, \"translate\": [2, -1, 0], \"scale\": 2}]}}]");
  RenderOptions options;
  options.channels = parseChannels("motion,position,object");
  Renderer renderer(scene, options);
  const Camera camera = chooseCamera(scene, options);
  moveScene(scene, 1);
  renderer.setEarlier(rememberView(scene, camera));
  moveScene(scene, 2);
  renderer.sceneMoved();
  Film film = makeFilm(scene, options);
  renderer.render(camera, film);

  const auto positions = film.channels.floats(Channel::position);
  const auto motions = film.channels.floats(Channel::motion);
  int seen = 0;
  for (std::size_t i = 0; i < film.image.pixels.size(); ++i) {
    const bool isHit = film.channels.numbers(Channel::object)[i] != kNoNumber;
    seen += isHit;

    // A point of the ball of radius 1.5 about (1, -0.5) was on one of radius 1.25 about half of it.
    const double x = double{positions[3 * i]}, y = double{positions[3 * i + 1]};
    const double right = x - 0.5 - (x - 1) * 1.25 / 1.5;
    const double up = y + 0.25 - (y + 0.5) * 1.25 / 1.5;
    constexpr double kRounding = 1e-5;  // of positions in float, in pixels
    ASSERT_NEAR(motions[2 * i], isHit ? kPixels * right : 0, kRounding) << i;
    ASSERT_NEAR(motions[2 * i + 1], isHit ? -kPixels * up : 0, kRounding) << i;
  }
  EXPECT_GT(seen, 300);
}

// Of two squares in one plane the later one is seen wherever both move.
TEST_F(MovingFile, CoplanarSquaresMoveTogether) {
  const auto square = [](const std::string& width, const std::string& material,
                         const std::string& from, const std::string& to) {
    return "{\"shape\": \"quad\", \"width\": " + width + ", \"depth\": " + width +
           ", \"material\": \"" + material +
           "\", \"motion\": {\"keys\": [{\"time\": 0, \"translate\": " + from +
           "}, {\"time\": 1, \"translate\": " + to + "}]}}";
  };

  const std::string group = "\"scene\": [{\"group\": [" +
                            square("6", "red", "[0, 0, 0]", "[0.5, 0, 0]") + ", " +
                            square("2", "lit", "[0.3, 0, 0.2]", "[0.8, 0, 0.2]") +
                            "], \"transform\": {\"rotate\": [1, 0, 0, 90]}}]";

  Scene scene = at(0, group);
  EXPECT_FALSE(scene.coplanar.empty());
  const RenderOptions options;
  Renderer renderer(scene, options);
  for (const double seconds : {0.0, 0.37, 1.0, 0.0}) {
    moveScene(scene, seconds);
    renderer.sceneMoved();
    EXPECT_FALSE(scene.coplanar.empty());

    int white = 0;
    for (const Rgb& pixel : pictureOf(renderer).pixels) white += pixel.y > 0.5f;
    // The smaller square measures two by two units.
    EXPECT_EQ(white, 16 * 16) << seconds;
  }
}

// From 1 s on the transform mirrors at x = 0.
Affine mirroring(double seconds) { return Affine::scaling({seconds < 1 ? 1.0 : -1.0, 1, 1}); }

// Adds a vault along y: heights and normals depend on x alone, and x and -x are alike.
void addVault(float shift, Mesh& mesh) {
  constexpr int kColumns = 8;
  for (int i = 0; i <= kColumns; ++i) {
    const float x = static_cast<float>(i) / (kColumns / 2) - 1;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float y : {-1.0f, 1.0f}) {
      mesh.positions.push_back({x + shift, y, 0.5f - 0.5f * x * x});
      mesh.normals.emplace_back(normalized(Vec3d{double{x}, 0, 1}));
    }

    // Two triangles join this column to the next one.
    if (i == kColumns) break;
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 1});
  }
}

// Joint 0, which mirrors, moves the vertices up to x = 1; joint 1, which stands still, moves the
// others. A morph target bends all of them.
std::shared_ptr<const Deformation> mirroredSkin(const Mesh& mesh) {
  Deformation d;
  d.positions = mesh.positions;
  d.normals = mesh.normals;

  d.targets.resize(1);
  for (const Vec3f& p : mesh.positions) d.targets[0].positions.push_back({0, 0, 0.1f * p.x * p.x});
  d.weights = {0.5};
  d.skeleton = std::make_shared<const Rig>(
      Rig{{kNoNode, Affine(), std::make_shared<const Motion>(mirroring)}, {}});
  d.joints = {{0, Affine()}, {1, Affine()}};
  d.firstInfluence = {0};

  for (const Vec3f& p : mesh.positions) {
    d.influences.push_back({p.x > 1 ? 1u : 0u, 1});
    d.firstInfluence.push_back(static_cast<std::uint32_t>(d.influences.size()));
  }
  return std::make_shared<const Deformation>(std::move(d));
}

enum class Mirrors { skin, partOfASkin, node };

Scene mirroredVault(Mirrors what, bool doubleSided) {
  verify::SceneBuilder builder;
  Material material = verify::diffuseMaterial(0.8f);
  material.doubleSided = doubleSided;
  Mesh mesh;
  mesh.materials = {builder.add(material)};
  addVault(0, mesh);
  if (what == Mirrors::partOfASkin) addVault(3, mesh);
  if (what != Mirrors::node) mesh.deformation = mirroredSkin(mesh);

  Object object;
  object.meshes = {mesh};
  builder.place(std::move(object), {Affine()});
  builder.description.motion.rig = {{kNoNode, Affine(), std::make_shared<const Motion>(mirroring)}};
  if (what == Mirrors::node) builder.description.instances[0].mover = 0;
  builder.description.lights = {verify::lightAt({0, 2, 5}, 60)};
  builder.description.cameras = {{.eye = {1.03f, 0, 9}, .at = {1.03f, 0, 0}, .fov = 40}};
  return builder.build();
}

// A symmetric surface looks as before when it is mirrored, in packets and in the reference.
void expectAlikeMirrored(Scene scene) {
  const RenderOptions options = smallOptions();
  Renderer renderer(scene, options);
  const auto pictures = [&] {
    return std::array<Image, 2>{pictureOf(renderer), test::render(renderer, false).image};
  };

  const auto before = pictures();
  moveScene(scene, 2);
  renderer.sceneMoved();
  const auto after = pictures();

  for (std::size_t mode = 0; mode < 2; ++mode) {
    int lit = 0, other = 0;
    for (std::size_t i = 0; i < before[mode].pixels.size(); ++i) {
      const float a = before[mode].pixels[i].x, b = after[mode].pixels[i].x;
      lit += a > 0.1f;
      other += std::abs(a - b) > 1e-5f;
    }

    EXPECT_GT(lit, 100) << mode;
    // Edges move in the last bits, so pixels at edges may differ.
    EXPECT_LE(other, lit / 100) << mode;
  }

  moveScene(scene, 0);
  renderer.sceneMoved();
  EXPECT_EQ(firstDifference(pictures()[0], before[0]), "");
}

TEST(MovingScene, MirroredSurfacesAreShadedAsBefore) {
  for (const Mirrors what : {Mirrors::skin, Mirrors::partOfASkin, Mirrors::node}) {
    for (const bool doubleSided : {true, false}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(what)) +
                   (doubleSided ? " from both sides" : ""));
      expectAlikeMirrored(mirroredVault(what, doubleSided));
    }
  }
}

}  // namespace
}  // namespace whit
