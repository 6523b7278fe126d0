// A white furnace: bodies in uniform light of radiance 1, of materials of all kinds. Each surface
// sends out at most what it gets, so nothing looks brighter than 1, and nothing darker where
// nothing absorbs.
#include <gtest/gtest.h>

#include <cmath>

#include "facets.h"
#include "io/files.h"
#include "io/memory_budget.h"
#include "io/model.h"
#include "io/scene_files.h"
#include "pi.h"
#include "reference/add_impulses.h"
#include "reference/lobe.h"
#include "reference/sample_mean.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// Roundings of floats along a path. It is no statistical tolerance: what the lobe
// takes from the others is the weight of the very samples that it gives.
constexpr float kRoundingsOfAPath = 1e-4f;

constexpr int kBallsAcross = 25, kBallsDown = 20, kBalls = kBallsAcross * kBallsDown,
              kPixelsASide = 3;

// A ball of each material in a grid of them, seen in parallel from afar. Each is farther away than
// the one before, so that they hardly reflect one another.
Scene balls(const std::vector<Material>& materials) {
  SceneBuilder builder;
  builder.sky(1);
  builder.description.ambient.up = builder.description.ambient.down = Rgb(1.0f);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto column = static_cast<double>(i % kBallsAcross),
               row = static_cast<double>(i / kBallsAcross);
    const Vec3d center{column - (kBallsAcross - 1) / 2.0, row - (kBallsDown - 1) / 2.0,
                       -8 * static_cast<double>(i)};
    const Affine map = Affine::translation(center) * Affine::scaling(Vec3d(0.49));
    builder.add(exactSphere(builder.add(materials[i]), map));
  }

  builder.lookFrom({0, 0, 50}).orthographicHeight = kBallsDown;
  return builder.build();
}

// Whether the diffuse color is lit by rays, or by the ambient light, which is of radiance 1 as
// well.
enum class Diffuse { byAmbientLight, byRays };

RenderOptions furnace(Diffuse diffuse = Diffuse::byRays) {
  RenderOptions o = smallOptions();
  o.size = ImageSize{kBallsAcross * kPixelsASide, kBallsDown * kPixelsASide};
  o.depth = 4;
  o.cutoff = 0;
  o.glossy = 3;
  o.indirect = diffuse == Diffuse::byRays ? 1 : 0;
  return o;
}

// Where rays follow one of lobe and diffuse color, a single path is only bounded if all is gray:
// red light that stands for both a red lobe and the cyan diffuse color below is more than 1.
enum class Colors { gray, any };

// The least and the largest channel of the picture.
std::pair<float, float> rangeOf(const Scene& scene, const RenderOptions& o, bool packets) {
  float least = 2, largest = 0;
  const Image image = render(scene, o, packets).image;
  for (const Rgb& pixel : image.pixels) {
    least = std::min({least, pixel.x, pixel.y, pixel.z});
    largest = std::max(largest, maxComponent(pixel));
  }
  return {least, largest};
}

// A color in JSON of random numbers, each in [0, high), and with a count of 4 an alpha.
std::string listOf(Numbers& numbers, int count, Colors colors, double high = 1) {
  const std::string gray = std::to_string(numbers.in(0, high));
  std::string list;
  for (int i = 0; i < count; ++i) {
    const bool isGray = colors == Colors::gray && i < 3;
    list += "," + (isGray ? gray : std::to_string(numbers.in(0, high)));
  }
  return "[" + list.substr(1) + "]";
}
std::string number(Numbers& numbers, double low = 0, double high = 1) {
  return std::to_string(numbers.in(low, high));
}

// The members of an object in JSON, most of which are there.
class Members {
 public:
  explicit Members(Numbers& numbers) : numbers_(numbers) {}
  Members& maybe(const char* name, const std::string& value) {
    return numbers_.in(0, 1) < 0.7 ? add(name, value) : *this;
  }
  Members& add(const char* name, const std::string& value) {
    text_ += (text_.empty() ? "{\"" : ",\"") + std::string(name) + "\":" + value;
    return *this;
  }
  std::string text() const { return text_.empty() ? "{}" : text_ + "}"; }

 private:
  Numbers& numbers_;
  std::string text_;
};

