// --sphere-segments from the outside: an option of every command that loads a scene.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/run_command.h"
#include "has_text.h"

namespace whit::cli {
namespace {

class SphereSegments : public testing::Test {
 protected:
  // Writes a scene with a mirrored ball over a floor. `more` holds further members of the ball.
  std::string sceneWith(const std::string& name, const std::string& more) const {
    std::ofstream(folder_ / name) << R"({
      "whit": 1, "size": [64, 48],
      "cameras": {"front": {"eye": [0, 2, 6], "at": [0, 1, 0], "fov": 40}},
      "lights": [{"position": [3, 6, 4], "intensity": [60, 60, 60]}],
      "materials": {"floor": {"diffuse": 0.5},
                    "mirror": {"diffuse": 0.1, "mirror": 0.8}},
      "scene": [{"shape": "quad", "width": 8, "depth": 8, "material": "floor"},
                {"shape": "sphere", "radius": 1, "material": "mirror",
                 "transform": {"translate": [0, 1, 0], "scale": [1, 1.2, 0.9]})" +
                                         more + "}]}";
    return folder_ / name;
  }
  std::string rendered(const std::string& scene, const std::string& segments) const {
    const std::string file = scene + segments + ".exr";
    succeed({"render", scene, "--sphere-segments", segments, "-o", file});
    return file;
  }

  TemporaryFolder folder_;
};

// The option does for all spheres what the member "segments" does for one of them.
TEST_F(SphereSegments, AreThoseOfTheScene) {
  const std::string exact = sceneWith("exact.json", ""),
                    made = sceneWith("made.json", ", \"segments\": 24");
  const auto compared = [&](const std::string& segments) {
    return runWhit({"compare", rendered(exact, segments), rendered(made, "0"), "--json", "-"}).out;
  };

  EXPECT_TRUE(hasText(compared("24"), "\"rmse\": 0.0,"));
  EXPECT_FALSE(hasText(compared("0"), "\"rmse\": 0.0,"));
}

TEST_F(SphereSegments, TooFewAreRefused) {
  expectFailure({"info", sceneWith("exact.json", ""), "--sphere-segments", "3"}, 2,
                "at least 4, found 3");
}

}  // namespace
}  // namespace whit::cli
