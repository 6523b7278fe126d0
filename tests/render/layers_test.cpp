// The layers of surfaces, by the integral of the GGX lobe and by closed forms, in packets and
// reference: what each layer sends out and leaves for those below. And light is linear.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "facets.h"
#include "io/gltf/material.h"
#include "pi.h"
#include "reference/sample_mean.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"
#include "sanitized.h"

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

double meanOf(const Scene& scene, const RenderOptions& o, bool packets) {
  const Image image = render(scene, o, packets).image;
  double sum = 0;
  for (const Rgb& pixel : image.pixels) sum += (pixel.x + pixel.y + pixel.z) / 3.0;
  return sum / static_cast<double>(image.pixels.size());
}

// A view of the floor, in parallel at an angle of this cosine.
Camera viewAt(double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine);
  Camera camera;
  camera.eye = Vec3f(Vec3d(0, cosine, sine) * 10);
  camera.at = {0, 0, 0};
  camera.up = {0, 0.6f, -0.8f};
  camera.orthographicHeight = 0.01f;
  return camera;
}

// A wide floor.
SceneBuilder floorOf(const Material& material, double cosine) {
  SceneBuilder builder;
  builder.add(floorAt(0, 100, builder.add(material)));
  builder.description.cameras = {viewAt(cosine)};
  return builder;
}

// The floor under an even sky: one for all views, because blurring the sky takes far longer than a
// picture.
class UnderEvenSky {
 public:
  // Ambient light stands in place of the sky for the diffuse color.
  explicit UnderEvenSky(const Material& material, float ambient = 0)
      : scene_([&] {
          SceneBuilder builder = floorOf(material, 1);
          builder.sky(1);
          builder.description.ambient.up = builder.description.ambient.down = Rgb(ambient);
          return builder.build();
        }()) {}

  double mean(double cosine, bool packets, const RenderOptions& o = plain()) {
    scene_.cameras = {viewAt(cosine)};
    return meanOf(scene_, o, packets);
  }

 private:
  Scene scene_;
};

Material plastic(float diffuse, float f0, float roughness) {
  Material m = diffuseMaterial(diffuse);
  m.specular = Rgb(f0);
  m.roughness = roughness;
  return m;
}

Material gltf(float roughness, float clearcoat = 0) {
  GltfMaterial m;
  m.base = Rgb(0.5f);
  m.metallic = 0;
  m.roughness = roughness;
  m.clearcoat = clearcoat;
  return shadedAs(m, {});
}

// glTF: mix(base, layer, F).
TEST(Layers, OfSmoothPlasticMixByFresnel) {
  constexpr std::array<double, 4> kExpected{0.520, 0.525, 0.576, 0.677};
  UnderEvenSky floor(gltf(0), 1);
  for (const bool packets : {false, true}) {
    for (std::size_t i = 0; i < kCosines.size(); ++i) {
      EXPECT_NEAR(floor.mean(kCosines[i], packets), kExpected[i], 1e-3) << packets << i;
    }
  }
}

TEST(Layers, OfPlasticMixByAlbedoAtAnyRoughness) {
  for (const float roughness : {0.02f, 0.1f, 0.24f, 0.25f, 0.26f, 0.29f, 0.31f, 0.6f, 1.0f}) {
    UnderEvenSky floor(gltf(roughness), 1);
    for (const double cosine : kCosines) {
      const double albedo = albedoByFacets(0.04, 1, std::max(roughness, kMinRoughness), cosine);
      for (const bool packets : {false, true}) {
        EXPECT_NEAR(floor.mean(cosine, packets), albedo + (1 - albedo) * 0.5, kTableError)
            << packets << ' ' << roughness << ' ' << cosine;
      }
    }
  }
}

TEST(Layers, BelowAClearcoatGetWhatItLeaves) {
  UnderEvenSky floor(gltf(0.5f, 1), 1);
  for (const bool packets : {false, true}) {
    for (const double cosine : kCosines) {
      const double coat = 0.04 + 0.96 * std::pow(1 - cosine, 5);
      const double albedo = albedoByFacets(0.04, 1, 0.5, cosine);
      const double base = albedo + (1 - albedo) * 0.5;
      EXPECT_NEAR(floor.mean(cosine, packets), coat + (1 - coat) * base, kTableError)
          << packets << ' ' << cosine;
    }
  }
}

