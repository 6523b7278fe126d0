// Light that diffuse surfaces send to and fro, against radiosity: inside a sphere every point sees
// each part of the wall by the part's share of the area.
#include <gtest/gtest.h>

#include "reference/sample_mean.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

using namespace verify;

// Of 2000 runs with other random numbers, one would fail by chance.
constexpr double kStandardErrors = 4;

TEST(Radiosity, HalvesOfASphereLightEachOther) {
  constexpr float kAlbedo = 0.75f;
  Material wall = diffuseMaterial(kAlbedo);
  wall.emission = Rgb(1);
  SceneBuilder builder;
  wall.emissionMap = builder.add(makeTexture(
      TexelFormat::color, 2, 1, {encodeColorTexel(Rgb(1.0f)), encodeColorTexel(Rgb(0.0f))}));
  builder.add(exactSphere(), wall);
  // The half that emits is to the left of the eye, which looks along the plane between them.
  builder.lookFrom({-0.3f, 0.2f, 0}, {1, 0, 0});
  const Scene scene = builder.build();

  RenderOptions o = smallOptions({96, 64});
  o.shading.textureFilter = TextureFilter::nearest;
  o.depth = 4;
  o.cutoff = 0;
  o.indirect = 24;

  double reflected = 0;  // of light that is 1/2 in the mean
  for (int i = 0; i < o.depth; ++i) reflected = kAlbedo * (0.5 + reflected);

  for (const float roulette : {0.0f, 0.5f}) {
    o.roulette = roulette;
    const auto [packets, reference] = renderBoth(scene, o);
    for (const Film* film : {&packets, &reference}) {
      for (const bool emits : {true, false}) {
        SampleMean mean;
        forEachPixel(film->image, [&](int x, int y) {
          if ((x < o.size->width / 2) == emits) mean.add(film->image.at(x, y).x - emits);
        });

        EXPECT_NEAR(mean.value(), reflected, kStandardErrors * mean.error())
            << roulette << (film == &packets) << emits;
        EXPECT_LT(kStandardErrors * mean.error(), 0.01 * reflected);
      }
    }
  }
}

}  // namespace
}  // namespace whit::test
