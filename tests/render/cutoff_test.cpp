// --cutoff ends the doubling of rays, whatever the materials and the depth.
#include <gtest/gtest.h>

#include <cmath>

#include "inspect/reference_frame.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

constexpr int kDepth = 64;

// A cube seen from within.
Scene closedRoom(const Material& wall) {
  SceneBuilder builder;
  builder.add(box({-1, -1, -1}, {1, 1, 1}), wall);
  builder.lookFrom({0.1f, 0.2f, 0.3f}, {1, 0, 0});
  return builder.build();
}

// The depth ends paths late, and the cutoff is the default one.
RenderOptions deepOptions() {
  RenderOptions o = smallOptions({8, 8});
  o.depth = kDepth;
  o.cutoff = RenderOptions().cutoff;
  return o;
}

// A closed room that emits 1 - a and reflects a has the radiance 1 everywhere, to what the depth
// cuts off. The default cutoff must not take more.
TEST(Cutoff, ClosedRoomsKeepTheirLight) {
  for (const float albedo : {0.5f, 0.8f, 0.9f}) {
    Material wall = diffuseMaterial(albedo);
    wall.emission = Rgb(1 - albedo);
    RenderOptions o = deepOptions();
    o.indirect = 4;

    // Paths end where they count for less than the cutoff, if that is before the depth does.
    const double reflected{albedo}, tail = std::pow(reflected, kDepth + 1);
    const double bound = std::max(tail, double{o.cutoff} / (1 - reflected)) + 1e-4;
    const auto [packets, reference] = renderBoth(closedRoom(wall), o);
    for (const Image& image : {packets.image, reference.image}) {
      for (const Rgb& pixel : image.pixels) {
        EXPECT_LE(pixel.x, 1 + 1e-4) << albedo;
        EXPECT_GE(pixel.x, 1 - bound) << albedo;
      }
    }
  }
}

// The walls of a white room reflect all light, by lobe and diffuse color together. So each path
// collects the emission of as many surfaces as the depth lets it reach, without noise, and the
// cutoff takes nothing. Two rays at each surface would halve in weight with every bounce.
TEST(Cutoff, WhiteRoomsKeepTheirLightWithOneRayABounce) {
  constexpr int kSamples = 4;
  for (const float specular : {0.04f, 0.5f, 1.0f}) {
    for (const float roughness : {0.02f, 0.3f, 1.0f}) {
      Material wall = glossyMaterial(1, specular, roughness);
      wall.emission = Rgb(1.0f / (kDepth + 1));
      RenderOptions o = deepOptions();
      o.glossy = o.indirect = kSamples;

      const auto [packets, reference] = renderBoth(closedRoom(wall), o);
      for (const Picture& picture : {packets, reference}) {
        // Rounding adds up over the bounces of a path, to less than an ulp of 1 at each.
        constexpr double kRounding = kDepth * 0x1p-23;
        // A sample of weight below the cutoff at the first surface takes its light along.
        const double bound = kRounding + 2 * kSamples * double{o.cutoff};
        for (const Rgb& pixel : picture.image.pixels) {
          EXPECT_NEAR(pixel.x, 1, bound) << specular << ' ' << roughness;
        }
        // The samples of both lobes of the first surface go on as one ray a bounce.
        const std::size_t most = picture.image.pixels.size() * (1 + 2 * kSamples * kDepth);
        EXPECT_LE(picture.stats.allRays(), most) << specular << ' ' << roughness;
      }
    }
  }
}

// A red mirror leaves nothing of a red transmission, but Fresnel's law still takes its share of the
// other channels' diffuse light.
TEST(DiffuseLimit, CountsFresnelWhereTheCoatTakesTheTransmission) {
  SceneBuilder builder;
  Material m = diffuseMaterial(0.8f);
  m.mirror = m.mirrorGrazing = Rgb(1, 0, 0);
  m.transmission = Rgb(0.5f, 0, 0);
  m.ior = 2.5f;
  builder.add(box({-1, -1, -1}, {1, 1, 1}), m);
  lightEvenly(builder, 1);
  builder.lookFrom({0.5f, 0.7f, 3});

  RenderOptions o = smallOptions({16, 12});
  const auto [packets, reference] = renderBoth(builder.build(), o);
  for (const auto i : indices(packets.image.pixels)) {
    EXPECT_NEAR(packets.image.pixels[i].y, reference.image.pixels[i].y, 1e-4) << i;
  }
}

// Twenty faces that reflect 0.9 and pass the rest on. Without a cutoff, impulses would double at
// every one of them: up to 2^16 a pixel at this depth, and 2^64 at the default one.
TEST(Cutoff, RaysOfCoatedGlassAreBounded) {
  SceneBuilder builder;
  Material coated = glassMaterial(1);
  coated.mirror = coated.mirrorGrazing = Rgb(0.9f);

  const auto material = builder.add(coated);
  for (int i = 0; i < 10; ++i) {
    const auto y = static_cast<float>(i);
    builder.add(box({-500, y, -500}, {500, y + 0.5f, 500}, material));
  }
  builder.lookFrom({0, 4.75, 0}, {1, 0, 0});

  RenderOptions o = smallOptions({4, 4});
  o.depth = 16;
  o.cutoff = 1e-2f;

  const auto [packets, reference] = renderBoth(builder.build(), o);
  const std::uint64_t rays = packets.stats.allRays();

  // As many paths as cutoffs go into 1, each with a ray a depth.
  const double bound = 16 * o.depth / static_cast<double>(o.cutoff);
  EXPECT_GT(rays, 16u * 16u) << "they do branch";
  EXPECT_LE(static_cast<double>(rays), bound);
  EXPECT_EQ(rays, reference.stats.allRays());
}

}  // namespace
}  // namespace whit::test
