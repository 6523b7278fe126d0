// Spot and directional lights in the vector pipeline, and their cost where there are none.
#include <gtest/gtest.h>

#include <cmath>

#include "inspect/metrics.h"
#include "inspect/reference_frame.h"
#include "pi.h"
#include "reference/generate_rays.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

Light spot(float inner, float outer) {
  Light light = lightAt({0, 2, 0}, 10);
  light.kind = Light::Kind::spot;
  light.innerConeAngle = inner;
  light.outerConeAngle = outer;
  return light;
}

// The lights shine on a floor of albedo 0.5 that fills the picture.
Scene floorUnder(const std::vector<Light>& lights) {
  SceneBuilder builder;
  builder.add(floorAt(0, 8, builder.add(diffuseMaterial(0.5f))));
  builder.description.lights = lights;

  Camera& camera = builder.lookFrom({0, 3, 0});
  camera.up = {0, 0, -1};
  camera.fov = 50;
  return builder.build();
}

TEST(LightKinds, ASpotLightDrawsItsConeOnTheFloor) {
  constexpr double kInner = 15 * kPi / 180, kOuter = 25 * kPi / 180;
  const Scene scene = floorUnder({spot(15, 25)});
  RenderOptions o = smallOptions();
  o.size = kSmallSize;
  const Picture picture = render(scene, o);
  const Image& image = picture.image;
  const CameraFrame frame = makeCameraFrame(scene.cameras[0], image.width, image.height);

  // A float is rounded twenty times, and the edge of the cone magnifies the error.
  const double bound = 20 * 0x1p-24 / (std::cos(kInner) - std::cos(kOuter));
  std::uint64_t lit = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Ray ray = reference::generateRay(frame, x + 0.5, y + 0.5);
      const Vec3d point = ray.origin + ray.direction * (-ray.origin.y / ray.direction.y);
      const Vec3d l = Vec3d{0, 2, 0} - point;
      const double cosine = l.y / length(l);

      // The light falls off with the square of s between the inner and the outer angle.
      const double s =
          std::clamp((cosine - std::cos(kOuter)) / (std::cos(kInner) - std::cos(kOuter)), 0.0, 1.0);

      const double full = 10 * 0.5 / kPi * cosine / dot(l, l);
      ASSERT_NEAR(static_cast<double>(image.at(x, y).x), full * s * s, bound * full)
          << x << "," << y;
      lit += s > 0;
    }
  }

  // No shadow ray is traced from outside of a light's cone.
  EXPECT_GT(lit, 100u);
  EXPECT_NEAR(static_cast<double>(picture.stats.of(RayKind::shadow).rays), static_cast<double>(lit),
              2);
}

TEST(LightKinds, ADirectionalLightIsEvenAndFacesTheSurface) {
  const Picture picture = render(floorUnder({sun({3, -4, 0}, 3)}), smallOptions());
  // The light (3, -4, 0) reaches the floor at a cosine of 0.8.
  for (const Rgb& pixel : picture.image.pixels) {
    ASSERT_NEAR(static_cast<double>(pixel.x), 0.5 / kPi * 3 * 0.8, 20 * 0x1p-24);
  }

  const Picture below = render(floorUnder({sun({0, 1, 0}, 3)}), smallOptions());
  EXPECT_EQ(below.stats.of(RayKind::shadow).rays, 0u) << "the floor faces away";
}

// Every stage agrees with the scalar reference on every target, and the picture with the reference.
TEST(LightKinds, AgreeWithTheReference) {
  const Scene scene = load("effects");
  expectStagesAgreeOnEveryTarget(scene, smallOptions());
  EXPECT_LE(differenceFromReference(scene, smallOptions()).pixelsGe2CodesPct, 0.1);
}

// --disable leaves out each effect in packets and in the reference.
TEST(LightKinds, LeftOutAreGoneAsInTheReference) {
  const Scene scene = floorUnder({spot(15, 25), sun({3, -4, 0}, 3)});
  for (const Effect effect : {Effect::spotLights, Effect::directionalLights}) {
    RenderOptions o = smallOptions();
    o.disable = EffectSet().with(effect);
    EXPECT_LE(differenceFromReference(scene, o).pixelsGe2CodesPct, 0);
  }
}

// The code of spot and directional lights keeps the bits of point lights where it is compiled in.
TEST(LightKinds, TheirKernelsKeepTheBitsOfPointLights) {
  const Scene scene = floorUnder({lightAt({0.5f, 2, -0.25f}, 10), lightAt({-1, 1, 1}, 4)});
  ASSERT_FALSE(scene.effects.has(Effect::spotLights) ||
               scene.effects.has(Effect::directionalLights));

  RenderOptions o = smallOptions();
  const Image plain = render(scene, o).image;
  o.effects = EffectChoice::all;
  EXPECT_EQ(firstDifference(render(scene, o).image, plain), "");
}

TEST(LightKinds, HowTheFrameIsSplitChangesNoBit) {
  expectBitsWhateverTheQueues(floorUnder({spot(15, 25), sun({3, -4, 0}, 3)}), smallOptions());
}

}  // namespace
}  // namespace whit::test
