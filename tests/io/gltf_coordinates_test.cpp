// Maps of one material with different texture coordinates: two sets of the mesh, or one set that
// each map transforms differently.
#include "decoded_texel.h"
#include "gltf_pictures.h"

namespace whit {
namespace {

constexpr char kSecondSet[] = ",\"texCoord\":1";
constexpr char kApart[] =
    "texture looked up with the coordinates of its material's first in place of its own";

std::string transformed(const std::string& transform) {
  return ",\"extensions\":{\"KHR_texture_transform\":{" + transform + "}}";
}

// Shows two columns: texture 0 is red beside green, texture 1 is blue beside black. The second set
// of coordinates mirrors the first.
class GltfCoordinates : public GltfMaterials {
 protected:
  void SetUp() override {
    GltfMaterials::SetUp();
    save("color.tga", tga(2, 1, {{255, 0, 0}, {0, 255, 0}}));
    save("light.tga", tga(2, 1, {{0, 0, 255}, {0, 0, 0}}));
    useImages({"color.tga", "light.tga"});
    secondUvs_ = {1, 1, 0, 1, 0, 0, 1, 0};
  }

  // The parameters are the members that the textures of base color and emission have beside their
  // indices.
  static std::string material(const std::string& base, const std::string& emissive) {
    return matte("\"baseColorTexture\":{\"index\":0" + base + "}",
                 "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":1" + emissive + "}");
  }

  // Expects base color times the light of the lamp, plus the emission, in both columns.
  void expectColumns(const std::string& material, const Rgb& leftBase, const Rgb& leftLight,
                     const Rgb& rightBase, const Rgb& rightLight) {
    const auto p = picture({{0, material, 1}}, 2);
    const auto at = static_cast<float>(lit(0.5, 0.5));

    for (const std::size_t row : {0, 2}) {
      expectColor(p[row], leftBase * at + leftLight);
      expectColor(p[row + 1], rightBase * at + rightLight);
    }
  }