std::string sceneMaterial(Numbers& numbers, Colors colors) {
  Members m(numbers);
  for (const char* name :
       {"diffuse", "specular", "mirror", "mirrorGrazing", "transmission", "absorption"}) {
    m.maybe(name, listOf(numbers, 3, colors));
  }
  for (const char* name :
       {"thin", "frosted", "diffuseReflection", "glossyReflection", "castsShadow"}) {
    m.maybe(name, numbers.in(0, 1) < 0.5 ? "true" : "false");
  }

  m.maybe("priority", std::to_string(static_cast<int>(numbers.in(0, 9))));
  return m.maybe("roughness", number(numbers))
      .maybe("coverage", number(numbers))
      .maybe("ior", number(numbers, 1, 2.5))
      .text();
}

std::string gltfMaterial(Numbers& numbers, Colors colors) {
  const auto object = [&] { return Members(numbers); };
  const std::string pbr = object()
                              .maybe("baseColorFactor", listOf(numbers, 4, colors))
                              .maybe("metallicFactor", number(numbers))
                              .maybe("roughnessFactor", number(numbers))
                              .text();

  const std::string specular = object()
                                   .maybe("specularFactor", number(numbers))
                                   .maybe("specularColorFactor", listOf(numbers, 3, colors, 9))
                                   .text();

  const std::string volume = object()
                                 .add("thicknessFactor", "1")
                                 .maybe("attenuationDistance", number(numbers, 0.1, 9))
                                 .maybe("attenuationColor", listOf(numbers, 3, colors))
                                 .text();

  const std::string coat = object()
                               .maybe("clearcoatFactor", number(numbers))
                               .maybe("clearcoatRoughnessFactor", number(numbers, 0, 0.2))
                               .text();

  const std::string transmission = object().maybe("transmissionFactor", number(numbers)).text();

  const std::string extensions =
      object()
          .maybe("KHR_materials_ior", "{\"ior\":" + number(numbers, 1, 2.5) + "}")
          .maybe("KHR_materials_specular", specular)
          .maybe("KHR_materials_transmission", transmission)
          .maybe("KHR_materials_volume", volume)
          .maybe("KHR_materials_clearcoat", coat)
          .text();

  return object()
      .add("pbrMetallicRoughness", pbr)
      .add("extensions", extensions)
      .maybe("doubleSided", "true")
      .add("alphaMode", numbers.in(0, 1) < 0.4 ? "\"BLEND\"" : "\"OPAQUE\"")
      .text();
}

// White throughout, with any lobe and any coat.
std::string whiteSceneMaterial(Numbers& numbers, Colors colors) {
  return Members(numbers)
      .add("diffuse", "1")
      .maybe("specular", listOf(numbers, 3, colors))
      .maybe("roughness", number(numbers))
      .maybe("mirror", listOf(numbers, 3, colors))
      .maybe("mirrorGrazing", numbers.in(0, 1) < 0.5 ? "1" : listOf(numbers, 3, colors))
      .maybe("glossyReflection", "true")
      .text();
}
std::string whiteGltfMaterial(Numbers& numbers, Colors /*all are gray*/) {
  const std::string coat = "{\"clearcoatFactor\":" + number(numbers) + "}";
  const std::string extensions =
      Members(numbers)
          .maybe("KHR_materials_ior", "{\"ior\":" + number(numbers, 1, 2.5) + "}")
          .maybe("KHR_materials_clearcoat", coat)
          .text();

  const std::string roughness = numbers.in(0, 1) < 0.2 ? "0" : number(numbers);
  return "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":" + roughness +
         "},\"extensions\":" + extensions + "}";
}

using WriteMaterial = std::string (*)(Numbers&, Colors);

class WrittenMaterials : public SceneFileTest {
 protected:
  // A ball of each of 500 materials, as whit reads them from a file.
  Scene ballsOfScene(WriteMaterial write, Colors colors) {
    Numbers numbers(500);
    Members materials(numbers);
    for (int i = 0; i < kBalls; ++i) {
      materials.add(("m" + std::to_string(i)).c_str(), write(numbers, colors));
    }
    return balls(loadMembers("\"materials\":" + materials.text()).materials);
  }
  Scene ballsOfGltf(WriteMaterial write, Colors colors) {
    Numbers numbers(500);
    std::string materials;
    for (int i = 0; i < kBalls; ++i) materials += (i == 0 ? "" : ",") + write(numbers, colors);

    const std::string file =
        save("m.gltf", "{\"asset\":{\"version\":\"2.0\"},\"materials\":[" + materials + "]}");

    const PathRules rules(root_, false);
    MemoryBudget budget(1u << 30);
    const Instant instant;

    std::vector<Material> read = openModel({file, rules, budget, warnings_, instant})->materials();
    read.resize(kBalls);  // without the one of what has none
    return balls(read);
  }
};

