// A white furnace: bodies in uniform light of radiance 1, of materials of all kinds. Each surface
// sends out at most what it gets, so nothing looks brighter than 1, and nothing darker where
// nothing absorbs.
#include <gtest/gtest.h>

#include "io/files.h"
#include "io/memory_budget.h"
#include "io/model.h"
#include "io/scene_files.h"
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
  for (const auto i : indices(materials)) {
    const auto number = static_cast<int>(i);
    const Vec3d center{number % kBallsAcross - (kBallsAcross - 1) / 2.0,
                       number / kBallsAcross - (kBallsDown - 1) / 2.0, -8.0 * number};
    const Affine map = Affine::translation(center) * Affine::scaling(Vec3d(0.49));
    builder.add(exactSphere(0, map), materials[i]);
  }

  builder.lookFrom({0, 0, 50}).orthographicHeight = kBallsDown;
  return builder.build();
}

// Whether the diffuse color is lit by rays, or by the ambient light, which is of radiance 1 as
// well.
enum class Diffuse { byAmbientLight, byRays };

RenderOptions furnace(Diffuse diffuse = Diffuse::byRays) {
  RenderOptions o = smallOptions({kBallsAcross * kPixelsASide, kBallsDown * kPixelsASide});
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

// The members of an object in JSON, most of which are there.
class Members {
 public:
  Members(Numbers& numbers, Colors colors) : numbers_(numbers), colors_(colors) {}

  Members& add(const std::string& name, const std::string& value) {
    addItem(text_, "\"" + name + "\":" + value);
    return *this;
  }
  Members& maybe(const char* name, const std::string& value) {
    return numbers_.in(0, 1) < 0.7 ? add(name, value) : *this;
  }
  Members& number(const char* name, double low = 0, double high = 1) {
    return maybe(name, std::to_string(numbers_.in(low, high)));
  }
  // Adds a color of random numbers in [0, high), and with a count of 4 an alpha.
  Members& color(const char* name, int count = 3, double high = 1) {
    const std::string gray = std::to_string(numbers_.in(0, high));
    std::string list;
    for (int i = 0; i < count; ++i) {
      const bool isGray = colors_ == Colors::gray && i < 3;
      addItem(list, isGray ? gray : std::to_string(numbers_.in(0, high)));
    }
    return maybe(name, "[" + list + "]");
  }
  std::string text() const { return "{" + text_ + "}"; }

 private:
  Numbers& numbers_;
  const Colors colors_;
  std::string text_;
};

std::string sceneMaterial(Numbers& numbers, Colors colors) {
  Members m(numbers, colors);
  for (const char* name :
       {"diffuse", "specular", "mirror", "mirrorGrazing", "transmission", "absorption"}) {
    m.color(name);
  }
  for (const char* name :
       {"thin", "frosted", "diffuseReflection", "glossyReflection", "castsShadow"}) {
    m.maybe(name, numbers.in(0, 1) < 0.5 ? "true" : "false");
  }

  m.maybe("priority", std::to_string(static_cast<int>(numbers.in(0, 9))));
  return m.number("roughness").number("coverage").number("ior", 1, 2.5).text();
}

std::string gltfMaterial(Numbers& numbers, Colors colors) {
  const auto object = [&] { return Members(numbers, colors); };
  const std::string extensions =
      object()
          .maybe("KHR_materials_ior", object().number("ior", 1, 2.5).text())
          .maybe("KHR_materials_specular",
                 object().number("specularFactor").color("specularColorFactor", 3, 9).text())
          .maybe("KHR_materials_transmission", object().number("transmissionFactor").text())
          .maybe("KHR_materials_volume", object()
                                             .add("thicknessFactor", "1")
                                             .number("attenuationDistance", 0.1, 9)
                                             .color("attenuationColor")
                                             .text())
          .maybe(
              "KHR_materials_clearcoat",
              object().number("clearcoatFactor").number("clearcoatRoughnessFactor", 0, 0.2).text())
          .text();

  return object()
      .add("pbrMetallicRoughness", object()
                                       .color("baseColorFactor", 4)
                                       .number("metallicFactor")
                                       .number("roughnessFactor")
                                       .text())
      .add("extensions", extensions)
      .maybe("doubleSided", "true")
      .add("alphaMode", numbers.in(0, 1) < 0.4 ? "\"BLEND\"" : "\"OPAQUE\"")
      .text();
}

// White throughout, with any lobe and any coat.
std::string whiteSceneMaterial(Numbers& numbers, Colors colors) {
  Members m(numbers, colors);
  m.add("diffuse", "1").color("specular").number("roughness").color("mirror");
  if (numbers.in(0, 1) < 0.5) {
    m.add("mirrorGrazing", "1");
  } else {
    m.color("mirrorGrazing");
  }
  return m.maybe("glossyReflection", "true").text();
}
std::string whiteGltfMaterial(Numbers& numbers, Colors colors) {
  const auto object = [&] { return Members(numbers, colors); };
  const std::string extensions =
      object()
          .maybe("KHR_materials_ior", object().number("ior", 1, 2.5).text())
          .maybe("KHR_materials_clearcoat", object().number("clearcoatFactor").text())
          .text();
  const double roughness = std::max(0.0, numbers.in(-0.25, 1));
  return object()
      .add("pbrMetallicRoughness",
           "{\"metallicFactor\":0,\"roughnessFactor\":" + std::to_string(roughness) + "}")
      .add("extensions", extensions)
      .text();
}

using WriteMaterial = std::string (*)(Numbers&, Colors);

class WrittenMaterials : public SceneFileTest {
 protected:
  // A ball of each of 500 materials, as whit reads them from a file.
  Scene ballsOfScene(WriteMaterial write, Colors colors) {
    Numbers numbers(500);
    Members materials(numbers, colors);
    for (int i = 0; i < kBalls; ++i) {
      materials.add("m" + std::to_string(i), write(numbers, colors));
    }
    return balls(loadMembers("\"materials\":" + materials.text()).materials);
  }
  Scene ballsOfGltf(WriteMaterial write, Colors colors) {
    Numbers numbers(500);
    std::string materials;
    for (int i = 0; i < kBalls; ++i) addItem(materials, write(numbers, colors));

    const std::string file =
        save("m.gltf", "{\"asset\":{\"version\":\"2.0\"},\"materials\":[" + materials + "]}");

    const PathRules rules(root_, false);
    MemoryBudget budget(1u << 30);
    const Instant instant;

    std::vector<Material> read = openModel({file, rules, budget, warnings_, instant})->materials();
    read.resize(kBalls);  // without the one of what has none
    return balls(read);
  }

  // Expects that nothing is brighter than the room, in the two cases in which no path is, and calls
  // check(least channel) for each picture.
  template <typename Check>
  void expectNoneIsBrighter(WriteMaterial writeScene, WriteMaterial writeGltf, const Check& check) {
    for (const Diffuse diffuse : {Diffuse::byAmbientLight, Diffuse::byRays}) {
      const Colors colors = diffuse == Diffuse::byRays ? Colors::gray : Colors::any;
      for (const bool gltf : {false, true}) {
        const Scene scene =
            gltf ? ballsOfGltf(writeGltf, colors) : ballsOfScene(writeScene, colors);
        for (const bool packets : {false, true}) {
          SCOPED_TRACE(gltf ? "materials of glTF" : "materials of scene files");
          SCOPED_TRACE(packets ? "packets" : "reference");
          const auto [least, largest] = rangeOf(scene, furnace(diffuse), packets);
          EXPECT_LE(largest, 1 + kRoundingsOfAPath);
          check(least);
        }
      }
    }
  }
};

TEST_F(WrittenMaterials, NoneOf500IsBrighterThanTheRoom) {
  expectNoneIsBrighter(sceneMaterial, gltfMaterial,
                       [](float least) { EXPECT_LT(least, 0.5f) << "the balls are seen"; });
}

TEST_F(WrittenMaterials, WhatDoesNotAbsorbVanishes) {
  expectNoneIsBrighter(whiteSceneMaterial, whiteGltfMaterial,
                       [](float least) { EXPECT_GE(least, 1 - kRoundingsOfAPath); });
}

TEST_F(WrittenMaterials, WhatDoesNotAbsorbVanishesOnAverageWithAnyColors) {
  const Scene scene = ballsOfScene(whiteSceneMaterial, Colors::any);
  for (const bool packets : {false, true}) {
    const Image image = render(scene, furnace(), packets).image;
    SampleMean off;
    for (const Rgb& pixel : image.pixels) off.add(double{pixel.x} + pixel.y + pixel.z - 3);

    EXPECT_GT(off.error(), 0) << "some paths choose";
    // 4.5 standard errors: one comparison in 150,000 would fail by chance.
    EXPECT_NEAR(off.value(), 0, 4.5 * off.error() + kRoundingsOfAPath) << packets;
  }
}

// A lobe that no ray samples reflects the blurred sky, and takes that from the diffuse color,
// whether there is a sky or not.
TEST(WhiteFurnace, LobesThatAreNotSampledTakeWhatTheyReflect) {
  Material plastic = diffuseMaterial(0.9f);
  plastic.specular = Rgb(0.3f);
  const Scene scene = balls({plastic});
  for (const bool packets : {false, true}) {
    RenderOptions o = furnace();
    o.glossy = o.indirect = 0;
    const auto [least, largest] = rangeOf(scene, o, packets);
    EXPECT_LE(largest, 1 + kRoundingsOfAPath) << packets;
    EXPECT_GE(least, 0.9 - kRoundingsOfAPath) << packets;

    o.disable = {Effect::blurredSky};
    EXPECT_LT(rangeOf(scene, o, packets).first, 0.9 * 0.75) << packets;
  }
}

}  // namespace
}  // namespace whit::test
