// The layers of surfaces, by the integral of the GGX lobe and by closed forms, in packets and
// reference: what each layer sends out and leaves for those below.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "facets.h"
#include "io/gltf/material.h"
#include "pi.h"
#include "reference/sample_mean.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// The greatest error of the table that whit looks albedos up in, away from grazing views, as
// scenes/README.md states it.
constexpr double kTableError = 0.005;

constexpr std::array<double, 4> kCosines{1, 0.6, 0.35, 0.2};

RenderOptions plain() {
  RenderOptions o;
  o.size = ImageSize{4, 4};
  o.threads = 1;
  o.cutoff = 0;
  o.shading.lightCutoff = 0;
  return o;
}

double meanOf(const Image& image) {
  double sum = 0;
  for (const Rgb& pixel : image.pixels) sum += (pixel.x + pixel.y + pixel.z) / 3.0;
  return sum / static_cast<double>(image.pixels.size());
}

// Returns the means of the pictures of both modes.
std::array<double, 2> meansOf(const Scene& scene, const RenderOptions& o = plain()) {
  const auto [packets, reference] = renderBoth(scene, o);
  return {meanOf(packets.image), meanOf(reference.image)};
}

void expectMeans(const Scene& scene, double wanted, double bound,
                 const RenderOptions& o = plain()) {
  for (const double mean : meansOf(scene, o)) EXPECT_NEAR(mean, wanted, bound);
}

// A view of the floor, in parallel at an angle of this cosine.
Camera viewAt(double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine);
  Camera camera;
  camera.eye = Vec3f(Vec3d(0, cosine, sine) * 10);
  camera.up = {0, 0.6f, -0.8f};
  camera.orthographicHeight = 0.01f;
  return camera;
}

// A wide floor.
SceneBuilder floorOf(const Material& material, double cosine) {
  SceneBuilder builder = withFloor(material, 100);
  builder.description.cameras = {viewAt(cosine)};
  return builder;
}

// The floor under an even sky. Ambient light stands in place of the sky for the diffuse color.
Scene underEvenSky(const Material& material, float ambient = 0) {
  SceneBuilder builder = floorOf(material, 1);
  builder.sky(1);
  lightEvenly(builder, ambient);
  return builder.build();
}

// One scene serves all views, because blurring the sky takes far longer than a picture.
const Scene& seenAt(Scene& floor, double cosine) {
  floor.cameras = {viewAt(cosine)};
  return floor;
}

GltfMaterial dielectric(float base, float roughness, float clearcoat = 0) {
  GltfMaterial m;
  m.base = Rgb(base);
  m.metallic = 0;
  m.roughness = roughness;
  m.clearcoat = clearcoat;
  return m;
}

// The reflectance of a smooth dielectric.
double fresnel(double cosine) { return 0.04 + 0.96 * std::pow(1 - cosine, 5); }

// glTF: mix(base, layer, share), where the layer is white.
double mixed(double base, double share) { return std::lerp(base, 1.0, share); }

// Plastic of any roughness, and what is below a clearcoat.
TEST(Layers, OfGltfMixByFresnelOrByTheAlbedoOfTheLobe) {
  struct Case {
    float roughness, clearcoat = 0;
    double bound = kTableError;
  };
  for (const Case& c : {Case{0, 0, 1e-3},
                        {0.02f},
                        {0.1f},
                        {0.24f},
                        {0.25f},
                        {0.26f},
                        {0.29f},
                        {0.31f},
                        {0.6f},
                        {1.0f},
                        {0.5f, 1}}) {
    Scene floor = underEvenSky(shadedAs(dielectric(0.5f, c.roughness, c.clearcoat), {}), 1);
    for (const double cosine : kCosines) {
      SCOPED_TRACE(testing::Message() << c.roughness << ' ' << cosine);

      const double lobe = std::max(c.roughness, kMinRoughness);
      const double share =
          c.roughness == 0 ? fresnel(cosine) : albedoByFacets(0.04, 1, lobe, cosine);
      const double wanted = mixed(mixed(0.5, share), double{c.clearcoat} * fresnel(cosine));
      expectMeans(seenAt(floor, cosine), wanted, c.bound);
    }
  }
}

