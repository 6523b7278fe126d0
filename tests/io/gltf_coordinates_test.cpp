// Maps of one material with different texture coordinates: two sets of the mesh, or one set that
// each map transforms differently.
#include "gltf_pictures.h"

namespace whit {
namespace {

constexpr char kSecondSet[] = ",'texCoord':1";
constexpr char kApart[] =
    "texture looked up with the coordinates of its material's first in place of its own";

// A normal map that takes the second kind of coordinates.
constexpr char kNormal[] = ",'normalTexture':{'index':1,'texCoord':1}";

std::string transformed(const std::string& transform) {
  return ",'extensions':{'KHR_texture_transform':{" + transform + "}}";
}

// Shows two columns: texture 0 is red beside green, texture 1 is blue beside black. The second set
// of coordinates mirrors the first.
class GltfCoordinates : public GltfMaterials {
 protected:
  GltfCoordinates() {
    useRows({kColors, kLights});
    secondUvs_ = {1, 1, 0, 1, 0, 0, 1, 0};
  }

  // `base` and `emissive` are the members that the textures of base color and emission have beside
  // their indices.
  static std::string material(const std::string& base, const std::string& emissive,
                              const std::string& image = "1", const std::string& rest = "") {
    return matte(
        "'baseColorTexture':{'index':0" + base + "}",
        "'emissiveFactor':[1,1,1],'emissiveTexture':{'index':" + image + emissive + "}" + rest);
  }

  // Expects base color times the light of the lamp, plus the emission, in both columns.
  void expectColumns(const std::string& base, const std::string& emissive, const Rgb& leftBase,
                     const Rgb& leftLight, const Rgb& rightBase, const Rgb& rightLight) {
    SCOPED_TRACE(base + " " + emissive);
    const float at = lit(0.5, 0.5);
    const Rgb left = leftBase * at + leftLight, right = rightBase * at + rightLight;
    expectColors(picture(material(base, emissive), 2), {left, right, left, right});
  }