// White paper that lets light through, with a coat and without: all the light that the mirror and
// the transmission leave is its diffuse color's.
TEST(Layers, OfACoatedSheetSendOutAllLightAndNoMore) {
  for (const float mirror : {0.0f, 0.2f}) {
    Material m = diffuseMaterial(1);
    m.mirror = m.mirrorGrazing = Rgb(mirror);
    m.coat = true;
    m.transmission = Rgb(0.72f);
    m.thin = true;
    m.ior = 1;
    UnderEvenSky sheet(m, 1);
    for (const bool packets : {false, true}) {
      EXPECT_NEAR(sheet.mean(0.6, packets), 1, 1e-6) << packets << ' ' << mirror;
    }
  }
}

// A surface of glTF without a diffuse color, with this index of refraction and specularFactor.
Material bare(float roughness, float ior = 1.5f, float strength = 1, float clearcoat = 0) {
  GltfMaterial m;
  m.base = Rgb(0.0f);
  m.metallic = 0;
  m.roughness = roughness;
  m.clearcoat = clearcoat;
  const float step = (ior - 1) / (ior + 1);
  m.specularColor = Rgb(step * step);
  m.f90 = strength;
  return shadedAs(m, {});
}

// Only a lamp: from the side, so that neither the view nor the lamp's mirror image is special.
double inLampLight(const Material& material, double cosine, bool packets) {
  SceneBuilder builder = floorOf(material, cosine);
  builder.description.lights = {sun({0.2f, -1, -0.6f}, 2)};
  return meanOf(builder.build(), plain(), packets);
}

// glTF: whatever the index of refraction, a dielectric reflects all light at grazing incidence,
// times specularFactor.
TEST(Layers, GrazingReflectanceOfGltfIsThatOfItsSpecularFactor) {
  RenderOptions sampled = plain();
  sampled.glossy = 64;
  for (const auto& [ior, strength] : {std::array{1.2f, 1.0f}, {1.33f, 0.5f}, {2.0f, 0.5f}}) {
    const double f0 = std::pow((ior - 1.0) / (ior + 1.0), 2) * double{strength};
    const Material m = bare(0.3f, ior, strength);
    UnderEvenSky floor(m);
    for (const bool packets : {false, true}) {
      for (const double cosine : {0.6, 0.35, 0.2}) {
        const double albedo = albedoByFacets(f0, double{strength}, 0.3, cosine);
        EXPECT_NEAR(floor.mean(cosine, packets), albedo, kTableError) << ior << packets << cosine;
        EXPECT_NEAR(floor.mean(cosine, packets, sampled), albedo, kTableError)
            << ior << packets << cosine;

        // The highlights of two surfaces differ by Schlick's term alone.
        const Vec3d view(0, cosine, std::sqrt(1 - cosine * cosine));
        const double vh = dot(view, normalized(view + normalized(Vec3d(-0.2, 1, 0.6))));
        const double term = std::pow(1 - vh, 5);
        const double wanted = (f0 + (double{strength} - f0) * term) / (0.04 + 0.96 * term);
        EXPECT_NEAR(inLampLight(m, cosine, packets) / inLampLight(bare(0.3f), cosine, packets),
                    wanted, 1e-5 * wanted)
            << ior << packets << cosine;
      }
    }
  }
}

// Lamps reach the lobe through the coat. The tolerance is the rounding of floats.
TEST(Layers, AClearcoatDimsTheHighlightsOfLampsBelow) {
  for (const bool packets : {false, true}) {
    for (const double cosine : kCosines) {
      const double coat = 0.04 + 0.96 * std::pow(1 - cosine, 5);
      const double alone = inLampLight(bare(0.5f), cosine, packets);
      EXPECT_GT(alone, 0.001);
      EXPECT_NEAR(inLampLight(bare(0.5f, 1.5f, 1, 1), cosine, packets), (1 - coat) * alone,
                  1e-5 * alone)
          << packets << cosine;
    }
  }
}

// Parts of scene files add up as far as there is light for them.
TEST(Layers, OfSceneFilesAddMirrorAndColor) {
  Material m = diffuseMaterial(0.5f);
  m.mirror = m.mirrorGrazing = Rgb(0.25f);
  for (const bool packets : {false, true}) {
    EXPECT_NEAR(UnderEvenSky(m, 1).mean(0.6, packets), 0.75, 1e-6);
    m.diffuse = Rgb(0.875f);
    EXPECT_NEAR(UnderEvenSky(m, 1).mean(0.6, packets), 1, 1e-6);
    m.diffuse = Rgb(0.5f);
  }
}