// Mirror and colors add up as far as there is light for them: parts of scene files, and white paper
// that lets light through, with a coat and without.
TEST(Layers, AddUpToAllLightAndNoMore) {
  struct Case {
    float diffuse, mirror;
    bool isPaper;
    double sum;
  };
  for (const Case& c : {Case{0.5f, 0.25f, false, 0.75},
                        {0.875f, 0.25f, false, 1},
                        {1, 0, true, 1},
                        {1, 0.2f, true, 1}}) {
    SCOPED_TRACE(testing::Message() << c.diffuse << ' ' << c.mirror);
    Material m = diffuseMaterial(c.diffuse);
    m.mirror = m.mirrorGrazing = Rgb(c.mirror);
    m.coat = m.thin = c.isPaper;
    m.ior = 1;
    if (c.isPaper) m.transmission = Rgb(0.72f);
    Scene floor = underEvenSky(m, 1);
    expectMeans(seenAt(floor, 0.6), c.sum, 1e-6);
  }
}

// White paint that covers a part of a face of glass. The glass reflects through the paint, and what
// it lets pass is shared by the paint and the sky behind the glass.
TEST(Layers, ASheetOnGlassGetsWhatTheGlassDoesNotReflect) {
  Material paint = diffuseMaterial(1);
  for (const float coverage : {0.3f, 0.9f}) {
    paint.coverage = coverage;
    for (const double cosine : kCosines) {
      SceneBuilder builder = floorOf(paint, cosine);
      builder.add(floorAt(0, 100), glassMaterial(1.5f));
      builder.sky(1);
      lightEvenly(builder, 1);
      expectMeans(builder.build(), 1, 1e-6);
    }
  }
}

// Only a lamp: from the side, so that neither the view nor the lamp's mirror image is special.
std::array<double, 2> inLampLight(const GltfMaterial& material, double cosine) {
  SceneBuilder builder = floorOf(shadedAs(material, {}), cosine);
  builder.description.lights = {sun({0.2f, -1, -0.6f}, 2)};
  return meansOf(builder.build());
}

// glTF: whatever the index of refraction, a dielectric reflects all light at grazing incidence,
// times specularFactor.
TEST(Layers, GrazingReflectanceOfGltfIsThatOfItsSpecularFactor) {
  RenderOptions sampled = plain();
  sampled.glossy = 64;
  for (const auto& [ior, strength] : {std::array{1.2f, 1.0f}, {1.33f, 0.5f}, {2.0f, 0.5f}}) {
    const float atNormal = std::pow((ior - 1) / (ior + 1), 2.0f);
    const double f0 = double{atNormal} * double{strength};
    GltfMaterial m = dielectric(0, 0.3f);
    m.specularColor = Rgb(atNormal);
    m.f90 = strength;

    Scene floor = underEvenSky(shadedAs(m, {}));
    for (const double cosine : {0.6, 0.35, 0.2}) {
      SCOPED_TRACE(testing::Message() << ior << ' ' << cosine);
      const double albedo = albedoByFacets(f0, double{strength}, 0.3, cosine);
      expectMeans(seenAt(floor, cosine), albedo, kTableError);
      expectMeans(seenAt(floor, cosine), albedo, kTableError, sampled);

      // The highlights of two surfaces differ by Schlick's term alone.
      const Vec3d view(0, cosine, std::sqrt(1 - cosine * cosine));
      const double vh = dot(view, normalized(view + normalized(Vec3d(-0.2, 1, 0.6))));
      const double wanted = std::lerp(f0, double{strength}, std::pow(1 - vh, 5)) / fresnel(vh);
      const auto lit = inLampLight(m, cosine), common = inLampLight(dielectric(0, 0.3f), cosine);
      for (const std::size_t mode : {0, 1}) {
        EXPECT_NEAR(lit[mode] / common[mode], wanted, 1e-5 * wanted);
      }
    }
  }
}

