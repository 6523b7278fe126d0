// The brightness of lights, and of the studio that goes with them.
#include "make/light_level.h"
#include "make/studio_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pi.h"
#include "scene_builder.h"

namespace whit {
namespace {

SceneDescription litSquare(const Light& light) {
  SceneDescription scene = test::sceneOf(test::square());
  scene.objects[0].meshes[0].triangles.resize(1);
  scene.lights.push_back(light);
  return scene;
}

Light lamp(double height) {
  Light light;
  light.position = Vec3f(2.0f / 3, 1.0f / 3, static_cast<float>(height));  // over the middle
  light.intensity = Rgb(8.0f);
  return light;
}

TEST(LightLevel, IsThatOfAWhiteSurface) {
  EXPECT_NEAR(lightLevel(litSquare(lamp(2))), 8 / (4 * kPi), 1e-6);
  EXPECT_EQ(lightLevel(litSquare(lamp(-2))), 0) << "behind it";
  EXPECT_EQ(lightLevel(test::sceneOf(test::square())), 0) << "no light";

  Light sun;
  sun.kind = Light::Kind::directional;
  sun.direction = {0, 0.6f, -0.8f};
  sun.intensity = Rgb(5.0f);
  EXPECT_NEAR(lightLevel(litSquare(sun)), 4 / kPi, 1e-6);

  Light spot = lamp(2);
  spot.kind = Light::Kind::spot;
  spot.direction = {0, 0, -1};
  EXPECT_NEAR(lightLevel(litSquare(spot)), 8 / (4 * kPi), 1e-6);
  spot.direction = {1, 0, 0};
  EXPECT_EQ(lightLevel(litSquare(spot)), 0) << "beside its cone";
}

TEST(StudioSky, IsGrayAndBrightestAbove) {
  const Sky sky = studioSky();
  EXPECT_EQ(skyName(sky), "studio");
  EXPECT_EQ(sky.image.r, sky.image.g);
  EXPECT_EQ(sky.image.r, sky.image.b);
  EXPECT_EQ(sky.image.r.size(), 256u * 128u);

  const auto [least, most] = std::minmax_element(sky.image.r.begin(), sky.image.r.end());
  EXPECT_GT(*least, 0.05f);
  EXPECT_GT(*most, 3.0f);
  EXPECT_LT(*most, 5.0f);

  // No light box is at the horizon or below, where it would be visible beside the model.
  const auto horizon = sky.image.r.begin() + 256 * 62;
  EXPECT_LT(*std::max_element(horizon, sky.image.r.end()), 0.21f);

  const Ambient ambient = ambientFromSky(sky, 1);
  EXPECT_GT(ambient.up.x, 2 * ambient.down.x);
}

}  // namespace
}  // namespace whit