TEST(Layers, BlurredSkyHasTheAlbedoOfTheLobe) {
  double squares = 0;
  int count = 0;
  for (const float roughness : {0.05f, 0.2f, 0.3f, 0.5f, 0.7f, 1.0f}) {
    for (const float f0 : {0.02f, 0.04f, 0.5f, 1.0f}) {
      UnderEvenSky floor(plastic(0, f0, roughness));
      for (const double cosine : {0.1, 0.3, 0.6, 1.0}) {
        const double f90 = std::min(1.0, 25.0 * f0);
        const double albedo = albedoByFacets(f0, f90, roughness, cosine);
        for (const bool packets : {false, true}) {
          const double seen = floor.mean(cosine, packets);
          EXPECT_NEAR(seen, albedo, kTableError) << packets << roughness << ' ' << cosine << f0;

          squares += (seen - albedo) * (seen - albedo);
          ++count;
        }
      }
    }
  }

  // The root mean square that scenes/README.md states.
  EXPECT_LT(std::sqrt(squares / count), 0.001);
  EXPECT_NEAR(UnderEvenSky(plastic(0, 0.04f, 0.3f)).mean(0.3, true), 0.168, 0.001);
}

// Behind the first surface, here a clear sheet, --indirect follows one of lobe and diffuse color,
// and the mean over many pixels is that of both.
TEST(Layers, TheChoiceOfALobeKeepsTheMean) {
  Material clear = diffuseMaterial(0);
  clear.transmission = Rgb(1.0f);
  clear.ior = 1;
  clear.thin = true;
  clear.castsShadow = false;

  RenderOptions o = plain();
  o.size = ImageSize{48, 48};
  o.indirect = 1;

  for (const float f0 : {0.04f, 0.3f}) {
    for (const double cosine : {0.6, 0.2}) {
      Material red = plastic(0, f0, 0.4f);
      red.diffuse = {0.8f, 0.3f, 0.0f};

      SceneBuilder builder = floorOf(red, cosine);
      builder.add(ceilingAt(1, 100, builder.add(clear)));
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
  for (const bool packets : {false, true}) {
    for (const double cosine : {1.0, 0.35}) {
      const auto lit = [&](float diffuse, float sky) {
        SceneBuilder builder = floorOf(plastic(diffuse, 0.04f, 0.5f), cosine);
        if (sky > 0) builder.sky(sky);
        builder.description.lights = {sun({0.2f, -1, -0.1f}, 2)};
        return meanOf(builder.build(), plain(), packets);
      };

      const double nl = 1 / std::sqrt(1 + 0.04 + 0.01);
      const double left = 1 - albedoByFacets(0.04, 1, 0.5, cosine);

      EXPECT_NEAR(lit(0.5f, 0) - lit(0, 0), 0.5 / kPi * left * 2 * nl, kTableError / kPi);
      EXPECT_NEAR(lit(0.5f, 1e-6f), lit(0.5f, 0), 2e-6);
    }
  }
}

// A room that no light reaches is dark, whatever is outside, also for rough and smooth lobes.
TEST(Layers, IndirectLightKeepsTheSkyOutOfClosedRooms) {
  for (const float roughness : {0.02f, 0.2f, 0.6f}) {
    SceneBuilder builder;
    builder.add(box({-1, -1, -1}, {1, 1, 1}, builder.add(plastic(0.5f, 0.04f, roughness))));
    builder.sky(1);
    builder.description.ambient.up = builder.description.ambient.down = Rgb(1.0f);

    builder.lookFrom({0.1f, 0.2f, 0.7f}, {-0.3f, 0, -1});
    const Scene scene = builder.build();

    RenderOptions o = plain();
    o.indirect = 4;
    o.depth = 3;
    for (const bool packets : {false, true}) EXPECT_EQ(meanOf(scene, o, packets), 0) << roughness;
  }
}

// With --ambient-samples the reflected sky is occluded as ambient light is, also without any.
TEST(Layers, OcclusionHidesTheReflectedSky) {
  SceneBuilder builder = floorOf(plastic(0, 0.5f, 0.6f), 0.8);
  builder.add(ceilingAt(0.5f, 100, builder.add(blackMaterial())));
  builder.description.cameras[0].eye = {0, 0.4f, 0.3f};
  builder.sky(1);
  builder.description.ambient.occlusion = 100;
  const Scene scene = builder.build();

  RenderOptions o = plain();
  for (const bool packets : {false, true}) {
    EXPECT_GT(meanOf(scene, o, packets), 0.3);
    o.ambientSamples = 8;
    EXPECT_EQ(meanOf(scene, o, packets), 0);
    o.ambientSamples = 0;
  }
}

// A lobe of roughness 0.24 is no mirror where rays sample it: a lamp's panel of radiance 1 that
// fills half of the view of the mirrored ray is blurred. Both halves of the sky are even.
TEST(Layers, SampledLobesAreBlurredBeyondThePixel) {
  SceneBuilder builder = floorOf(gltf(0.24f), 0.6);
  for (Material& m : builder.description.materials) m.diffuse = Rgb(0.0f);
  builder.sky(1);

  RenderOptions o = plain();
  o.glossy = 64;
  EXPECT_NEAR(meanOf(builder.build(), o, true), albedoByFacets(0.04, 1, 0.24, 0.6), 1e-3);

  for (const float roughness : {0.03f, 0.05f, 0.1f, 0.24f}) {
    const Material metal = plastic(0, 0.9f, roughness);
    EXPECT_TRUE(metal.scatters(EffectSet::all()));
    EXPECT_EQ(roughness * roughness > kSmoothAlpha, roughness > 0.03f);
  }
}

// Spheres of roughness 0 to 0.5 in steps of 0.02 over a checkered floor: neighbors differ little,
// and none by much more than those before and after it.
TEST(Layers, NeighborsInARowOfRoughnessesDifferSmoothly) {
  std::vector<double> means;
  std::vector<Image> pictures;

  for (int i = 0; i <= 25; ++i) {
    GltfMaterial metal;
    metal.base = Rgb(0.9f);
    metal.roughness = 0.02f * static_cast<float>(i);

    SceneBuilder builder;
    builder.add(exactSphere(builder.add(shadedAs(metal, {})), Affine::translation({0, 1, 0})));
    builder.add(floorAt(0, 4, builder.add(diffuseMaterial(0.2f))));

    builder.sky(1);
    builder.description.lights = {sun({0.5f, -1, -0.5f}, 2)};
    builder.description.ambient.up = Rgb(0.5f);

    builder.lookFrom({0, 1.5f, 5}, {0, 1, 0});

    RenderOptions o = plain();
    o.size = ImageSize{48, 32};
    pictures.push_back(render(builder.build(), o).image);
  }

  std::vector<double> steps;
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < pictures[i].pixels.size(); ++k) {
      // Highlights of the sun are left out: they are wider and darker with each step.
      const Rgb a = min(pictures[i].pixels[k], Rgb(1.0f)),
                b = min(pictures[i - 1].pixels[k], Rgb(1.0f));
      sum += maxComponent(abs(a - b));
    }
    steps.push_back(sum / static_cast<double>(pictures[i].pixels.size()));
  }

  // The mixture goes through 13 steps: no step is more than a sixth of all of them.
  double all = 0;
  for (const double step : steps) all += step;
  EXPECT_GT(all, 0.01);
  for (const double step : steps) EXPECT_LT(step, all / 6);
}