// Lamps reach the lobe through the coat. The tolerance is the rounding of floats.
TEST(Layers, AClearcoatDimsTheHighlightsOfLampsBelow) {
  for (const double cosine : kCosines) {
    const auto alone = inLampLight(dielectric(0, 0.5f), cosine);
    const auto coated = inLampLight(dielectric(0, 0.5f, 1), cosine);
    for (const std::size_t mode : {0, 1}) {
      EXPECT_GT(alone[mode], 0.001);
      EXPECT_NEAR(coated[mode] / alone[mode], 1 - fresnel(cosine), 1e-5) << cosine;
    }
  }
}

TEST(Layers, BlurredSkyHasTheAlbedoOfTheLobe) {
  double squares = 0;
  int count = 0;
  for (const float roughness : {0.05f, 0.2f, 0.3f, 0.5f, 0.7f, 1.0f}) {
    for (const float f0 : {0.02f, 0.04f, 0.5f, 1.0f}) {
      Scene floor = underEvenSky(glossyMaterial(0, f0, roughness));
      for (const double cosine : {0.1, 0.3, 0.6, 1.0}) {
        const double albedo = albedoByFacets(f0, std::min(1.0, 25.0 * f0), roughness, cosine);
        for (const double seen : meansOf(seenAt(floor, cosine))) {
          EXPECT_NEAR(seen, albedo, kTableError) << roughness << ' ' << cosine << ' ' << f0;
          squares += (seen - albedo) * (seen - albedo);
          ++count;
        }
      }
    }
  }

  // The root mean square that scenes/README.md states.
  EXPECT_LT(std::sqrt(squares / count), 0.001);

  // A number, in case that the integral and the table are wrong alike.
  Scene floor = underEvenSky(glossyMaterial(0, 0.04f, 0.3f));
  expectMeans(seenAt(floor, 0.3), 0.168, 0.001);
}

// Behind the first surface, here a clear sheet, --indirect follows one of lobe and diffuse color,
// and the mean over many pixels is that of both.
TEST(Layers, TheChoiceOfALobeKeepsTheMean) {
  Material clear = glassMaterial(1);
  clear.thin = true;
  clear.castsShadow = false;

  RenderOptions o = plain();
  o.size = ImageSize{48, 48};
  o.indirect = 1;

  for (const float f0 : {0.04f, 0.3f}) {
    for (const double cosine : {0.6, 0.2}) {
      Material red = glossyMaterial(0, f0, 0.4f);
      red.diffuse = {0.8f, 0.3f, 0.0f};

      SceneBuilder builder = floorOf(red, cosine);
      builder.add(ceilingAt(1, 100), clear);
      builder.sky(1);
      const Scene scene = builder.build();

      const double albedo = albedoByFacets(f0, 1, 0.4, cosine);
      for (const bool packets : {false, true}) {
        const Image image = render(scene, o, packets).image;

        for (int channel = 0; channel < 3; ++channel) {
          SampleMean mean;
          for (const Rgb& pixel : image.pixels) mean.add(double{pixel[channel]});
          // 4.5 standard errors, and the error of the midpoint rule.
          EXPECT_NEAR(mean.value(), albedo + (1 - albedo) * double{red.diffuse[channel]},
                      4.5 * mean.error() + 2e-4)
              << f0 << ' ' << cosine << packets << channel;
        }
      }
    }
  }
}