  const Texels kColors{"ff0000", "00ff00"}, kLights{"0000ff", "000000"};
  const Rgb red_{1, 0, 0}, green_{0, 1, 0}, blue_{0, 0, 1}, black_{0, 0, 0};
};

TEST_F(GltfCoordinates, OfTwoSets) {
  expectColumns("", "", red_, blue_, green_, black_);
  expectColumns("", kSecondSet, red_, black_, green_, blue_);
  expectColumns(kSecondSet, "", green_, blue_, red_, black_);
  expectColumns(kSecondSet, kSecondSet, green_, black_, red_, blue_);

  // A transform names its set.
  expectColumns("", transformed("'texCoord':1"), red_, black_, green_, blue_);
  expectColumns("", kSecondSet + transformed("'texCoord':0"), red_, blue_, green_, black_);

  // One set is transformed for one map.
  expectColumns("", transformed("'offset':[0.5,0]"), red_, black_, green_, blue_);
  expectColumns(transformed("'offset':[0.5,0]"), "", green_, blue_, red_, black_);
  expectNoWarnings();

  // A set that is not there is zero. All points look up (0, 0), which lies between the first column
  // and the last, since the texture repeats.
  secondUvs_.clear();
  expectColumns("", kSecondSet, red_, blue_ * 0.5f, green_, blue_ * 0.5f);
}

// The second set is a quarter turn of the first: u runs upwards and v to the left. The map tilts
// the normal to (0.6, 0, 0.8), in steps of 1/127.5. Light comes from (0, 3, 3), whose squared
// distance is twice 9.
TEST_F(GltfCoordinates, TheNormalMapLeansAlongItsOwn) {
  useRows({{"ffffff"}, {"cc80e6"}});
  secondUvs_ = {0, 0, 0, 1, 1, 1, 1, 0};
  light_ = "0,3,3";

  const double x = 204 / 127.5 - 1, y = 128 / 127.5 - 1, z = 230 / 127.5 - 1;
  const double scale = 0.5 * std::sqrt(0.5) / std::sqrt(x * x + y * y + z * z);
  const std::string color = "'baseColorTexture':{'index':0}";
  expectShown({{matte(color, "'normalTexture':{'index':1}"), gray((y + z) * scale)},
               {matte(color, "'normalTexture':{'index':1,'texCoord':1}"), gray((x + z) * scale)}});
}

TEST_F(GltfCoordinates, OneSetOfASecondMaterialTakesNoMemory) {
  const Square first{material("", "")};
  EXPECT_TRUE(bake(loadSquares({first, {material(kSecondSet, kSecondSet), 1}})).secondUvs.empty());
  EXPECT_TRUE(bake(loadMaterial(matte(
                       "'baseColorTexture':{'index':0}",
                       "'emissiveTexture':{'index':1,'texCoord':1},'emissiveFactor':[0,0,0]")))
                  .secondUvs.empty());

  const Scene both = bake(loadSquares({first, {material("", kSecondSet), 1}}));
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
  const Texels all{"ff0000", "00ff00", "0000ff", "ffffff"};
  saveImage("four.tga", all, 2);
  saveImage("row.tga", all);
  useImages({"0.tga", "1.tga", "four.tga", "row.tga"});
  const auto emissionOf = [&](const std::string& base, const std::string& emissive,
                              const std::string& image = "2") {
    const SceneDescription d =
        loadMaterial(material(transformed(base), transformed(emissive), image, kNormal));
    std::string colors = joined(textureOf(d, d.materials[0].emissionMap).width, ": ");
    for (const Rgb& color : colorsOf(d, d.materials[0].emissionMap)) colors += letterOf(color);
    return colors;
  };

  EXPECT_EQ(emissionOf("", "'scale':[2,1]"), "4: rgrgbwbw");
  EXPECT_EQ(emissionOf("", "'scale':[1,2]"), "2: rgbwrgbw");
  EXPECT_EQ(emissionOf("", "'offset':[0.5,0]"), "2: grwb");
  EXPECT_EQ(emissionOf("", "'scale':[-1,1]"), "2: grwb");
  EXPECT_EQ(emissionOf("'scale':[0.5,0.5],'offset':[0.25,0]", "'scale':[1,0.5]"), "4: grgrwbwb")
      << "half a repeat of the base color begins at a quarter, which is half a repeat of this";
  EXPECT_EQ(emissionOf("'offset':[0.25,0]", "'scale':[1,1]", "3"), "4: wrgb");
  expectNoWarnings();

  emissionOf("", "'scale':[1.5,1]");
  emissionOf("", "'rotation':1");
  expectWarned(kApart, 2);
}

// Without a normal map, which takes the second kind of coordinates, the emission is looked up with
// its own. The offset of 0.1 is a fifth of a column.
TEST_F(GltfCoordinates, AThirdKindBetweenTexelsShowsWhatTheSecondDoes) {
  candela_ = 0;
  for (const std::string sampler : {"'magFilter':9729", "'magFilter':9728"}) {
    SCOPED_TRACE(sampler);
    useRows({kColors, kLights, {"c81e00", "1464ff"}}, sampler);
    const auto emitted = [&](const std::string& rest) {
      return picture(material("", transformed("'offset':[0.1,0]"), "2", rest), 32);
    };
    expectColors(emitted(kNormal), emitted(""));
  }
  expectNoWarnings();

  // A large image is not resampled for it.
  useRows({kColors, Texels(255, "ff0000")});
  loadMaterial(material("", transformed("'scale':[4,1],'offset':[0.1,0]"), "1", kNormal));
  expectWarned("texture blurred: a third transform shifts it by a fraction of a texel");
}

// Metal, in the blue channel, takes the diffuse color.
TEST_F(GltfCoordinates, MetalnessOfAnotherTransformIsResampled) {
  const auto metal = [](const std::string& rest) {
    return "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0},"
           "'metallicRoughnessTexture':{'index':1" +
           rest + "}}}";
  };
  const SceneDescription d = loadMaterial(metal(transformed("'scale':[2,1]")));
  const std::int32_t map = d.materials[0].diffuseMap;
  ASSERT_EQ(textureOf(d, map).width, 4);
  // Centers of columns lie a quarter of a texel of the base color beside those of its two texels.
  expectColors(colorsOf(d, map), {black_, {0.75f, 0.25f, 0}, black_, {0.25f, 0.75f, 0}});

  expectWarnings(kApart, {{metal(transformed("'scale':[2,1]")), 0},
                          {material("", transformed("'scale':[0.5,2]"), "1", kNormal), 1},
                          {metal(kSecondSet), 1}});
}

}  // namespace
}  // namespace whit