// The two cases in which no path is brighter than the room.
struct Furnace {
  Colors colors;
  Diffuse diffuse;
};
constexpr Furnace kFurnaces[] = {{Colors::any, Diffuse::byAmbientLight},
                                 {Colors::gray, Diffuse::byRays}};

TEST_F(WrittenMaterials, NoneOf500IsBrighterThanTheRoom) {
  for (const auto& [colors, diffuse] : kFurnaces) {
    const Scene scenes[] = {ballsOfScene(sceneMaterial, colors), ballsOfGltf(gltfMaterial, colors)};
    for (const Scene& scene : scenes) {
      for (const bool packets : {false, true}) {
        const auto [least, largest] = rangeOf(scene, furnace(diffuse), packets);
        EXPECT_LE(largest, 1 + kRoundingsOfAPath) << packets << (&scene == scenes);
        EXPECT_LT(least, 0.5f) << "the balls are seen";
      }
    }
  }
}

TEST_F(WrittenMaterials, WhatDoesNotAbsorbVanishes) {
  for (const auto& [colors, diffuse] : kFurnaces) {
    const Scene scenes[] = {ballsOfScene(whiteSceneMaterial, colors),
                            ballsOfGltf(whiteGltfMaterial, colors)};
    for (const Scene& scene : scenes) {
      for (const bool packets : {false, true}) {
        const auto [least, largest] = rangeOf(scene, furnace(diffuse), packets);
        EXPECT_LE(largest, 1 + kRoundingsOfAPath) << packets << (&scene == scenes);
        EXPECT_GE(least, 1 - kRoundingsOfAPath) << packets << (&scene == scenes);
      }
    }
  }
}

TEST_F(WrittenMaterials, WhatDoesNotAbsorbVanishesOnAverageWithAnyColors) {
  const Scene scene = ballsOfScene(whiteSceneMaterial, Colors::any);
  for (const bool packets : {false, true}) {
    const Image image = render(scene, furnace(), packets).image;
    SampleMean off;
    for (const Rgb& pixel : image.pixels) {
      off.add(double{pixel.x} + double{pixel.y} + double{pixel.z} - 3);
    }

    EXPECT_GT(off.error(), 0) << "some paths choose";
    // 4.5 standard errors: one comparison in 150,000 would fail by chance.
    EXPECT_NEAR(off.value(), 0, 4.5 * off.error() + double{kRoundingsOfAPath}) << packets;
  }
}

// A lobe that no ray samples reflects the blurred sky, and takes that from the diffuse color,
// whether there is a sky or not.
TEST(WhiteFurnace, LobesThatAreNotSampledTakeWhatTheyReflect) {
  Material plastic = diffuseMaterial(0.9f);
  plastic.specular = Rgb(0.3f);
  RenderOptions o = furnace();
  o.glossy = o.indirect = 0;

  for (const bool packets : {false, true}) {
    const auto [least, largest] = rangeOf(balls({plastic}), o, packets);
    EXPECT_LE(largest, 1 + kRoundingsOfAPath) << packets;
    EXPECT_GE(least, 0.9 - kRoundingsOfAPath) << packets;

    o.disable = EffectSet().with(Effect::blurredSky);
    EXPECT_LT(rangeOf(balls({plastic}), o, packets).first, 0.9 * 0.75) << packets;
    o.disable = {};
  }
}

// The mean of what the samples leave is 1 less the lobe's albedo.
TEST(WhiteFurnace, DiffuseColorsGetWhatTheLobesAlbedoLeaves) {
  SceneBuilder builder;
  Material plastic = diffuseMaterial(1);
  plastic.specular = Rgb(0.04f);
  builder.add(floorAt(0, 1, builder.add(plastic)));
  const Scene scene = builder.build();
  const EffectSet effects = EffectSet().with(Effect::glossy).with(Effect::glossyReflection);

  for (const double roughness : {0.3, 0.6, 1.0}) {
    for (const double nv : {0.15, 0.5, 0.95}) {
      reference::Surfel s = reference::levelSurfel(
          roughness * roughness, double{plastic.specular.x}, reference::directionAt(nv, 0));
      s.diffuse = RgbD(1.0);
      reference::findLayers(scene, effects, {}, {}, {1, {4096, 0, 0}}, s);

      // 2e-3: what 4096 points of a lattice and the midpoint rule leave.
      EXPECT_NEAR(s.diffuse.x, 1 - albedoByFacets(0.04, 1, roughness, nv), 2e-3)
          << roughness << ' ' << nv;
    }
  }
}

}  // namespace
}  // namespace whit::test