  const Rgb red_{1, 0, 0}, green_{0, 1, 0}, blue_{0, 0, 1}, black_{0, 0, 0};
};

TEST_F(GltfCoordinates, OfTwoSets) {
  expectColumns(material("", ""), red_, blue_, green_, black_);
  expectColumns(material("", kSecondSet), red_, black_, green_, blue_);
  expectColumns(material(kSecondSet, ""), green_, blue_, red_, black_);
  expectColumns(material(kSecondSet, kSecondSet), green_, black_, red_, blue_);
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfCoordinates, ATransformNamesItsSet) {
  expectColumns(material("", transformed("\"texCoord\":1")), red_, black_, green_, blue_);
  expectColumns(material("", kSecondSet + transformed("\"texCoord\":0")), red_, blue_, green_,
                black_);
}

TEST_F(GltfCoordinates, OfOneSetTransformedForOneMap) {
  expectColumns(material("", transformed("\"offset\":[0.5,0]")), red_, black_, green_, blue_);
  expectColumns(material(transformed("\"offset\":[0.5,0]"), ""), green_, blue_, red_, black_);
  EXPECT_EQ(kinds(), "");
}

// The second set is a quarter turn of the first: u runs upwards and v to the left. The map tilts
// the normal to (0.6, 0, 0.8), in steps of 1/127.5. Light comes from (0, 3, 3), whose squared
// distance is twice 9.
TEST_F(GltfCoordinates, TheNormalMapLeansAlongItsOwn) {
  save("lean.tga", tga(1, 1, {{204, 128, 230}}));
  save("white.tga", tga(1, 1, {{255, 255, 255}}));
  useImages({"white.tga", "lean.tga"});
  secondUvs_ = {0, 0, 0, 1, 1, 1, 1, 0};
  light_ = "0,3,3";

  const auto lean = [&](const std::string& set) {
    return pixel(
        matte("\"baseColorTexture\":{\"index\":0}", "\"normalTexture\":{\"index\":1" + set + "}"));
  };

  const double x = 204 / 127.5 - 1, y = 128 / 127.5 - 1, z = 230 / 127.5 - 1;
  const double scale = 0.5 * std::sqrt(0.5) / std::sqrt(x * x + y * y + z * z);
  expectColor(lean(""), Rgb(static_cast<float>((y + z) * scale)));
  expectColor(lean(kSecondSet), Rgb(static_cast<float>((x + z) * scale)));
}

TEST_F(GltfCoordinates, ASetThatIsNotThereIsZero) {
  secondUvs_.clear();

  // All points look up (0, 0), which lies between the first column and the last, since the texture
  // repeats.
  const Rgb half = blue_ * 0.5f;
  expectColumns(material("", kSecondSet), red_, half, green_, half);
}

TEST_F(GltfCoordinates, OneSetOfASecondMaterialTakesNoMemory) {
  const Scene plain = Scene::finalize(
      loadText(sceneText({{0, material("", ""), 1}, {1, material(kSecondSet, kSecondSet), 1}})),
      warnings_);
  EXPECT_TRUE(plain.secondUvs.empty());

  const std::string dark =
      matte("\"baseColorTexture\":{\"index\":0}",
            "\"emissiveTexture\":{\"index\":1,\"texCoord\":1},\"emissiveFactor\":[0,0,0]");
  EXPECT_TRUE(Scene::finalize(loadText(sceneText({{0, dark, 1}})), warnings_).secondUvs.empty());

  const Scene both = Scene::finalize(
      loadText(sceneText({{0, material("", ""), 1}, {1, material("", kSecondSet), 1}})), warnings_);
  EXPECT_EQ(both.secondUvs.size(), both.triangles.size());
}

char letterOf(const Rgb& color) {
  if (color == Rgb(1.0f)) return 'w';
  if (color.x == 1) return 'r';
  return color.y == 1 ? 'g' : 'b';
}

// A map whose coordinates are of a third kind is resampled for the first, row by row and texel by
// texel, where it repeats a whole number of times.
TEST_F(GltfCoordinates, AThirdKindIsResampled) {
  save("four.tga", tga(2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}));
  save("row.tga", tga(4, 1, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}));
  useImages({"color.tga", "light.tga", "four.tga", "row.tga"});
  const auto emissionOf = [&](const std::string& base, const std::string& emissive,
                              const std::string& image = "2") {
    const SceneDescription d = loadText(
        sceneText({{0,
                    matte("\"baseColorTexture\":{\"index\":0" + base + "}",
                          "\"normalTexture\":{\"index\":1,\"texCoord\":1},\"emissiveFactor\":"
                          "[1,1,1],\"emissiveTexture\":{\"index\":" +
                              image + emissive + "}"),
                    1}}));
    const Texture& made = d.textures[static_cast<std::size_t>(d.materials[0].emissionMap)];
    std::string colors = std::to_string(made.width) + ": ";
    for (const std::uint32_t texel : made.texels) {
      colors += letterOf(decodeColorTexel(texel));
    }
    return colors;
  };

  EXPECT_EQ(emissionOf("", transformed("\"scale\":[2,1]")), "4: rgrgbwbw");
  EXPECT_EQ(emissionOf("", transformed("\"scale\":[1,2]")), "2: rgbwrgbw");
  EXPECT_EQ(emissionOf("", transformed("\"offset\":[0.5,0]")), "2: grwb");
  EXPECT_EQ(emissionOf("", transformed("\"scale\":[-1,1]")), "2: grwb");
  EXPECT_EQ(emissionOf(transformed("\"scale\":[0.5,0.5],\"offset\":[0.25,0]"),
                       transformed("\"scale\":[1,0.5]")),
            "4: grgrwbwb")
      << "half a repeat of the base color begins at a quarter, which is half a repeat of this";
  EXPECT_EQ(emissionOf(transformed("\"offset\":[0.25,0]"), transformed("\"scale\":[1,1]"), "3"),
            "4: wrgb");
  EXPECT_EQ(kinds(), "");

