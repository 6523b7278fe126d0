// Scenes made in memory: the pictures of files that say the same, and the same errors.
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "has_text.h"
#include "io/image/image_file.h"
#include "library_scenes.h"

namespace whit::api {
namespace {

constexpr std::array<float, 12> kCorners{-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0.5f, 1};
constexpr std::array<float, 8> kUvs{0, 0, 2, 0, 2, 1, 0, 1};
constexpr std::array<std::uint32_t, 6> kTriangles{0, 2, 1, 0, 3, 2};
constexpr std::array<std::uint8_t, 12> kCodes{200, 30, 10, 20, 180, 90, 5, 60, 220, 255, 255, 255};
const Camera kCamera{{0.5, 2, 4}, {0, 0, 0}};

MeshArrays sheet() {
  MeshArrays arrays;
  arrays.positions = kCorners;
  arrays.triangles = kTriangles;
  arrays.uvs = kUvs;
  return arrays;
}

ImageArrays picture() {
  ImageArrays image{2, 2, 3};
  image.codes = kCodes;
  return image;
}

SceneBuilder sheetBuilder() {
  SceneBuilder builder("sheets");
  builder.addMesh("sheet", sheet()).addTexture("dots", picture());

  Material red;
  red.diffuse = {0.75, 0.5, 0.25};
  red.diffuseMap = "dots";
  builder.addMaterial("red", red);
  builder.addCamera("front", kCamera);

  Light lamp;
  lamp.position = {1, 4, 2};
  lamp.intensity = {30, 30, 30};
  builder.addLight(lamp);
  return builder;
}

// Writes the same scene as a scene file, a model and an image.
std::string writeSheets(const TemporaryFolder& folder) {
  std::ofstream(folder / "sheet.obj")
      << "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0.5 1\nvt 0 0\nvt 2 0\nvt 2 1\nvt 0 1\ns off\n"
      << "f 1/1 3/3 2/2\nf 1/1 4/4 3/3\n";

  DisplayImage image;
  image.width = image.height = 2;
  for (std::size_t i = 0; i < kCodes.size(); i += 3) {
    image.rgba.insert(image.rgba.end(), {kCodes[i], kCodes[i + 1], kCodes[i + 2], 255});
  }
  writePng(folder / "dots.png", image, {});

  std::ofstream(folder / "sheets.json") << R"({"whit": 1,
    "cameras": {"front": {"eye": [0.5, 2, 4], "at": [0, 0, 0]}},
    "lights": [{"position": [1, 4, 2], "intensity": 30}],
    "sky": {"color": [0.1, 0.2, 0.3]}, "ambient": {"fromSky": 0.5},
    "textures": {"dots": {"image": "dots.png"}},
    "scene": [
      {"model": "sheet.obj", "materials": {"*": {"diffuse": [0.75, 0.5, 0.25], "diffuseMap": "dots"}}},
      {"model": "sheet.obj", "materials": {"*": {"diffuse": [0.75, 0.5, 0.25], "diffuseMap": "dots"}},
       "transform": {"matrix": [0.5, 0, 0, 0, 0, 0.5, 0, 1, 0, 0, 0.5, 0]}}]})";
  return folder / "sheets.json";
}

TEST(SceneBuilder, MakesThePictureOfFiles) {
  const TemporaryFolder folder;
  SceneBuilder builder = sheetBuilder();
  EXPECT_EQ(builder.addInstance("sheet", "red"), "/scene/0");
  EXPECT_EQ(builder.addInstance("sheet", "red", {0.5, 0, 0, 0, 0, 0.5, 0, 1, 0, 0, 0.5, 0}),
            "/scene/1");
  builder.set("/sky", R"({"color": [0.1, 0.2, 0.3]})").set("/ambient", R"({"fromSky": 0.5})");

  const Scene scene = builder.build();
  EXPECT_EQ(scene.name(), "sheets");
  EXPECT_EQ(scene.triangles(), 4u);
  EXPECT_EQ(scene.cameras(), std::vector<std::string>{"front"});

  const Image image = smallRenderer(scene).render();
  EXPECT_TRUE(samePictures(image, smallRenderer(loadScene(writeSheets(folder))).render()));
  EXPECT_GT(*std::max_element(image.rgb().begin(), image.rgb().end()), 0.25f);
}

