// Closed scenes: rays that hit nothing are traced once more, if the camera is inside.
#include <gtest/gtest.h>

#include "inspect/reference_frame.h"
#include "render/renderer.h"
#include "shipped_scene.h"
#include "source_files.h"

namespace whit {
namespace {

TEST(Enclosure, HoldsForEyesWithinOnly) {
  const Scene scene = test::load(sourceFile("scenes/hard/closed-room.json"));
  RenderOptions options;
  options.size = ImageSize{16, 16};
  options.threads = 1;

  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera inside = scene.cameras.front();
  Camera outside = inside;
  outside.eye = scene.upper + (scene.upper - scene.lower) * 10.0f;

  const auto enclosedFrom = [&](const Camera& camera) {
    renderer.render(camera, film);
    return renderer.accel().enclosed();
  };

  EXPECT_TRUE(enclosedFrom(inside));
  EXPECT_FALSE(enclosedFrom(outside));
  EXPECT_TRUE(enclosedFrom(inside));
  renderReference(renderer, outside, film);
  EXPECT_FALSE(renderer.accel().enclosed());
}

}  // namespace
}  // namespace whit