  emissionOf("", transformed("\"scale\":[1.5,1]"));
  emissionOf("", transformed("\"rotation\":1"));
  EXPECT_EQ(warned(kApart), 2u);
}

// Without a normal map, which takes the second kind of coordinates, the emission is looked up with
// its own. The offset of 0.1 is a fifth of a column.
TEST_F(GltfCoordinates, AThirdKindBetweenTexelsShowsWhatTheSecondDoes) {
  save("warm.tga", tga(2, 1, {{200, 30, 0}, {20, 100, 255}}));
  candela_ = 0;
  const std::string normal = ",\"normalTexture\":{\"index\":1,\"texCoord\":1}";

  for (const std::string sampler : {"\"magFilter\":9729", "\"magFilter\":9728"}) {
    useImages({"color.tga", "light.tga", "warm.tga"}, sampler);
    const auto emitted = [&](const std::string& rest) {
      const std::string own = "{\"index\":2" + transformed("\"offset\":[0.1,0]") + "}";
      const std::string all = "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":" + own + rest;
      return picture({{0, matte("\"baseColorTexture\":{\"index\":0}", all), 1}}, 32);
    };

    const auto resampled = emitted(normal), own = emitted("");

    for (std::size_t i = 0; i < own.size(); ++i) {
      SCOPED_TRACE(sampler + std::to_string(i));
      expectColor(resampled[i], own[i]);
    }
  }
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfCoordinates, AThirdKindBetweenTexelsOfALargeImageIsCounted) {
  save("wide.tga", tga(255, 1, std::vector<std::vector<int>>(255, {255, 0, 0})));
  useImages({"color.tga", "wide.tga"});

  loadText(
      sceneText({{0,
                  matte("\"baseColorTexture\":{\"index\":0}",
                        "\"normalTexture\":{\"index\":1,\"texCoord\":1},\"emissiveFactor\":[1,1,1],"
                        "\"emissiveTexture\":{\"index\":1" +
                            transformed("\"scale\":[4,1],\"offset\":[0.1,0]") + "}"),
                  1}}));

  EXPECT_EQ(warned("texture blurred: a third transform shifts it by a fraction of a texel"), 1u);
}

// Metal, in the blue channel, takes the diffuse color.
TEST_F(GltfCoordinates, MetalnessOfAnotherTransformIsResampled) {
  const SceneDescription d =
      loadText(sceneText({{0,
                           "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
                           "\"metallicRoughnessTexture\":{\"index\":1" +
                               transformed("\"scale\":[2,1]") + "}}}",
                           1}}));
  const Texture& made = d.textures[static_cast<std::size_t>(d.materials[0].diffuseMap)];
  ASSERT_EQ(made.width, 4);
  // Centers of columns lie a quarter of a texel of the base color beside those of its two texels.
  const Rgb expected[] = {black_, {0.75f, 0.25f, 0}, black_, {0.25f, 0.75f, 0}};
  for (std::size_t i = 0; i < 4; ++i) expectColor(decodeColorTexel(made.texels[i]), expected[i]);
  EXPECT_EQ(warned(kApart), 0u);
}

TEST_F(GltfCoordinates, AThirdKindAndThoseOfMetalnessAreCounted) {
  loadText(sceneText({{0,
                       matte("\"baseColorTexture\":{\"index\":0}",
                             "\"normalTexture\":{\"index\":1,\"texCoord\":1},\"emissiveFactor\":"
                             "[1,1,1],\"emissiveTexture\":{\"index\":1" +
                                 transformed("\"scale\":[0.5,2]") + "}"),
                       1}}));
  EXPECT_EQ(warned(kApart), 1u);

  loadText(sceneText({{0,
                       "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
                       "\"metallicRoughnessTexture\":{\"index\":1,\"texCoord\":1}}}",
                       1}}));
  EXPECT_EQ(warned(kApart), 2u);
}

}  // namespace
}  // namespace whit