TEST(SceneBuilder, TellsWhereThingsAre) {
  SceneBuilder builder = sheetBuilder();
  EXPECT_EQ(builder.addLight({}), "/lights/1");
  EXPECT_EQ(builder.addCamera("a/b", kCamera), "/cameras/a~1b");
  EXPECT_EQ(builder.addMaterial("blue", {}), "/materials/blue");
}

TEST(SceneBuilder, CamerasHaveALens) {
  const auto picture = [](const Camera& camera) {
    SceneBuilder builder = sheetBuilder();
    builder.addInstance("sheet", "red");
    builder.addCamera("front", camera);
    return smallRenderer(builder.build()).set("spp", "4").render();
  };

  Camera camera = kCamera;
  const Image sharp = picture(camera);
  camera.aperture = 0.5;
  const Image blurred = picture(camera);
  EXPECT_FALSE(samePictures(blurred, sharp));
  camera.focus = 2;
  EXPECT_FALSE(samePictures(picture(camera), blurred));
}

TEST(SceneBuilder, CamerasHaveAProjection) {
  SceneBuilder builder = sheetBuilder();
  builder.addInstance("sheet", "red");
  const Image plain = smallRenderer(builder.build()).render();

  Camera camera = kCamera;
  camera.projection = "equisolid";
  camera.angle = 90;
  builder.addCamera("front", camera);

  Renderer renderer = smallRenderer(builder.build());
  EXPECT_TRUE(hasText(renderer.scene().camera(), "equisolid"));
  const Image round = renderer.render();
  EXPECT_FALSE(samePictures(round, plain));

  // A camera in JSON holds until an empty one takes it back.
  EXPECT_TRUE(samePictures(
      renderer.lookThrough(R"({"eye": [0.5, 2, 4], "at": [0, 0, 0]})").render(), plain));
  EXPECT_TRUE(samePictures(renderer.lookThrough("").render(), round));

  camera.aperture = 0.1;  // a panorama has no aperture
  camera.projection = "panorama";
  camera.angle = 180;
  builder.addCamera("front", camera);
  EXPECT_THROW(builder.build(), Error);
}

TEST(SceneBuilder, VerticesComeInThreesWithoutTriangles) {
  constexpr std::array<float, 18> kSoup{-1, 0, -1, 1,  0,    1, 1, 0, -1,
                                        -1, 0, -1, -1, 0.5f, 1, 1, 0, 1};
  SceneBuilder builder = sheetBuilder(), soup = sheetBuilder();
  MeshArrays arrays;
  arrays.positions = kSoup;
  soup.addMesh("sheet", arrays);
  builder.addInstance("sheet");
  soup.addInstance("sheet");
  EXPECT_TRUE(
      samePictures(smallRenderer(builder.build()).render(), smallRenderer(soup.build()).render()));
}

