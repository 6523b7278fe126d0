// Scenes made in memory: the pictures of files that say the same, and the same errors.
#include <array>
#include <cmath>
#include <fstream>

#include "has_text.h"
#include "io/image/image_file.h"
#include "library_scenes.h"

namespace whit::api {
namespace {

constexpr std::array<float, 8> kUvs{0, 0, 2, 0, 2, 1, 0, 1};

MeshArrays sheet() { return {.positions = kBentCorners, .triangles = kHalves, .uvs = kUvs}; }

ImageArrays picture() { return {2, 2, 3, kDots}; }

// Has a mesh, a texture, a material, a camera and a light, and no instance yet.
SceneBuilder sheetBuilder() {
  SceneBuilder builder("sheets");
  builder.addMesh("sheet", sheet()).addTexture("dots", picture());

  Material red;
  red.diffuse = {0.75, 0.5, 0.25};
  red.diffuseMap = "dots";
  builder.addMaterial("red", red);
  builder.addCamera("front", kSheetCamera);
  builder.addLight(kSheetLight);
  return builder;
}

Image pictureBuiltBy(const SceneBuilder& builder) {
  return smallRenderer(builder.build()).render();
}

// Writes the same scene as a scene file, a model and an image.
std::string writeSheets(const TemporaryFolder& folder) {
  std::ofstream(folder / "sheet.obj")
      << "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0.5 1\nvt 0 0\nvt 2 0\nvt 2 1\nvt 0 1\ns off\n"
      << "f 1/1 3/3 2/2\nf 1/1 4/4 3/3\n";

  DisplayImage image;
  image.width = image.height = 2;
  for (std::size_t i = 0; i < kDots.size(); i += 3) {
    image.rgba.insert(image.rgba.end(), {kDots[i], kDots[i + 1], kDots[i + 2], 255});
  }
  writePng(folder / "dots.png", image, {});

  const std::string dotted =
      "'materials': {'*': {'diffuse': [0.75, 0.5, 0.25], 'diffuseMap': 'dots'}}";
  std::ofstream(folder / "sheets.json") << asJson(
      "{'whit': 1, 'cameras': {'front': {'eye': [0.5, 2, 4], 'at': [0, 0, 0]}},"
      "'lights': [{'position': [1, 4, 2], 'intensity': 30}],"
      "'sky': {'color': [0.1, 0.2, 0.3]}, 'ambient': {'fromSky': 0.5},"
      "'textures': {'dots': {'image': 'dots.png'}}, 'scene': ["
      "{'model': 'sheet.obj', " +
      dotted + "}, {'model': 'sheet.obj', " + dotted +
      ", 'transform': {'matrix': [0.5, 0, 0, 0, 0, 0.5, 0, 1, 0, 0, 0.5, 0]}}]}");
  return folder / "sheets.json";
}

TEST(SceneBuilder, MakesThePictureOfFiles) {
  const TemporaryFolder folder;
  SceneBuilder builder = sheetBuilder();
  EXPECT_EQ(builder.addInstance("sheet", "red"), "/scene/0");
  EXPECT_EQ(builder.addInstance("sheet", "red", placed({0, 1, 0}, {0.5, 0.5, 0.5})), "/scene/1");
  builder.set("/sky", R"({"color": [0.1, 0.2, 0.3]})").set("/ambient", R"({"fromSky": 0.5})");

  const Scene scene = builder.build();
  EXPECT_EQ(builder.addLight({}), "/lights/1");
  EXPECT_EQ(builder.addCamera("a/b", kSheetCamera), "/cameras/a~1b");
  EXPECT_EQ(builder.addMaterial("blue", {}), "/materials/blue");
  EXPECT_EQ(scene.name(), "sheets");
  EXPECT_EQ(scene.triangles(), 4u);
  EXPECT_EQ(scene.cameras(), std::vector<std::string>{"front"});

  const Image image = smallRenderer(scene).render();
  EXPECT_TRUE(samePictures(image, smallRenderer(writeSheets(folder))));
  EXPECT_GT(std::ranges::max(image.rgb()), 0.25f);
}

TEST(SceneBuilder, CamerasHaveAProjection) {
  SceneBuilder builder = sheetBuilder();
  builder.addInstance("sheet", "red");
  const Image plain = pictureBuiltBy(builder);

  Camera camera = kSheetCamera;
  camera.projection = "equisolid";
  camera.angle = 90;
  builder.addCamera("front", camera);

  Renderer renderer = smallRenderer(builder.build());
  EXPECT_TRUE(hasText(renderer.scene().camera(), "equisolid"));
  const Image round = renderer.render();
  EXPECT_FALSE(samePictures(round, plain));

  // A camera in JSON holds until an empty one takes it back.
  EXPECT_TRUE(
      samePictures(renderer.lookThrough(R"({"eye": [0.5, 2, 4], "at": [0, 0, 0]})"), plain));
  EXPECT_TRUE(samePictures(renderer.lookThrough(""), round));

  camera.aperture = 0.1;  // a panorama has no aperture
  camera.projection = "panorama";
  camera.angle = 180;
  builder.addCamera("front", camera);
  EXPECT_THROW(builder.build(), Error);
}

TEST(SceneBuilder, ArraysAreMapsOfEveryUse) {
  SceneBuilder plain = sheetBuilder();
  plain.addInstance("sheet", "red");
  plain.set("/ambient", R"({"color": 0.3})")
      .set("/textures/data", R"({"array": "dots", "as": "data"})")
      .set("/materials/red/specular", "0.5")
      .set("/materials/red/emission", "0.5");

  for (const std::string map : {"roughnessMap", "occlusionMap", "emissionMap"}) {
    SceneBuilder mapped = plain;
    mapped.set("/materials/red/" + map, map == "emissionMap" ? R"("dots")" : R"("data")");
    EXPECT_FALSE(samePictures(pictureBuiltBy(mapped), pictureBuiltBy(plain))) << map;
  }
}

TEST(SceneBuilder, VerticesComeInThreesWithoutTriangles) {
  constexpr std::array<float, 18> kSoup{-1, 0, -1, 1,  0,    1, 1, 0, -1,
                                        -1, 0, -1, -1, 0.5f, 1, 1, 0, 1};
  SceneBuilder builder = sheetBuilder();
  builder.addInstance("sheet");
  const Image expected = pictureBuiltBy(builder);
  EXPECT_TRUE(samePictures(pictureBuiltBy(builder.addMesh("sheet", {kSoup})), expected));
}

TEST(SceneBuilder, MemoryIsHeldUntilItIsReadForTheLastTime) {
  auto owned = std::make_shared<std::vector<float>>(kBentCorners.begin(), kBentCorners.end());
  const std::weak_ptr<std::vector<float>> watched = owned;
  {
    SceneBuilder builder = sheetBuilder();
    MeshArrays arrays = sheet();
    arrays.positions = *owned;
    arrays.keep = std::move(owned);
    builder.addMesh("sheet", arrays);
    arrays.keep.reset();
    builder.addInstance("sheet", "red");

    Renderer renderer = smallRenderer(builder.build());
    builder = SceneBuilder();
    EXPECT_FALSE(watched.expired());
    renderer.setMember("/scene/-", R"({"mesh": "sheet"})");  // reads the scene again
    renderer.render();
  }
  EXPECT_TRUE(watched.expired());
}

struct Wrong {
  const char* place;
  const char* expected;  // the beginning of the expected words
  std::function<void(SceneBuilder&)> make;
};

TEST(SceneBuilder, WhatIsWrongHasItsPlace) {
  const auto mesh = [](const char* expected, const std::function<void(MeshArrays&)>& spoil) {
    return Wrong{"/scene/0/mesh", expected, [spoil](SceneBuilder& builder) {
                   MeshArrays arrays = sheet();
                   spoil(arrays);
                   builder.addMesh("sheet", arrays).addInstance("sheet", "red");
                 }};
  };
  const auto member = [](const char* pointer, const char* value, const char* expected) {
    return Wrong{pointer, expected, [=](SceneBuilder& builder) { builder.set(pointer, value); }};
  };
  const auto texture = [](const ImageArrays& image, const char* expected) {
    return Wrong{"/textures/dots/array", expected,
                 [=](SceneBuilder& builder) { builder.addTexture("dots", image); }};
  };

  static constexpr std::array<float, 12> kNan{0, 0, 0, 1, NAN, 0, 0, 0, 1, 1, 0, 1};
  static constexpr std::array<float, 12> kBright{0, 0, 0, 1, 2, 0, 0, 0, 1, 1, 0, 1};
  static constexpr std::array<std::uint32_t, 6> kOutside{0, 1, 2, 0, 1, 4};

  const Wrong all[] = {
      mesh("vertices below 4", [](MeshArrays& m) { m.triangles = kOutside; }),
      mesh("three vertices a triangle", [](MeshArrays& m) { m.triangles = m.triangles.first(5); }),
      mesh("three numbers a position", [](MeshArrays& m) { m.positions = m.positions.first(11); }),
      mesh("finite numbers in positions", [](MeshArrays& m) { m.positions = kNan; }),
      mesh("finite numbers in normals", [](MeshArrays& m) { m.normals = kNan; }),
      mesh("numbers from 0", [](MeshArrays& m) { m.colors = kBright; }),
      mesh("uvs for 4 vertices", [](MeshArrays& m) { m.uvs = m.uvs.first(6); }),
      mesh("normals for 4 vertices", [](MeshArrays& m) { m.normals = m.positions.first(9); }),
      mesh("a multiple of 3 vertices", [](MeshArrays& m) { m.triangles = {}; }),
      {"/scene/0/mesh", "the name of a mesh (is \"sheet\" meant?)",
       [](SceneBuilder& b) { b.addInstance("sheat"); }},
      {"/scene/0/material", "the name of a material (is \"red\" meant?)",
       [](SceneBuilder& b) { b.addInstance("sheet", "rad"); }},
      {"/scene/0/transform", "a transform that can be undone",
       [](SceneBuilder& b) { b.addInstance("sheet", "red", Matrix{}); }},
      member("/lights/0/radius", "0", "a number from 1.1e-19"),
      member("/lights/0/intensity", "-1", ""),
      {"/cameras/front", "eye and at to differ",
       [](SceneBuilder& b) {
         b.addCamera("front", {{1, 1, 1}, {1, 1, 1}});
       }},
      member("/materials/red/roughness", "2", "a number from 0 to 1"),
      member("/textures/dots/array", "\"dot\"", "the name of an array (is \"dots\" meant?)"),
      texture({3, 2, 3, kDots}, "width * height * channels numbers"),
      texture({-1, 1, 3}, "1 to 65536 pixels"),
  };

  for (const Wrong& wrong : all) {
    SceneBuilder builder = sheetBuilder();
    const Error error = errorOf([&] {
      wrong.make(builder);
      builder.build();
    });

    EXPECT_EQ(error.status(), 3) << wrong.place;
    EXPECT_EQ(error.file(), "sheets") << error.what();
    EXPECT_EQ(error.place(), wrong.place) << error.what();
    EXPECT_TRUE(error.expected().starts_with(wrong.expected)) << error.what();
  }
}

TEST(SceneBuilder, WhatIsNotJsonIsAnError) {
  SceneBuilder builder;
  EXPECT_EQ(statusOf([&] { builder.set("/sky", "{"); }), 2);
  EXPECT_EQ(statusOf([&] { builder.set("", "{}"); }), 2);
  EXPECT_EQ(statusOf([&] { SceneBuilder("a", "[1]"); }), 3);

  const Error error = errorOf([&] { SceneBuilder("a", "{\n\"sky\": }"); });
  EXPECT_EQ(error.file(), "a");
  EXPECT_TRUE(error.place().starts_with("2:")) << error.place();
  builder.set("/whit", "2");
  EXPECT_EQ(errorOf([&] { builder.build(); }).place(), "/whit");
}

TEST(SceneBuilder, MemoryHasALimit) {
  SceneBuilder builder = sheetBuilder();
  builder.addInstance("sheet");
  EXPECT_EQ(statusOf([&] { builder.build({.maxMemoryGb = 1e-8}); }), 5);

  // The number of vertices has one as well, and is looked at before the vertices.
  const float one = 0;
  builder.addMesh("sheet", {{&one, std::size_t{3} * 0xffffffffu}});
  EXPECT_EQ(statusOf([&] { builder.build({.maxMemoryGb = 1e6}); }), 5);
}

}  // namespace
}  // namespace whit::api
