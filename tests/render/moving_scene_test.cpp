// Scenes that move: pictures by closed forms, and that they follow from the time alone.
#include "bake/move_scene.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "render/film.h"
#include "shipped_scene.h"
#include "simd/deform_vertices.h"

namespace whit {
namespace {

using test::firstDifference;
using test::smallOptions;

Scene orreryAt(double seconds) {
  Warnings warnings;
  LoadOptions options;
  options.instant.seconds = seconds;
  return Scene::finalize(loadScene("orrery", options, warnings), warnings);
}

Image pictureOf(Renderer& renderer, const Scene& scene, const RenderOptions& options) {
  Film film = makeFilm(scene, options);
  renderer.render(chooseCamera(scene, options), film);
  return film.image;
}

Image pictureOf(const Scene& scene, const RenderOptions& options) {
  Renderer renderer(scene, options);
  return pictureOf(renderer, scene, options);
}

TEST(MovingScene, PicturesFollowFromTheTimeAlone) {
  const RenderOptions options = smallOptions();
  Scene scene = orreryAt(0);
  Renderer renderer(scene, options);
  const Image first = pictureOf(renderer, scene, options);
  for (const double seconds : {7.25, 2.4, 0.0, 2.4}) {
    moveScene(scene, seconds, simd::deformVertices);
    renderer.sceneMoved();
    const Image moved = pictureOf(renderer, scene, options);
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
  moveScene(scene, 2.5, simd::deformVertices);
  EXPECT_EQ(scene.lights[1].intensity, Rgb(7.0f));
  const double turn = -std::numbers::pi / 2;  // the lamp goes once around in ten seconds
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
    Warnings warnings;
    LoadOptions options;
    options.instant.seconds = seconds;
    return Scene::finalize(loadScene(file_.string(), options, warnings), warnings);
  }

  std::filesystem::path file_;
};

// Center and area of what shines, in pixels from the middle of the picture.
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

// A glowing ball in parallel rays, eight pixels a unit: a disc where it is, as large as it is.
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
    moveScene(scene, seconds, simd::deformVertices);
    renderer.sceneMoved();
    const Seen seen = seenIn(pictureOf(renderer, scene, options));
    const double t = seconds / 4, radius = (1 + t) * kPixels;
    // Of pixels along the rim as many are counted that are less than half covered as are not that
    // are more: the circumference's pixels err as in a walk.
    const double rim = std::sqrt(2 * std::numbers::pi * radius);
    EXPECT_NEAR(seen.x, 2 * t * kPixels, 0.1) << seconds;
    EXPECT_NEAR(seen.y, -t * kPixels, 0.1) << seconds;
    EXPECT_NEAR(seen.area, std::numbers::pi * radius * radius, rim) << seconds;
  }
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
    moveScene(scene, seconds, simd::deformVertices);
    renderer.sceneMoved();
    EXPECT_FALSE(scene.coplanar.empty());
    int white = 0;
    for (const Rgb& pixel : pictureOf(renderer, scene, options).pixels) white += pixel.y > 0.5f;
    EXPECT_EQ(white, 16 * 16) << seconds;  // two by two units
  }
}

}  // namespace
}  // namespace whit