TEST(SceneBuilder, MemoryIsHeldUntilItIsReadForTheLastTime) {
  auto owned = std::make_shared<std::vector<float>>(kCorners.begin(), kCorners.end());
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
  const auto mesh = [](const std::function<void(MeshArrays&)>& spoil) {
    return [spoil](SceneBuilder& builder) {
      MeshArrays arrays = sheet();
      spoil(arrays);
      builder.addMesh("sheet", arrays);
      builder.addInstance("sheet", "red");
    };
  };

  static constexpr std::array<float, 12> kNan{0, 0, 0, 1, NAN, 0, 0, 0, 1, 1, 0, 1};
  static constexpr std::array<float, 12> kBright{0, 0, 0, 1, 2, 0, 0, 0, 1, 1, 0, 1};
  static constexpr std::array<std::uint32_t, 6> kOutside{0, 1, 2, 0, 1, 4};

  const Wrong all[] = {
      {"/scene/0/mesh", "vertices below 4", mesh([](MeshArrays& m) { m.triangles = kOutside; })},
      {"/scene/0/mesh", "three vertices a triangle",
       mesh([](MeshArrays& m) { m.triangles = m.triangles.first(5); })},
      {"/scene/0/mesh", "three numbers a position",
       mesh([](MeshArrays& m) { m.positions = m.positions.first(11); })},
      {"/scene/0/mesh", "finite numbers in positions",
       mesh([](MeshArrays& m) { m.positions = kNan; })},
      {"/scene/0/mesh", "finite numbers in normals", mesh([](MeshArrays& m) { m.normals = kNan; })},
      {"/scene/0/mesh", "numbers from 0", mesh([](MeshArrays& m) { m.colors = kBright; })},
      {"/scene/0/mesh", "uvs for 4 vertices", mesh([](MeshArrays& m) { m.uvs = m.uvs.first(6); })},
      {"/scene/0/mesh", "normals for 4 vertices",
       mesh([](MeshArrays& m) { m.normals = m.positions.first(9); })},
      {"/scene/0/mesh", "a multiple of 3 vertices", mesh([](MeshArrays& m) { m.triangles = {}; })},
      {"/scene/0/mesh", "the name of a mesh (is \"sheet\" meant?)",
       [](SceneBuilder& b) { b.addInstance("sheat"); }},
      {"/scene/0/material", "the name of a material (is \"red\" meant?)",
       [](SceneBuilder& b) { b.addInstance("sheet", "rad"); }},
      {"/scene/0/transform", "a transform that can be undone",
       [](SceneBuilder& b) { b.addInstance("sheet", "red", Matrix{}); }},
      {"/lights/0/radius", "a number from 1.1e-19",
       [](SceneBuilder& b) { b.set("/lights/0/radius", "0"); }},
      {"/lights/0/intensity", "", [](SceneBuilder& b) { b.set("/lights/0/intensity", "-1"); }},
      {"/cameras/front", "eye and at to differ",
       [](SceneBuilder& b) {
         b.addCamera("front", {{1, 1, 1}, {1, 1, 1}});
       }},
      {"/materials/red/roughness", "a number from 0 to 1",
       [](SceneBuilder& b) { b.set("/materials/red/roughness", "2"); }},
      {"/textures/dots/array", "the name of an array (is \"dots\" meant?)",
       [](SceneBuilder& b) { b.set("/textures/dots/array", "\"dot\""); }},
      {"/textures/dots/array", "width * height * channels numbers",
       [](SceneBuilder& b) {
         ImageArrays image = picture();
         image.width = 3;
         b.addTexture("dots", image);
       }},
      {"/textures/dots/array", "1 to 65536 pixels",
       [](SceneBuilder& b) {
         b.addTexture("dots", {-1, 1, 3});
       }},
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
  EXPECT_EQ(errorOf([&] { builder.set("/sky", "{"); }).status(), 2);
  EXPECT_EQ(errorOf([&] { builder.set("", "{}"); }).status(), 2);
  EXPECT_EQ(errorOf([&] { SceneBuilder("a", "[1]"); }).status(), 3);

  const Error error = errorOf([&] { SceneBuilder("a", "{\n\"sky\": }"); });
  EXPECT_EQ(error.file(), "a");
  EXPECT_TRUE(error.place().starts_with("2:")) << error.place();
  builder.set("/whit", "2");
  EXPECT_EQ(errorOf([&] { builder.build(); }).place(), "/whit");
}

TEST(SceneBuilder, MemoryHasALimit) {
  SceneBuilder builder = sheetBuilder();
  builder.addInstance("sheet");
  LoadOptions options;
  options.maxMemoryGb = 1e-8;
  EXPECT_EQ(errorOf([&] { builder.build(options); }).status(), 5);
}

TEST(SceneBuilder, ThingsAreMovedByHand) {
  SceneBuilder builder = sheetBuilder(), there = sheetBuilder();
  constexpr Matrix kPlace{1, 0, 0, 0.5, 0, 1, 0, 0.25, 0, 0, 1, 0};
  LoadOptions options;
  options.movable = {builder.addInstance("sheet", "red")};
  there.addInstance("sheet", "red", kPlace);

  Renderer renderer = smallRenderer(builder.build(options));
  const Image rest = renderer.render();
  const Image moved = renderer.setTransform(options.movable[0], kPlace).render();
  EXPECT_FALSE(samePictures(rest, moved));
  // An object that can be moved is traced in its own space, with roundings of its own.
  EXPECT_TRUE(samePictures(moved, smallRenderer(there.build(options)).render()));
}

TEST(SceneBuilder, TheLimitOfVerticesIsChecked) {
  const float one = 0;  // not read: the number of vertices comes first
  SceneBuilder builder = sheetBuilder();
  MeshArrays arrays;
  arrays.positions = {&one, std::size_t{3} * 0xffffffffu};
  builder.addMesh("sheet", arrays);
  builder.addInstance("sheet");

  LoadOptions options;
  options.maxMemoryGb = 1e6;
  EXPECT_EQ(errorOf([&] { builder.build(options); }).status(), 5);
}

}  // namespace
}  // namespace whit::api
