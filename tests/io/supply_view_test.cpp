// The view, lights and sky that a model gets without a scene file, and the sky that the user
// chooses.
#include "farthest_in_picture.h"
#include "gltf_files.h"
#include "io/scene/scene_sections.h"
#include "make/model_view.h"
#include "make/studio_sky.h"
#include "solids.h"

namespace whit {
namespace {

// Radiance files with one row, which have the value 1 everywhere, or 4.
const std::string kHdrHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
const std::string kOne = kHdrHead + std::string("\x80\x80\x80\x81\x80\x80\x80\x81", 8);
const std::string kFour = kHdrHead + std::string("\x80\x80\x80\x83\x80\x80\x80\x83", 8);

Box boundsOf(const SceneDescription& scene) {
  Box box;
  for (const Instance& instance : scene.instances) {
    for (const Mesh& mesh : scene.objects[instance.object].meshes) {
      for (const Vec3f& p : mesh.positions) box.add(Vec3f(instance.toWorld.point(Vec3d(p))));
    }
  }
  return box;
}

class SuppliedView : public GltfTest {
 protected:
  // Loads a triangle with a light above it. If `camera` is the rotation of a camera, the camera is
  // at the light's place.
  SceneDescription loadLit(double intensity, const std::string& camera = "") {
    const std::string eye =
        camera.empty()
            ? ""
            : ",{'name':'own','camera':0,'translation':[0.3,0.3,2],'rotation':" + camera + "}";

    return load(
        save("lit.gltf",
             json(joined("'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}}],"
                         "'nodes':[{'mesh':0},{'translation':[0.3,0.3,2],"
                         "'extensions':{'KHR_lights_punctual':{'light':0}}}",
                         eye,
                         "],'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point',"
                         "'intensity':",
                         intensity, "}]}},'meshes':[{'primitives':[", triangle(), "]}]"))));
  }