// Materials of all kinds, as numbers decide.
Material anyMaterial(Numbers& numbers) {
  const auto color = [&] {
    return Rgb(Vec3d(numbers.in(0, 1), numbers.in(0, 1), numbers.in(0, 1)));
  };
  const auto maybe = [&](double chance) { return numbers.in(0, 1) < chance; };

  Material m = diffuseMaterial(0);
  m.diffuse = color();
  if (maybe(0.7)) m.specular = color() * (maybe(0.5) ? 0.1f : 1.0f);
  m.roughness = static_cast<float>(numbers.in(0, 1));
  if (maybe(0.3)) m.mirror = m.mirrorGrazing = color() * 0.4f;
  if (maybe(0.3)) m.mirrorGrazing = color();
  if (maybe(0.2)) m.transmission = color();

  m.coat = maybe(0.3);
  m.thin = maybe(0.3);
  m.diffuseReflection = maybe(0.8);
  m.glossyReflection = maybe(0.8);
  if (maybe(0.2)) m.coverage = static_cast<float>(numbers.in(0, 1));
  m.castsShadow = m.blocksLight();
  m.frosted = maybe(0.5);
  return m;
}

struct Lighting {
  std::vector<Light> lights;
  float sky = 0, ambient = 0, emission = 0;
};