// The diffuse color is what the lobe leaves, whatever the light.
TEST(Layers, ALampLightsWhatTheLobeLeaves) {
  for (const double cosine : {1.0, 0.35}) {
    const auto lit = [&](float diffuse, float sky) {
      SceneBuilder builder = floorOf(glossyMaterial(diffuse, 0.04f, 0.5f), cosine);
      if (sky > 0) builder.sky(sky);
      builder.description.lights = {sun({0.2f, -1, -0.1f}, 2)};
      return meansOf(builder.build());
    };

    const double nl = 1 / std::sqrt(1 + 0.04 + 0.01);
    const double left = 1 - albedoByFacets(0.04, 1, 0.5, cosine);
    const auto black = lit(0, 0), gray = lit(0.5f, 0), beforeASky = lit(0.5f, 1e-6f);
    for (const std::size_t mode : {0, 1}) {
      EXPECT_NEAR(gray[mode] - black[mode], 0.5 / kPi * left * 2 * nl, kTableError / kPi);
      EXPECT_NEAR(beforeASky[mode], gray[mode], 2e-6);
    }
  }
}

// A room that no light reaches is dark, whatever is outside, also for rough and smooth lobes.
TEST(Layers, IndirectLightKeepsTheSkyOutOfClosedRooms) {
  for (const float roughness : {0.02f, 0.2f, 0.6f}) {
    SceneBuilder builder;
    builder.add(box({-1, -1, -1}, {1, 1, 1}), glossyMaterial(0.5f, 0.04f, roughness));
    builder.sky(1);
    lightEvenly(builder, 1);
    builder.lookFrom({0.1f, 0.2f, 0.7f}, {-0.3f, 0, -1});

    RenderOptions o = plain();
    o.indirect = 4;
    o.depth = 3;
    expectMeans(builder.build(), 0, 0, o);
  }
}

// With --ambient-samples the reflected sky is occluded as ambient light is, also without any.
TEST(Layers, OcclusionHidesTheReflectedSky) {
  SceneBuilder builder = floorOf(glossyMaterial(0, 0.5f, 0.6f), 0.8);
  builder.add(ceilingAt(0.5f, 100), blackMaterial());
  builder.description.cameras[0].eye = {0, 0.4f, 0.3f};
  builder.sky(1);
  builder.description.ambient.occlusion = 100;
  const Scene scene = builder.build();

  for (const double mean : meansOf(scene)) EXPECT_GT(mean, 0.3);
  RenderOptions o = plain();
  o.ambientSamples = 8;
  expectMeans(scene, 0, 0, o);
}

// Spheres of roughness 0 to 0.5 in steps of 0.02 over a floor: neighbors differ little,
// and none by much more than those before and after it.
TEST(Layers, NeighborsInARowOfRoughnessesDifferSmoothly) {
  std::vector<double> steps;
  Image before;
  for (int i = 0; i <= 25; ++i) {
    GltfMaterial metal;
    metal.base = Rgb(0.9f);
    metal.roughness = 0.02f * static_cast<float>(i);

    SceneBuilder builder;
    builder.add(exactSphere(0, Affine::translation({0, 1, 0})), shadedAs(metal, {}));
    builder.add(floorAt(0, 4), diffuseMaterial(0.2f));

    builder.sky(1);
    builder.description.lights = {sun({0.5f, -1, -0.5f}, 2)};
    builder.description.ambient.up = Rgb(0.5f);
    builder.lookFrom({0, 1.5f, 5}, {0, 1, 0});

    RenderOptions o = plain();
    o.size = ImageSize{48, 32};
    Image image = render(builder.build(), o).image;
    // Highlights of the sun are left out: they are wider and darker with each step.
    for (Rgb& pixel : image.pixels) pixel = min(pixel, Rgb(1.0f));

    double sum = 0;
    for (std::size_t k = 0; k < before.pixels.size(); ++k) {
      sum += maxComponent(abs(image.pixels[k] - before.pixels[k]));
    }
    steps.push_back(sum / static_cast<double>(image.pixels.size()));
    before = std::move(image);
  }

  // The mixture goes through 13 steps: no step is more than a sixth of all of them. The first
  // picture has none before it.
  const double all = std::accumulate(steps.begin(), steps.end(), 0.0);
  EXPECT_GT(all, 0.01);
  for (const double step : steps) EXPECT_LT(step, all / 6);
}

}  // namespace
}  // namespace whit::test