  // Where a model has its highest coordinates with this axis up.
  Vec3f upperOf(const std::string& obj, const std::string& up = "") {
    if (!up.empty()) options_.settings = {"/up='" + up + "'"};
    const Vec3f upper = boundsOf(loadObj(obj)).upper;
    options_.settings.clear();
    return upper;
  }
};

TEST_F(SuppliedView, AModelStandsInAStudio) {
  const SceneDescription scene = loadObj(kTriangleObj);
  EXPECT_TRUE(scene.isModel);
  EXPECT_EQ(skyName(scene.sky), "studio");
  EXPECT_EQ(scene.sky.scale, 1);

  const Ambient expected = ambientFromSky(studioSky(), kAmbientOfSky);
  EXPECT_EQ(scene.ambient.up, expected.up);
  EXPECT_EQ(scene.ambient.down, expected.down);
  EXPECT_EQ(scene.cameras.size(), 1u);
}

// SceneSettings.OptionsOfAModel has those of a model alone.
TEST_F(SuppliedView, ModelsHaveOneBackgroundInTheStudio) {
  const SceneDescription file =
      loadMembers("'view': 'model', 'options': {'tonemap': 'none'}, 'scene': [{'shape': 'quad'}]");
  EXPECT_EQ(file.options.at("tonemap"), "none");
  EXPECT_EQ(file.options.at("background"), "c8c8c8");

  // Another sky is there to be seen.
  for (const std::string& sky : {std::string("none"), save("one.hdr", kOne)}) {
    options_.sky = sky;
    EXPECT_FALSE(loadObj(kTriangleObj).options.contains("background")) << sky;
  }
}

TEST_F(SuppliedView, AzimuthAndZoomReplaceTheCameraOfTheFile) {
  EXPECT_EQ(loadLit(1, "[0,0,0,1]").cameras.at(0).name, "own");
  options_.settings = {"/azimuth=90", "/zoom=2"};
  const SceneDescription scene = loadLit(1, "[0,0,0,1]");
  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& camera = scene.cameras[0];
  EXPECT_NEAR(camera.eye.z, camera.at.z, 1e-5);
  EXPECT_GT(camera.eye.x, camera.at.x);

  const SceneDescription file = loadMembers("'view': 'model', 'scene': [{'shape': 'quad'}]");
  EXPECT_NEAR(file.cameras.at(0).eye.z, file.cameras[0].at.z, 1e-5);
  expectLike(errorOfMembers("'scene': [{'shape': 'quad'}]"),
             "*azimuth: s is neither a model nor a scene file with \"view\": \"model\"*");
  options_.settings = {"/zoom=0"};
  expectLike(errorOfObj(kTriangleObj), "*m.obj#/zoom: expected*");
}

TEST_F(SuppliedView, LightsAreAsFarFromATinyModelAsFromAnother) {
  const auto distance = [&](const std::string& scale) {
    const SceneDescription scene = loadMembers(
        "'view': 'model', 'scene': [{'shape': 'quad', 'transform': {'scale': " + scale + "}}]");
    return length(Vec3d(scene.lights.at(0).position));
  };
  EXPECT_NEAR(distance("1e-9") / distance("1"), 1e-9, 1e-14);
}

TEST_F(SuppliedView, AShadowLiesBelowAModel) {
  const SceneDescription without = loadObj(kTriangleObj);
  options_.settings = {"/ground=true"};
  const SceneDescription with = loadObj(kTriangleObj);
  ASSERT_EQ(with.materials.size(), without.materials.size() + 1);
  EXPECT_EQ(with.materials.back().name, kGroundShadowName);
  EXPECT_EQ(with.cameras.at(0).eye, without.cameras.at(0).eye);
  EXPECT_EQ(with.items, without.items + 1);
  bake(with);
  expectNoWarnings();
}

TEST_F(SuppliedView, TheStudioIsAsBrightAsItsLights) {
  const SceneDescription dim = loadLit(0.01), bright = loadLit(1000);
  EXPECT_EQ(dim.lights.size(), 1u);
  EXPECT_EQ(skyName(dim.sky), "studio");
  EXPECT_NEAR(bright.sky.scale / dim.sky.scale, 1e5f, 10);
  EXPECT_NEAR(bright.ambient.up.x / dim.ambient.up.x, 1e5f, 10);
}

// An item's own lights and cameras follow its transform, and no lamps are supplied beside them.
TEST_F(SuppliedView, ModelsOfASceneWithAViewBringTheirLightsAndCameras) {
  const SceneDescription alone = loadLit(5, "[0,0,0,1]");
  const std::string item =
      "{'model': 'lit.gltf', 'transform': {'scale': 2, 'translate': [1, 0, 0]}}";
  const SceneDescription scene = loadMembers("'view': 'model', 'scene': [" + item + "]");
  expectNoWarnings();
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].position, alone.lights.at(0).position * 2.0f + Vec3f(1, 0, 0));
  EXPECT_EQ(scene.lights[0].intensity, alone.lights[0].intensity);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "own");
  EXPECT_EQ(scene.cameras[0].eye, alone.cameras.at(0).eye * 2.0f + Vec3f(1, 0, 0));
  EXPECT_EQ(skyName(scene.sky), "studio");
}

TEST_F(SuppliedView, LightsAndCamerasOfOtherItemsAreLeftOutAloud) {
  loadLit(5, "[0,0,0,1]");
  const char* const kind =
      "cameras and lights of a model left out: a scene states its own, or takes those of the "
      "models in \"scene\", placed once and at rest, by \"view\": \"model\"";
  const std::string model = "{'model': 'lit.gltf'";
  EXPECT_TRUE(loadMembers("'scene': [" + model + "}]").lights.empty());
  expectWarned(kind, 2);

  // It is not said where they would stand.
  const std::string repeat = ", 'repeat': {'count': [2, 1, 1], 'step': [3, 0, 0]}}";
  loadMembers("'view': 'model', 'scene': [" + model + repeat + "]");
  expectWarned(kind, 4);
  loadMembers("'view': 'model', 'scene': [{'group': [" + model + "}]}]");
  expectWarned(kind, 6);
}

// The description of ambient light, set on a model, replaces all that a model is supplied with.
TEST_F(SuppliedView, AmbientLightIsDescribedAsAWhole) {
  EXPECT_GT(loadObj(kTriangleObj).ambient.occlusion, 0);
  for (const float radius : {0.0f, 3.0f}) {
    Ambient ambient;
    ambient.up = ambient.down = Rgb(0.5f);
    ambient.occlusion = radius;
    options_.settings = {"/ambient=" + describe(ambient).dump()};
    EXPECT_EQ(loadObj(kTriangleObj).ambient.occlusion, radius);
  }
}

