// The public header against the insides: the same bits, the same errors, values that are values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/option_table.h"
#include "has_text.h"
#include "inspect/reference_frame.h"
#include "io/image/image_file.h"
#include "io/image/image_layers.h"
#include "io/load_scene.h"
#include "library/whit.h"
#include "library_scenes.h"
#include "render/renderer.h"

namespace whit::api {
namespace {

constexpr std::uint32_t kNothing = 0xffffffffu;

const Scene& whittedScene() {
  static const Scene scene = loadScene("whitted");
  return scene;
}

Renderer whittedRenderer() {
  Renderer renderer = smallRenderer(whittedScene());
  renderer.set("threads", "1");
  return renderer;
}

// The picture itself, and what a screen shows of it.
bool sameBits(const Film& expected, const Image& image) {
  const std::vector<Rgb>& pixels = expected.image.pixels;
  return image.rgb().size() == 3 * pixels.size() &&
         std::memcmp(image.rgb().data(), pixels.data(), image.rgb().size_bytes()) == 0 &&
         std::ranges::equal(image.srgb(), expected.display.rgba);
}

// A scene and its pictures without the library.
struct Inside {
  explicit Inside(const std::string& name = "whitted", const whit::LoadOptions& load = {}) {
    Warnings warnings;
    scene = whit::Scene::finalize(whit::loadScene(name, load, warnings), warnings);
    options.size = ImageSize{40, 24};
    options.threads = 1;
  }
  Film render(const whit::Camera& camera, Mode mode = Mode::packets) {
    whit::Renderer renderer(scene, options);
    Film film = makeFilm(scene, options);
    if (mode == Mode::packets) {
      renderer.render(camera, film);
    } else {
      renderReference(renderer, camera, film);
    }
    return film;
  }
  whit::Scene scene;
  RenderOptions options;
};

TEST(SceneOptions, HoldUntilAnotherValueIsSet) {
  SceneBuilder builder("scene", asJson("{'options': {'spp': 2, 'exposure': 1, 'tonemap': 'filmic'},"
                                       "'scene': [{'shape': 'box'}]}"));
  Renderer renderer(builder.build());
  EXPECT_EQ(renderer.get("depth"), "64");
  EXPECT_EQ(renderer.get("size"), "");
  renderer.set("tonemap", "none").set("depth", "3");
  EXPECT_EQ(renderer.get("spp"), "2");
  EXPECT_EQ(renderer.get("exposure"), "1");
  EXPECT_EQ(renderer.get("tonemap"), "none");

  // Presets give way to what was set.
  EXPECT_EQ(renderer.set("quality", "good").get("spp"), "16");
  EXPECT_EQ(renderer.get("depth"), "3");

  renderer.setMember("/options/exposure", "2");
  EXPECT_EQ(renderer.get("exposure"), "2");
  EXPECT_EQ(statusOf([&] { renderer.setMember("/options/exposure", "\"bright\""); }), 3);
  EXPECT_EQ(renderer.reset().get("spp"), "2");

  Renderer other(whittedScene());
  EXPECT_EQ(other.set("quality", "good").set("quality", "standard").get("spp"), "1");
}

TEST(Library, AnAutomaticExposureIsThatOfTheCamera) {
  Renderer renderer = whittedRenderer();
  const Image own = renderer.set("exposure", "auto").render();
  renderer.lookThrough(R"({"eye": [0, 90, 0], "at": [1, 95, 0]})").render();
  EXPECT_TRUE(std::ranges::equal(renderer.lookThrough("").render().srgb(), own.srgb()));
}

TEST(Library, TakesOptionsOverForFramesToCome) {
  Inside inside;
  Renderer renderer = whittedRenderer();
  Image image = renderer.render();
  EXPECT_EQ(image.width(), 40);
  EXPECT_EQ(image.height(), 24);
  const Film deep = inside.render(inside.scene.cameras[0]);
  EXPECT_TRUE(sameBits(deep, image));

  renderer.set("depth", "0").render(image);  // plans the next frame anew
  EXPECT_FALSE(sameBits(deep, image));
  inside.options.depth = 0;
  EXPECT_TRUE(sameBits(inside.render(inside.scene.cameras[0]), image));

  // This change builds the BVH anew.
  renderer.set("robust", "off").set("depth", "8").render(image);
  inside.options.depth = 8;
  inside.options.robust = false;
  EXPECT_TRUE(sameBits(inside.render(inside.scene.cameras[0]), image));

  renderer.set("mode", "reference").render(image);
  EXPECT_TRUE(sameBits(inside.render(inside.scene.cameras[0], Mode::reference), image));
  EXPECT_TRUE(renderer.statistics().stages.empty());
}

TEST(Library, FollowsThePathAndCrops) {
  Inside inside;
  Renderer renderer = whittedRenderer();
  const whit::Camera camera = cameraAt(inside.scene.cameraPath, 0.5);
  Image image;
  renderer.renderOnPath(0.5, image);
  EXPECT_TRUE(sameBits(inside.render(camera), image));
  EXPECT_GT(whittedScene().pathSeconds(), 0.5);

  renderer.set("crop", "8,4,20,16").renderOnPath(0.5, image);
  EXPECT_EQ(image.width(), 12);
  EXPECT_EQ(image.left(), 8);
  EXPECT_EQ(image.top(), 4);
  inside.options.crop = Crop{8, 4, 20, 16};
  EXPECT_TRUE(sameBits(inside.render(camera), image));
}

TEST(Library, TellsWhatAFrameCost) {
  Renderer renderer = whittedRenderer();
  renderer.render();
  const FrameStatistics& cost = renderer.statistics();
  ASSERT_EQ(cost.stages.size(), kStageCount);
  EXPECT_EQ(cost.stages[0].name, "generateRays");

  double sum = 0;
  for (const auto& stage : cost.stages) sum += stage.ms;
  EXPECT_GT(sum, 0);
  EXPECT_LE(sum, cost.frameMs * 1.0001);  // one worker: its stages are within the frame

  ASSERT_EQ(cost.rays.size(), kRayKindCount);
  EXPECT_EQ(cost.rays[0].count, 40u * 24u);
}

TEST(Library, ChannelsAreThoseThatFilesHave) {
  Renderer renderer = whittedRenderer();
  Image image = renderer.render();
  EXPECT_TRUE(image.channels().empty());
  EXPECT_EQ(statusOf([&] { (void)image.channel("depth"); }), 2);

  renderer.set("channels", "depth,object");
  renderer.render(image);
  ASSERT_EQ(image.channels().size(), 2u);

  const Image::Channel depth = image.channel("depth"), object = image.channel("object");
  EXPECT_EQ(depth.components, (std::vector<std::string_view>{"Z", "distance"}));
  EXPECT_EQ(depth.values.size(), 2 * 40 * 24u);
  EXPECT_TRUE(depth.numbers.empty());
  EXPECT_TRUE(object.values.empty());
  EXPECT_EQ(object.components, (std::vector<std::string_view>{"id"}));

  for (std::size_t i = 0; i < object.numbers.size(); ++i) {
    const bool isNothing = object.numbers[i] == kNothing;
    EXPECT_EQ(isNothing, std::isinf(depth.values[2 * i]));
    EXPECT_TRUE(isNothing || object.numbers[i] < whittedScene().objects().size());
  }
  EXPECT_GT(whittedScene().materials().size(), 0u);

  const TemporaryFolder folder;
  const std::string path = folder / "channels.exr";
  image.write(path);
  const std::vector<ImageLayer> layers = readLayers(path, ImageLimits());
  ASSERT_EQ(layers.size(), 3u);
  EXPECT_EQ(layers[0].name, "depth.Z");
  EXPECT_EQ(layers[0].floats()[7], depth.values[14]);
  EXPECT_TRUE(std::ranges::equal(object.numbers, layers[2].words));
}

TEST(Library, ImagesAreValues) {
  Renderer renderer = whittedRenderer();
  const Image first = renderer.render();
  Image second = first;
  renderer.set("depth", "0").render(second);
  EXPECT_NE(first.rgb().data(), second.rgb().data());
  EXPECT_FALSE(samePictures(first, second));

  const float* const pixels = second.rgb().data();
  const Image third = std::move(second);
  EXPECT_EQ(third.rgb().data(), pixels);
  renderer.render(second);  // what was moved from can be used again
  EXPECT_EQ(second.width(), 40);
}

TEST(Library, ImagesForgetTheAlphaOfAnEarlierPicture) {
  const TemporaryFolder folder;
  Renderer renderer = whittedRenderer();
  Image image;
  renderer.set("background", "transparent").render(image);
  EXPECT_EQ(statusOf([&] { image.write(folder / "a.jpg"); }), 2);

  for (const char* mode : {"packets", "reference"}) {
    renderer.set("background", "sky").set("mode", mode).render(image);
    image.write(folder / "a.jpg");
    EXPECT_EQ(image.png(), renderer.render().png());
  }
}

TEST(Library, BytesOfAnImageHoldAllOfIt) {
  const Image image = whittedRenderer()
                          .set("background", "transparent")
                          .set("crop", "8,4,20,16")
                          .set("channels", "depth")
                          .render();
  const Image same = Image::fromBytes(image.bytes());
  EXPECT_EQ(same.png(), image.png());
  EXPECT_EQ(same.bytes(), image.bytes());
}

TEST(Library, HandlesThatWereMovedFromSaySo) {
  Renderer renderer = whittedRenderer();
  Scene scene = renderer.scene();
  SceneBuilder builder;
  const Renderer renderer2 = std::move(renderer);
  const Scene scene2 = std::move(scene);
  const SceneBuilder builder2 = std::move(builder);

  Image image;
  const std::function<void()> uses[] = {
      [&] { renderer.render(); },
      [&] { renderer.renderOnPath(0, image); },
      [&] { renderer.set("depth", "3"); },
      [&] { renderer.get("depth"); },
      [&] { renderer.reset(); },
      [&] { renderer.setTime(1); },
      [&] { renderer.setTransform("/scene/0", kIdentity); },
      [&] { renderer.setMember("/lights/0/intensity", "4"); },
      [&] { renderer.setProgress({}); },
      [&] { static_cast<void>(renderer.scene()); },
      [&] { static_cast<void>(renderer.statistics()); },
      [&] { static_cast<void>(scene.name()); },
      [&] { scene.warnings(); },
      [&] { Renderer(scene).render(); },
      [&] { builder.addLight({}); },
      [&] { builder.build(); },
      [&] { SceneBuilder copy(builder); },
  };
  for (const auto& use : uses) {
    const Error error = errorOf(use);
    EXPECT_TRUE(hasText(error.what(), "after a move"));
    EXPECT_EQ(error.status(), 2);
  }

  renderer = whittedRenderer();  // a renderer that was moved from can be assigned to
  EXPECT_EQ(renderer.render().width(), 40);
}

TEST(Library, TheVersionIsInTheHeader) {
  EXPECT_EQ(version(), WHIT_VERSION);
  EXPECT_EQ(version(), std::to_string(WHIT_VERSION_MAJOR) + "." +
                           std::to_string(WHIT_VERSION_MINOR) + "." +
                           std::to_string(WHIT_VERSION_PATCH));
}

TEST(Library, FailsWithTheProgramsStatus) {
  Renderer renderer = whittedRenderer();
  const std::pair<int, std::function<void()>> failures[] = {
      {2, [&] { renderer.set("detph", "3"); }},
      {2, [&] { renderer.set("depth", "many"); }},
      {2, [&] { renderer.get("sise"); }},
      {2, [] { loadScene("no-such-scene"); }},
      {4, [] { loadScene("no/such/file.json"); }},
      {2, [] { Image().write("nothing.png"); }},
      {4, [&] { renderer.render().write("no/such/folder/a.png"); }},
      {2, [&] { renderer.render().write("a.gif"); }},
      {2, [&] { renderer.set("camera", "nobody").render(); }},
      {5, [&] { renderer.set("camera", "").set("size", "65536x65536").render(); }},
  };
  for (const auto& [status, fail] : failures) EXPECT_EQ(statusOf(fail), status);

  renderer.set("size", "16x16");
  EXPECT_EQ(renderer.render().width(), 16);  // an error does not end the renderer
}

TEST(Library, SegmentsOfSpheresAreAMatterOfLoading) {
  EXPECT_EQ(statusOf([] { whittedRenderer().set("sphere-segments", "16").render(); }), 2);
  EXPECT_EQ(statusOf([] { loadScene("whitted", {.sphereSegments = 3}); }), 2);

  const Scene coarse = loadScene("whitted", {.sphereSegments = 16});
  EXPECT_GT(coarse.triangles(), whittedScene().triangles());
  Renderer renderer(coarse);
  renderer.set("size", "40x24").set("sphere-segments", "16");
  EXPECT_EQ(renderer.render().width(), 40);
}

TEST(Library, ScenesThatAreNotGoodSayWhere) {
  const TemporaryFolder folder;
  const std::string file = folder / "bad.json";
  std::ofstream(file) << asJson("{'whit': 1, 'size': ['wide', 3]}");
  const Error error = errorOf([&] { loadScene(file); });
  EXPECT_EQ(error.status(), 3);
  EXPECT_TRUE(hasText(error.what(), "#/size"));
}

TEST(Library, ScenesMoveAndComeBack) {
  const Scene scene = loadScene("orrery", {.moves = true});
  ASSERT_EQ(scene.animations().size(), 1u);
  EXPECT_EQ(scene.animations()[0].name, "scene");
  EXPECT_EQ(scene.animations()[0].seconds, 10);

  Renderer renderer = smallRenderer(scene), still = smallRenderer(scene);
  const Image start = renderer.render();

  for (const double seconds : {6.5, 2.5}) {
    whit::LoadOptions then;
    then.instant.seconds = seconds;
    Inside inside("orrery", then);
    applySceneOptions(inside.scene.options, {}, inside.options);
    const Film film = inside.render(chooseCamera(inside.scene, inside.options));
    EXPECT_TRUE(sameBits(film, renderer.setTime(seconds).render())) << seconds;
  }

  EXPECT_FALSE(samePictures(start, renderer));
  EXPECT_TRUE(samePictures(start, still)) << "another renderer's scene has moved";
  EXPECT_TRUE(samePictures(start, renderer.setTime(0)));

  // What does not move, or was not loaded to move, has no time.
  EXPECT_EQ(statusOf([] { whittedRenderer().setTime(1); }), 2);
  EXPECT_EQ(statusOf([] { smallRenderer("orrery").setTime(1); }), 2);
  EXPECT_EQ(statusOf([&] { renderer.setTime(NAN); }), 2);
}

std::string writeLoose(const std::filesystem::path& file, const std::string& place) {
  std::ofstream(file) << asJson("{'whit': 1, 'cameras': {'c': {'eye': [0, 0, 9], 'at': [0, 0, 0]" +
                                place + "}}, 'lights': [{'position': [3, 5, 6], 'intensity': 90" +
                                place +
                                "}], 'scene': [{'shape': 'box'}, {'group': [{'shape': 'sphere'" +
                                place + "}], 'transform': {'translate': [2, 0, 0]}}]}");
  return file.string();
}

// Objects that setTransform() places give the picture of a file that states the same places.
TEST(Library, ThingsAreMovedByHand) {
  const TemporaryFolder folder;
  const std::string loose = writeLoose(folder / "loose.json", "");
  const std::string stated =
      writeLoose(folder / "placed.json",
                 ", 'motion': {'keys': [{'time': 0, 'translate': [-1, 0.5, 0], 'scale': 2}]}");

  LoadOptions moving;
  moving.movable = {"/cameras/c", "/lights/0", "/scene/1/group/0"};
  Renderer renderer = smallRenderer(loose, moving);
  const Image rest = renderer.render();
  const auto moved = [&](const Matrix& place) {
    for (const std::string& pointer : moving.movable) renderer.setTransform(pointer, place);
    return renderer.render();
  };

  const Image there = moved(placed({-1, 0.5, 0}, {2, 2, 2}));
  EXPECT_FALSE(samePictures(rest, there));
  EXPECT_TRUE(samePictures(smallRenderer(stated, {.moves = true}), there));
  EXPECT_TRUE(samePictures(rest, moved(kIdentity)));

  for (const char* wrong : {"/scene/0", ""}) {
    EXPECT_EQ(statusOf([&] { renderer.setTransform(wrong, kIdentity); }), 2) << wrong;
  }
  for (const double bad : {double{NAN}, 1e300}) {
    EXPECT_EQ(statusOf([&] { renderer.setTransform("/lights/0", placed({0, bad, 0})); }), 2) << bad;
  }
  // An empty pointer does not mean things without a name.
  moving.moves = true;
  EXPECT_EQ(statusOf([&] { smallRenderer(stated, moving).setTransform("", kIdentity); }), 2);
  for (const char* wrong : {"/scene/7", ""}) {
    moving.movable = {wrong};
    EXPECT_EQ(statusOf([&] { loadScene(stated, moving); }), 2) << wrong;
  }
}

}  // namespace
}  // namespace whit::api