// Balls on a floor. All lights are there in each of the pictures, since the number of a light
// decides on its random points; those that are out have no intensity.
Scene litScene(int seed, const Lighting& lighting) {
  Numbers numbers(static_cast<unsigned>(seed));
  SceneBuilder builder;
  builder.add(floorAt(0, 6, builder.add(anyMaterial(numbers))));
  for (int i = 0; i < 4; ++i) {
    const Vec3d center{numbers.in(-1.5, 1.5), numbers.in(0.3, 1.5), numbers.in(-1.5, 1)};
    const Affine map = Affine::translation(center) * Affine::scaling(Vec3d(numbers.in(0.2, 0.7)));
    builder.add(exactSphere(builder.add(anyMaterial(numbers)), map));
  }

  Material lamp = diffuseMaterial(0.3f);
  lamp.emission = Rgb(lighting.emission);
  builder.add(ceilingAt(3, 1, builder.add(lamp)));

  if (lighting.sky > 0) {
    Sky& sky = builder.description.sky;
    sky.kind = Sky::Kind::gradient;
    sky.zenith = Rgb(0.2f, 0.4f, 1.0f) * lighting.sky;
    sky.horizon = Rgb(lighting.sky);
    sky.ground = Rgb(0.1f) * lighting.sky;
  }

  Ambient& ambient = builder.description.ambient;
  ambient.up = Rgb(1.0f, 0.8f, 0.6f) * lighting.ambient;
  ambient.down = Rgb(0.3f) * lighting.ambient;
  ambient.occlusion = seed % 2 == 0 ? 1.0f : 0.0f;
  builder.description.lights = lighting.lights;

  builder.lookFrom({0, 1.5f, 5}, {0, 0.6f, 0});
  return builder.build();
}

// Options of all kinds but those that look at the brightness of the picture: --adaptive, and
// --light-cutoff, by which a light may be too dark to count.
RenderOptions anyOptions(Numbers& numbers) {
  const auto one = [&](std::initializer_list<int> choices) {
    return *(choices.begin() +
             static_cast<int>(numbers.in(0, static_cast<double>(choices.size()) - 1e-9)));
  };

  RenderOptions o = plain();
  o.size = ImageSize{12, 8};
  o.spp = one({1, 1, 2, 4});
  o.depth = one({0, 1, 2, 4});
  o.glossy = one({0, 0, 1, 4});
  o.indirect = one({0, 0, 1, 2});
  o.ambientSamples = one({0, 0, 1, 4});
  o.lightSamples = one({1, 1, 4});

  if (one({0, 1}) == 1) o.cutoff = 1e-3f;
  if (one({0, 0, 1}) == 1) o.roulette = 0.3f;
  o.shading.terminator = one({0, 1}) == 1;
  if (one({0, 1}) == 1) o.shading.fresnel = FresnelModel::schlick;
  o.packet = one({1, 8});
  return o;
}

TEST(LightIsLinear, InRandomScenesWithAnyOptions) {
  // Sanitizers look for faults of memory, which few scenes show as well as many.
  constexpr int kScenes = kSanitized ? 40 : 200;
  for (int seed = 0; seed < kScenes; ++seed) {
    Numbers numbers(static_cast<unsigned>(10000 + seed));
    const RenderOptions o = anyOptions(numbers);

    Lighting all;
    for (int i = 0; i < 3; ++i) {
      Light light =
          lightAt({static_cast<float>(numbers.in(-3, 3)), 4, static_cast<float>(numbers.in(-1, 4))},
                  static_cast<float>(numbers.in(1, 20)));
      if (i == 1) light = sun({0.3f, -1, -0.4f}, 1);
      light.radius = 0.3f;
      all.lights.push_back(light);
    }
    all.sky = all.ambient = all.emission = 1;

    // Each light is in one of two halves.
    Lighting halves[2] = {all, all};
    for (std::size_t i = 0; i < all.lights.size(); ++i) {
      halves[numbers.in(0, 1) < 0.5 ? 0 : 1].lights[i].intensity = Rgb(0.0f);
    }
    for (float Lighting::*part : {&Lighting::sky, &Lighting::ambient, &Lighting::emission}) {
      halves[numbers.in(0, 1) < 0.5 ? 0 : 1].*part = 0;
    }

    const bool packets = seed % 4 != 0;
    std::vector<Image> images;
    for (const Lighting& lighting : {halves[0], halves[1], all}) {
      images.push_back(render(litScene(seed, lighting), o, packets).image);
    }

    double brightest = 0, worst = 0;
    for (std::size_t k = 0; k < images[2].pixels.size(); ++k) {
      const Rgb sum = images[0].pixels[k] + images[1].pixels[k], both = images[2].pixels[k];
      brightest = std::max(brightest, double{maxComponent(both)});
      worst = std::max(worst, maxComponent(abs(sum - both)) / (0.1 + maxComponent(both)));
    }

    // Roundings of the sums of a path.
    EXPECT_LT(worst, 1e-5) << "scene " << seed << (packets ? " packets" : " reference");
    EXPECT_GT(brightest, 0) << seed;
  }
}

}  // namespace
}  // namespace whit::test