TEST_F(SuppliedView, AnotherSkyOrNone) {
  options_.sky = "none";
  EXPECT_EQ(skyName(loadObj(kTriangleObj).sky), "none");
  EXPECT_EQ(loadObj(kTriangleObj).ambient.up, Rgb(0.25f));
  EXPECT_EQ(loadLit(5).ambient.up, Rgb(0.0f));

  options_.sky = save("one.hdr", kOne);
  const SceneDescription scene = loadObj(kTriangleObj);
  EXPECT_EQ(skyName(scene.sky), "one.hdr");
  ASSERT_EQ(scene.sky.image.r.size(), 2u);
  EXPECT_EQ(scene.sky.image.r[0], 1);
  EXPECT_NEAR(scene.ambient.up.x, kAmbientOfSky, 1e-6);
}

TEST_F(SuppliedView, WhatIsSetStays) {
  options_.settings = {"/sky/color=0.5", "/ambient/color=0.125"};
  const SceneDescription scene = loadObj(kTriangleObj);
  EXPECT_EQ(skyName(scene.sky), "color");
  EXPECT_EQ(scene.ambient.down, Rgb(0.125f));
  options_.settings = {"/sky/color=0.5"};
  EXPECT_NEAR(loadObj(kTriangleObj).ambient.up.x, 0.5 * kAmbientOfSky, 1e-6);
}

TEST_F(SuppliedView, ASceneFileKeepsItsSkyUnlessAnotherIsAskedFor) {
  save("four.hdr", kFour);
  const std::string members =
      "'sky': {'image': 'four.hdr'}, 'ambient': {'fromSky': 0.5}, 'scene': [{'shape': 'quad'}]";

  const SceneDescription own = loadMembers(members);
  EXPECT_FALSE(own.isModel);
  EXPECT_EQ(skyName(own.sky), "four.hdr");
  EXPECT_NEAR(own.ambient.up.x, 2, 1e-5);
  EXPECT_EQ(skyName(loadMembers("'scene': [{'shape': 'quad'}]").sky), "none");

  options_.sky = save("one.hdr", kOne);
  EXPECT_NEAR(loadMembers(members).ambient.up.x, 0.5, 1e-5);

  // The sky of the file is not read if another one replaces it.
  std::filesystem::remove(root_ + "four.hdr");
  EXPECT_EQ(loadMembers(members).sky.image.r.at(0), 1) << "its own is not read";

  options_.sky = "studio";
  EXPECT_EQ(loadMembers(members).sky.image.r, studioSky().image.r);
  options_.sky = "none";
  EXPECT_EQ(loadMembers(members).sky.kind, Sky::Kind::none);
  EXPECT_EQ(loadMembers(members).ambient.up, Rgb(0.0f));
}

TEST_F(SuppliedView, ASkyThatIsNotThere) {
  options_.sky = root_ + "no.hdr";
  expectLike(errorOfObj(kTriangleObj), "4 *");
  options_.sky = save("text.hdr", "not an image");
  expectLike(errorOfObj(kTriangleObj), "3 *");
}

// A bar that stands on the plane z = 0, centered on the z axis.
const std::string kZUpObj =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 4\nv 1 -1 4\nv 1 1 4\nv -1 1 4\nf 4 3 2 1\n"
    "f 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

TEST_F(SuppliedView, ACameraThatSeesNothingGivesWayToAViewOfTheModel) {
  const SceneDescription sees = loadLit(1, "[0,0,0,1]");
  ASSERT_EQ(sees.cameras.size(), 1u);
  EXPECT_EQ(sees.cameras[0].name, "own");
  expectNoWarnings();

  const SceneDescription turned = loadLit(1, "[0,1,0,0]");
  ASSERT_EQ(turned.cameras.size(), 2u);
  EXPECT_TRUE(seesSomething(turned, turned.cameras[0]));
  EXPECT_EQ(turned.cameras[1].name, "own");
  expectLike(kinds(), "*camera that sees nothing*");
}

TEST_F(SuppliedView, TheViewpointIsChosen) {
  options_.settings = {"/viewpoint='outside'"};
  EXPECT_EQ(loadLit(1, "[0,0,0,1]").cameras.size(), 2u);

  options_.settings = {"/viewpoint='inside'"};
  const Vec3f eye = loadObj(kZUpObj).cameras[0].eye;
  EXPECT_LT(maxComponent(abs(eye - Vec3f{0, 2, 0})), 2) << "in the bar";

  options_.settings = {"/viewpoint='above'"};
  expectLike(errorOfObj(kZUpObj), "*m.obj#/viewpoint: expected*");
}

