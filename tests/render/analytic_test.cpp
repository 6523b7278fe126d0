// The vector pipeline against closed forms: pictures whose every pixel is known. More of them are
// hard cases (tests/verify): slabs of glass, halls of mirrors, and glass that bends nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// A float is rounded twenty times in a formula of about that many operations.
constexpr double kFloatFormula = 20 * 0x1p-24;

// The point of the floor that a pixel's center sees reflects I kd / pi cos / d^2.
TEST(Analytic, LightFallsOffOverAPlane) {
  SceneBuilder builder = withFloor(diffuseMaterial(0.5f), 8);
  const Light light = lightAt({0.5f, 2, -0.25f}, 10);
  builder.description.lights = {light};
  builder.description.cameras = {lookingDown()};
  const Scene scene = builder.build();
  const Image image = render(scene, smallOptions()).image;

  double worst = 0;
  forEachRay(scene, image, [&](const Ray& ray, const Rgb& seen) {
    const Vec3d point = ray.origin + ray.direction * (-ray.origin.y / ray.direction.y);
    const Vec3d l = Vec3d(light.position) - point;
    const double wanted = 10 * 0.5 / kPi * (l.y / length(l)) / dot(l, l);
    worst = std::max(worst, std::fabs(double{seen.x} / wanted - 1));
  });

  // The point where the ray hits the floor carries the rounding of the ray's direction, times
  // distance over height.
  constexpr double kBound = 4 * kFloatFormula;
  EXPECT_LE(worst, kBound);
}

// A scene without any material: the tables of the kernels must not be empty because of that.
TEST(Analytic, NothingShowsTheSky) {
  SceneBuilder builder;
  builder.sky(0.25f);
  builder.description.cameras = {lookingDown()};
  const Scene scene = repaired(std::move(builder.description));
  ASSERT_TRUE(scene.materials.empty());

  const auto [packets, reference] = renderBoth(scene, smallOptions());
  for (const Picture& picture : {packets, reference}) {
    for (const Rgb& pixel : picture.image.pixels) EXPECT_EQ(pixel, Rgb(0.25f));
  }
}

// A mirror of reflectance R reflects a sky of radiance 1, and there is nothing else.
TEST(Analytic, MirrorShowsTheSky) {
  SceneBuilder builder = withFloor(mirrorMaterial(0.75f), 8);
  builder.sky(1);
  builder.description.cameras = {lookingDown()};
  for (const Rgb& pixel : render(builder.build(), smallOptions()).image.pixels) {
    EXPECT_EQ(pixel, Rgb(0.75f));
  }
}

}  // namespace
}  // namespace whit::test