// A box with two materials, whose fronts look inside.
TEST_F(SuppliedView, AViewFromInsideIsSaid) {
  std::string room = kZUpObj;
  for (std::size_t at = 0; (at = room.find("f ", at)) != std::string::npos; ++at) {
    std::swap(room[at + 2], room[at + 8]);
    std::swap(room[at + 4], room[at + 6]);
  }

  options_.settings = {"/up='y'"};
  loadObj(room);
  EXPECT_EQ(kinds(), "") << "a single mesh without materials is a body";

  loadObj(room + "usemtl a\nf 1 2 3\n");
  expectLike(kinds(), "*seen from inside (--viewpoint outside*");
}

TEST_F(SuppliedView, AnAxisIsTurnedUp) {
  EXPECT_EQ(upperOf(kZUpObj, "y"), (Vec3f{1, 1, 4}));
  EXPECT_EQ(upperOf(kZUpObj, "z"), (Vec3f{1, 4, 1}));
  EXPECT_EQ(upperOf("v 0 0 0\nv 5 1 0\nv 0 1 2\nf 1 2 3\n", "x"), (Vec3f{0, 5, 2}));

  options_.settings = {"/up='w'"};
  expectLike(errorOfObj(kZUpObj), "*\"x\", \"y\" or \"z\"*");
  options_.settings = {"/up='z'"};
  EXPECT_EQ(boundsOf(loadObj(kZUpObj)).lower, (Vec3f{-1, 0, -1}));
  expectLike(errorOf([&] { loadLit(1); }), "*files of this format say*");
}

TEST_F(SuppliedView, AGuessOfTheAxisIsSaid) {
  EXPECT_EQ(upperOf(kZUpObj), (Vec3f{1, 4, 1}));
  ASSERT_EQ(warnings_.entries().size(), 1u);
  expectLike(kinds(), "*z seems to be up*");

  // Flat models, one with y up that extends on both sides of z = 0, one that extends to one side
  // only, and one around the origin stay as they are.
  const std::string texts[] = {kTriangleObj, "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n",
                               "v -1 0 -1\nv 1 0 1\nv 0 4 0\nf 1 2 3\n",
                               "v 0 0 0\nv 1 0 1\nv 0 1 3\nf 1 2 3\n",
                               "v -1 -1 -1\nv 1 1 1\nv -1 1 1\nf 1 2 3\n"};
  for (const std::string& text : texts) {
    EXPECT_EQ(upperOf(text), upperOf(text, "y")) << text;
  }
}

TEST_F(SuppliedView, AStatueOnABaseIsTurnedAndShelvesOnAWallAreNot) {
  const auto isTurned = [&](const std::string& text) {
    return upperOf(text) != upperOf(text, "y");
  };

  EXPECT_TRUE(isTurned(objOf(prism(8, 2, 2, 0.2)))) << "it stands on its base, about the origin";
  EXPECT_FALSE(isTurned(objOf(prism(8, 1, 2, 0.2))));
  EXPECT_FALSE(isTurned(objOf(prism(8, 2, 2, 0.9)))) << "both ends are flat";
  EXPECT_FALSE(isTurned(objOf(box({-1, -1, -2}, {1, 1, 2})))) << "a wagon";

  // Three boards extend from the plane z = 0, like shelves from a wall.
  std::string shelves;
  for (int i = 0; i < 3; ++i) {
    const double y = 0.5 * i - 0.5;
    shelves += objOf(box({-0.5, y, 0}, {0.5, y + 0.02, 0.6}), 8 * i + 1);
  }
  EXPECT_FALSE(isTurned(shelves)) << "the wall is z = 0";
}

// The corners reach the margin of the picture, whatever its shape, and none is outside.
TEST_F(SuppliedView, TheModelFillsThePictureThatIsAskedFor) {
  for (const ImageSize size : {ImageSize{480, 300}, {300, 300}, {200, 320}, {1200, 300}}) {
    options_.size = size;
    const SceneDescription scene = loadObj(kZUpObj);
    EXPECT_EQ(scene.width, size.width);
    EXPECT_EQ(scene.height, size.height);

    std::vector<Vec3d> corners;
    for (const Vec3f& p : meshOf(scene).positions) {
      corners.push_back(scene.instances.at(0).toWorld.point(Vec3d(p)));
    }
    const CameraFrame frame = makeCameraFrame(scene.cameras.at(0), size.width, size.height);
    const double farthest = farthestInPicture(frame, corners);
    EXPECT_LE(farthest, 1) << size.width;
    EXPECT_GT(farthest, 0.85) << size.width;
  }
}

}  // namespace
}  // namespace whit
