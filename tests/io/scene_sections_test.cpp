// Cameras, lights, sky, materials and textures of scene files.
#include "io/scene/scene_sections.h"
#include "has_text.h"
#include "make/studio_sky.h"
#include "scene/texture.h"
#include "scene_files.h"

namespace whit {
namespace {

using SceneSections = SceneFileTest;

TEST_F(SceneSections, DefaultsOfAnEmptyScene) {
  const SceneDescription scene = loadMembers("\"scene\": []");
  EXPECT_EQ(scene.width, 480);
  EXPECT_EQ(scene.height, 300);
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_TRUE(scene.objects.empty());
  EXPECT_EQ(scene.sky.kind, Sky::Kind::none);
}

TEST_F(SceneSections, CamerasKeepTheFilesOrder) {
  const SceneDescription scene = loadMembers(
      "\"cameras\": {\"z\": {\"eye\": [1,2,3], \"at\": [0,0,0], \"fov\": 60},"
      "\"a\": {\"eye\": [0,0,9], \"at\": [0,0,0], \"up\": [1,0,0]}}");

  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "z");
  EXPECT_EQ(scene.cameras[0].eye, Vec3f(1, 2, 3));
  EXPECT_EQ(scene.cameras[0].fov, 60);

  EXPECT_EQ(scene.cameras[1].name, "a");
  EXPECT_EQ(scene.cameras[1].up, Vec3f(1, 0, 0));
  EXPECT_EQ(scene.cameras[1].fov, 45);
}

TEST_F(SceneSections, CamerasHaveALens) {
  const auto cameras = [](const std::string& members) {
    return "\"cameras\": {\"a\": {\"eye\": [0,0,9], \"at\": [0,0,5]" + members + "}}";
  };

  const Camera lens = loadMembers(cameras(", \"aperture\": 0.25, \"focus\": 3")).cameras.at(0);
  EXPECT_EQ(lens.aperture, 0.25f);
  EXPECT_EQ(lens.focusDistance(), 3);

  const Camera plain = loadMembers(cameras("")).cameras.at(0);
  EXPECT_EQ(plain.aperture, 0);
  EXPECT_EQ(plain.focusDistance(), 4);

  for (const char* member : {"aperture", "focus"}) {
    const std::string bad = cameras(std::string(", \"") + member + "\": -1");
    EXPECT_TRUE(hasText(errorOfMembers(bad), std::string("/cameras/a/") + member));
  }
}

TEST_F(SceneSections, CamerasHaveAProjection) {
  const auto camera = [&](const std::string& members) {
    const std::string all = "\"cameras\": {\"a\": {\"eye\": [0,0,9], \"at\": [0,0,5], " + members;
    return loadMembers(all + "}}").cameras.at(0);
  };

  const Camera pinhole =
      camera(R"("k": [500, 510, 320, 240, 1.5], "kSize": [640, 480], "distortion": [-0.1, 0.02])");
  EXPECT_EQ(pinhole.projection, Projection::perspective);
  EXPECT_EQ(pinhole.k, (std::vector<float>{500, 510, 320, 240, 1.5f}));
  EXPECT_EQ(pinhole.kSize, (std::vector<float>{640, 480}));
  EXPECT_EQ(pinhole.distortion, (std::vector<float>{-0.1f, 0.02f}));

  const Camera round = camera(R"("projection": "equisolid", "angle": 220)");
  EXPECT_EQ(round.projection, Projection::equisolid);
  EXPECT_EQ(round.angle, 220);
  EXPECT_EQ(camera(R"("projection": "equidistant")").angle, 180);

  const Camera table =
      camera(R"("projection": "directions", "azimuths": [-5, 0, 5], "elevations": [2, -2])");
  EXPECT_EQ(table.azimuths, (std::vector<float>{-5, 0, 5}));
  EXPECT_EQ(table.elevations, (std::vector<float>{2, -2}));

  const Camera pair = camera(R"("projection": "panorama", "stereo": "topBottom")");
  EXPECT_EQ(pair.stereo, Stereo::topBottom);
  EXPECT_EQ(pair.eyeDistance, 0.065f);
}

TEST_F(SceneSections, CamerasThatImageNothing) {
  const auto error = [&](const std::string& members) {
    return errorOfMembers("\"cameras\": {\"a\": {\"eye\": [0,0,9], \"at\": [0,0,5], " + members +
                          "}}");
  };
  const std::string at = "3 s.json#/cameras/a";

  EXPECT_EQ(error(R"("projection": "panoramic")"),
            at + "/projection: expected one of \"perspective\", \"equidistant\", \"equisolid\", "
                 "\"fisheye\", \"panorama\", \"directions\", \"cubeMap\" (is \"panorama\" "
                 "meant?), found \"panoramic\"");

  // The intrinsic matrix and the distortion of a lens.
  EXPECT_EQ(error(R"("k": [5, 5, 2], "kSize": [4, 4])"),
            at + "/k: expected [fx, fy, cx, cy], fx and fy above 0, and perhaps the skew, found "
                 "[5,5,2]");
  EXPECT_EQ(error(R"("k": [5, 0, 2, 2], "kSize": [4, 4])"),
            at + "/k: expected [fx, fy, cx, cy], fx and fy above 0, and perhaps the skew, found "
                 "[5,0,2,2]");
  EXPECT_EQ(error(R"("k": [5, 5, "x", 2])").substr(0, at.size() + 5), at + "/k/2:");
  EXPECT_EQ(error(R"("k": [5, 5, 2, 2])"), at + ": expected a member \"kSize\"");
  EXPECT_EQ(error(R"("k": [5, 5, 2, 2], "kSize": [4])"),
            at + "/kSize: expected the [width, height] of the picture that k is for, found [4]");
  EXPECT_EQ(error(R"("k": [5, 5, 2, 2], "kSize": [0, 4])").substr(0, at.size() + 9),
            at + "/kSize/0:");
  EXPECT_EQ(
      error(
          R"("projection": "fisheye", "k": [5, 5, 2, 2], "kSize": [4, 4], "distortion": [0, 0, 0, 0, 1])"),
      at + "/distortion: expected at most 4 coefficients, found [0,0,0,0,1]");
  EXPECT_EQ(error(R"("distortion": [0.1], "orthographicHeight": 2)"),
            at + ": expected no orthographicHeight beside k or distortion, found an object of 4");

  // Tables of directions, and fisheyes.
  EXPECT_EQ(
      error(R"("projection": "directions", "azimuths": [1])"),
      at + ": expected azimuths of the columns and elevations of the rows, found an object of 4");
  EXPECT_EQ(
      error(R"("projection": "directions", "azimuths": [], "elevations": [1])"),
      at + ": expected azimuths of the columns and elevations of the rows, found an object of 5");
  EXPECT_EQ(error(R"("projection": "fisheye")"), at + ": expected a member \"k\"");
  EXPECT_EQ(error(R"("projection": "directions", "azimuths": [0], "elevations": [91])")
                .substr(0, at.size() + 13),
            at + "/elevations/0");

  // Members of other projections are unknown, except fov.
  for (const char* member : {"\"aperture\": 1", "\"orthographicHeight\": 1", "\"k\": [1, 1, 0, 0]",
                             "\"azimuths\": [1]"}) {
    EXPECT_TRUE(hasText(error(std::string(R"("projection": "panorama", )") + member), "unknown"));
  }
}

// A fov that does nothing is told, so that --set may change the projection of any camera alone.
TEST_F(SceneSections, FovsThatDoNothingAreTold) {
  const char* const kUnused =
      "fov of a camera with k, orthographicHeight or another projection does nothing";
  const auto toldOf = [&](const std::string& members) {
    Warnings warnings;
    const std::string camera = "\"cameras\": {\"a\": {\"eye\": [0,0,9], \"at\": [0,0,5]" + members;
    const std::string file = save("s.json", "{\"whit\": 1, \"scene\": [], " + camera + "}}}");
    const Json described = describe(loadScene(file, options_, warnings).cameras.at(0));
    const auto entries = warnings.entries();
    const auto told = entries.find(kUnused);
    EXPECT_EQ(described.contains("fov"), told == entries.end()) << members;
    return told == entries.end() ? "" : told->second.first;
  };

  EXPECT_EQ(toldOf(R"(, "fov": 40)"), "");
  EXPECT_EQ(toldOf(R"(, "fov": 40, "orthographicHeight": 0)"), "");
  EXPECT_EQ(toldOf(R"(, "projection": "perspective")"), "");
  for (const char* other : {R"("projection": "panorama")", R"("orthographicHeight": 2)",
                            R"("k": [5, 5, 2, 2], "kSize": [4, 4])"}) {
    EXPECT_TRUE(hasText(toldOf(std::string(", \"fov\": 40, ") + other), "s.json#/cameras/a/fov"))
        << other;
  }
}

TEST_F(SceneSections, OptionsOfThePicture) {
  const SceneDescription scene = loadMembers(
      R"("parameters": {"n": 4}, "options": {"indirect": "$n", "exposure": "auto", "cutoff": 1e-3,
         "adaptive": true, "fresnel": "schlick", "background": "ff8000"})");

  const std::map<std::string, std::string> expected{
      {"indirect", "4"},  {"exposure", "auto"},   {"cutoff", "0.001"},
      {"adaptive", "on"}, {"fresnel", "schlick"}, {"background", "ff8000"}};
  EXPECT_EQ(scene.options, expected);
  EXPECT_TRUE(loadMembers("\"scene\": []").options.empty());
}

TEST_F(SceneSections, OptionsThatAreNone) {
  const auto error = [&](const std::string& member) {
    return errorOfMembers("\"options\": {" + member + "}");
  };

  EXPECT_EQ(error("\"indirct\": 4"),
            "3 s.json#/options/indirct: expected an option of the picture (is \"indirect\" "
            "meant?), found \"indirct\"");
  EXPECT_EQ(error("\"threads\": 4"),
            "3 s.json#/options/threads: expected an option of the picture, found \"threads\"");

  // Values are checked like those of the command line.
  EXPECT_EQ(error("\"indirect\": 65"),
            "3 s.json#/options/indirect: expected a whole number from 0 to 64, found '65'");
  EXPECT_EQ(error("\"fresnel\": \"shlick\""),
            "3 s.json#/options/fresnel: expected one of exact|schlick, found 'shlick'; did you "
            "mean 'schlick'?");
  EXPECT_EQ(error("\"disable\": \"mirrr\""),
            "3 s.json#/options/disable: no effect is called 'mirrr'; did you mean 'mirror'?");
  EXPECT_EQ(error("\"spp\": [4]"),
            "3 s.json#/options/spp: expected a number, a word, true or false, found [4]");
  EXPECT_EQ(errorOfMembers("\"options\": 4"), "3 s.json#/options: expected an object, found 4");
}

TEST_F(SceneSections, KeyframesRepeatWhatIsMissing) {
  const SceneDescription scene = loadMembers(
      "\"path\": [{\"time\": 0, \"eye\": [0,0,5], \"at\": [0,0,0], \"fov\": 30},"
      "{\"time\": 2, \"eye\": [0,0,7]}, {\"time\": 3, \"fov\": 50}]");

  ASSERT_EQ(scene.cameraPath.size(), 3u);
  EXPECT_EQ(scene.cameraPath[1].camera.eye, Vec3f(0, 0, 7));
  EXPECT_EQ(scene.cameraPath[1].camera.fov, 30);
  EXPECT_EQ(scene.cameraPath[2].camera.eye, Vec3f(0, 0, 7));
  EXPECT_EQ(scene.cameraPath[2].camera.fov, 50);
  EXPECT_EQ(scene.cameraPath[2].time, 3);
}

TEST_F(SceneSections, Lights) {
  const SceneDescription scene = loadMembers(
      "\"lights\": [{\"position\": [1,2,3], \"intensity\": 7},"
      "{\"name\": \"key\", \"position\": [0,0,0], \"intensity\": [1,2,3], \"radius\": 0.5}]");

  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].intensity, Rgb(7, 7, 7));
  EXPECT_EQ(scene.lights[0].position, Vec3f(1, 2, 3));

  EXPECT_EQ(scene.lights[1].name, "key");
  EXPECT_EQ(scene.lights[1].intensity, Rgb(1, 2, 3));
  EXPECT_EQ(scene.lights[1].radius, 0.5f);
}

TEST_F(SceneSections, SpotAndDirectionalLights) {
  const SceneDescription scene = loadMembers(
      "\"lights\": [{\"type\": \"spot\", \"position\": [1,2,3], \"direction\": [0,-2,0], "
      "\"intensity\": 7, \"innerConeAngle\": 10, \"outerConeAngle\": 20},"
      "{\"type\": \"directional\", \"direction\": [1,0,0], \"irradiance\": [1,2,3]},"
      "{\"type\": \"point\", \"position\": [0,0,0], \"intensity\": 1}]");

  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].kind, Light::Kind::spot);
  EXPECT_EQ(scene.lights[0].direction, Vec3f(0, -2, 0));
  EXPECT_EQ(scene.lights[0].innerConeAngle, 10);
  EXPECT_EQ(scene.lights[0].outerConeAngle, 20);

  EXPECT_EQ(scene.lights[1].kind, Light::Kind::directional);
  EXPECT_EQ(scene.lights[1].intensity, Rgb(1, 2, 3));
  EXPECT_EQ(scene.lights[2].kind, Light::Kind::point);
}

TEST_F(SceneSections, LightsThatAreNone) {
  const std::string spot = "\"type\": \"spot\", \"position\": [0,0,0], \"intensity\": 1";
  for (const auto& [light, where] : std::vector<std::pair<std::string, std::string>>{
           {"\"type\": \"spots\", \"position\": [0,0,0], \"intensity\": 1", "/lights/0/type"},
           {spot, "\"direction\""},
           {spot + ", \"direction\": [0,0,0]", "/lights/0/direction"},
           {spot + ", \"direction\": [0,1,0], \"innerConeAngle\": 50", "below the outerConeAngle"},
           {spot + ", \"direction\": [0,1,0], \"outerConeAngle\": 91", "/outerConeAngle"},
           {"\"type\": \"directional\", \"direction\": [0,1,0], \"intensity\": 1",
            "\"irradiance\""},
           {"\"position\": [0,0,0], \"intensity\": 1, \"direction\": [0,1,0]", "/direction"}}) {
    const std::string error = errorOfMembers("\"lights\": [{" + light + "}]");
    EXPECT_TRUE(hasText(error, where)) << " lacks " << where;
  }
}

TEST_F(SceneSections, SkyOfOneColorAndAmbientFromIt) {
  const SceneDescription scene = loadMembers(
      "\"sky\": {\"color\": [1,2,4], \"scale\": 0.5}, \"ambient\": {\"fromSky\": 0.25, "
      "\"occlusion\": 2}");
  EXPECT_EQ(scene.sky.kind, Sky::Kind::color);
  EXPECT_EQ(scene.sky.zenith, Rgb(1, 2, 4));

  // The mean of a constant sky is its color, of which 0.5 * 0.25 is left. The quadrature is in
  // float.
  constexpr float kQuadrature = 1e-3f;
  EXPECT_NEAR(scene.ambient.up.x, 0.125f, kQuadrature);
  EXPECT_NEAR(scene.ambient.down.z, 0.5f, kQuadrature);
  EXPECT_EQ(scene.ambient.occlusion, 2);
}

TEST_F(SceneSections, AmbientMembersMayStandAlone) {
  const SceneDescription dull =
      loadMembers("\"sky\": {\"color\": 1}, \"ambient\": {\"reflection\": 0}");
  EXPECT_EQ(dull.ambient.reflection, 0);
  EXPECT_EQ(dull.ambient.up, Rgb(0.0f));
  EXPECT_EQ(loadMembers("\"ambient\": {\"occlusion\": 1}").ambient.occlusion, 1);
  EXPECT_TRUE(hasText(errorOfMembers("\"ambient\": {}"), "#/ambient: expected"));
}

TEST_F(SceneSections, TheStudioIsAPreset) {
  const SceneDescription scene =
      loadMembers("\"sky\": {\"preset\": \"studio\", \"scale\": 2, \"rotation\": 30}");
  EXPECT_EQ(scene.sky.name, kStudio);
  EXPECT_EQ(scene.sky.image.r, studioSky().image.r);
  EXPECT_EQ(scene.sky.scale, 2);
  EXPECT_EQ(scene.sky.rotation, 30);
  EXPECT_TRUE(hasText(errorOfMembers("\"sky\": {\"preset\": \"stadium\"}"), "#/sky/preset"));
}

TEST_F(SceneSections, SkyGradientAndImage) {
  const SceneDescription gradient = loadMembers(
      "\"sky\": {\"zenith\": 1, \"horizon\": 2, \"ground\": 3}, \"ambient\": {\"up\": 1, \"down\": "
      "[0,0.5,0]}");

  EXPECT_EQ(gradient.sky.kind, Sky::Kind::gradient);
  EXPECT_EQ(gradient.sky.horizon, Rgb(2, 2, 2));
  EXPECT_EQ(gradient.ambient.down, Rgb(0, 0.5f, 0));

  save("sky.tga", tga(2, 1, {{255, 0, 0}, {0, 0, 255}}));
  const SceneDescription image = loadMembers("\"sky\": {\"image\": \"sky.tga\", \"rotation\": 90}");
  EXPECT_EQ(image.sky.kind, Sky::Kind::image);
  EXPECT_EQ(image.sky.rotation, 90);
  ASSERT_EQ(image.sky.image.width, 2);
  EXPECT_EQ(image.sky.image.r[0], 1);
  EXPECT_EQ(image.sky.image.b[1], 1);

  EXPECT_EQ(errorOfMembers("\"sky\": {\"zenith\": 1, \"ground\": 3}"),
            "3 s.json#/sky: expected a member \"horizon\"");
  EXPECT_EQ(errorOfMembers("\"ambient\": {\"color\": 1, \"occlusion\": -1}"),
            "3 s.json#/ambient/occlusion: expected a number from 0 to 1e+18, found -1");
  EXPECT_EQ(errorOfMembers("\"ambient\": {\"fromSky\": 1}"),
            "3 s.json#/ambient/fromSky: expected a scene with a sky, found 1");
}

TEST_F(SceneSections, MaterialsAndTheirDefaults) {
  const SceneDescription scene = loadMembers(
      "\"materials\": {\"plain\": {\"diffuse\": 0.25, \"diffuseReflection\": false},"
      "\"glass\": {\"transmission\": 0.9, \"ior\": 1.33, \"absorption\": [0,1,2], \"priority\": 2},"
      "\"shadowGlass\": {\"transmission\": 0.9, \"castsShadow\": true},"
      "\"mirror\": {\"mirror\": [0.5,0.25,0.125], \"roughness\": 0.1, \"specular\": 0.5},"
      "\"coat\": {\"mirror\": 0.1, \"mirrorGrazing\": 1, \"emission\": [3,2,1]},"
      "\"both\": {\"mirror\": 0.1, \"specular\": 0.5, \"glossyReflection\": true},"
      "\"dull\": {\"specular\": 0.5, \"glossyReflection\": false}}");
  ASSERT_EQ(scene.materials.size(), 7u);

  const Material &plain = scene.materials[0], &glass = scene.materials[1];
  EXPECT_EQ(plain.name, "plain");
  EXPECT_EQ(plain.diffuse, Rgb(0.25f));
  EXPECT_TRUE(plain.castsShadow);

  EXPECT_EQ(glass.transmission, Rgb(0.9f));
  EXPECT_EQ(glass.ior, 1.33f);
  EXPECT_EQ(glass.absorption, Rgb(0, 1, 2));
  EXPECT_EQ(glass.priority, 2);
  EXPECT_FALSE(glass.castsShadow);

  EXPECT_TRUE(scene.materials[2].castsShadow);
  EXPECT_FALSE(plain.diffuseReflection);
  EXPECT_TRUE(scene.materials[4].diffuseReflection);
  EXPECT_EQ(scene.materials[3].mirrorGrazing, Rgb(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(scene.materials[4].mirrorGrazing, Rgb(1.0f));
  EXPECT_EQ(scene.materials[4].emission, Rgb(3, 2, 1));

  // A material that reflects by a mirror does not sample its lobe unless it says so.
  std::vector<bool> reflections;
  for (const Material& m : scene.materials) reflections.push_back(m.glossyReflection);
  EXPECT_EQ(reflections, (std::vector<bool>{true, false, false, false, false, true, false}));
}

// Materials with maps, or with lobes that only show lights, may send out less than their members
// add up to; they are not reported.
TEST_F(SceneSections, MaterialsOfMoreThanAllLightAreNamed) {
  loadMembers(
      "\"textures\": {\"t\": {\"pattern\": \"checker\"}},"
      "\"materials\": {\"coated\": {\"diffuse\": 0, \"transmission\": 1, \"mirror\": 0.09},"
      "\"mapped\": {\"diffuse\": 1, \"diffuseMap\": \"t\", \"mirror\": 0.5},"
      "\"lit\": {\"diffuse\": 0.1, \"specular\": 0.9, \"mirror\": 0.9}}");

  EXPECT_EQ(kinds(), "");
  loadMembers(
      "\"materials\": {\"m\": {\"specular\": 0.5, \"transmission\": [0.6, 0.7, 0.1],"
      "\"glossyReflection\": true}, \"n\": {\"mirror\": 0.5}}");

  ASSERT_EQ(warnings_.entries().size(), 1u);
  const Warnings::Entry entry = warnings_.entries().begin()->second;
  EXPECT_EQ(entry.count, 2u);
  EXPECT_EQ(entry.first, root_ +
                             "s.json#/materials/m: specular 0.5 + transmission 0.7 + diffuse "
                             "0.8 = 2");
}

TEST_F(SceneSections, TexturesAreReadAsTheMapNeedsAndShared) {
  save("a.tga", tga(1, 1, {{128, 128, 255}}));
  const SceneDescription scene = loadMembers(
      "\"textures\": {\"t\": {\"image\": \"a.tga\", \"wrap\": [\"clamp\", \"mirror\"]},"
      "\"same\": {\"image\": \"a.tga\", \"wrap\": [\"clamp\", \"mirror\"]}},"
      "\"materials\": {\"m\": {\"diffuseMap\": \"t\", \"normalMap\": \"t\"},"
      "\"n\": {\"diffuseMap\": \"same\"}}");
  ASSERT_EQ(scene.textures.size(), 2u);  // the same image and format only once

  const Material& m = scene.materials[0];
  const Texture& color = scene.textures[static_cast<std::size_t>(m.diffuseMap)];
  const Texture& data = scene.textures[static_cast<std::size_t>(m.normalMap)];
  EXPECT_EQ(color.format, TexelFormat::color);
  EXPECT_EQ(color.wrapU, Wrap::clamp);
  EXPECT_EQ(color.wrapV, Wrap::mirror);
  EXPECT_EQ(data.format, TexelFormat::data);
  EXPECT_EQ(data.texels[0] & 0xffffffu, 0xff8080u);
  EXPECT_EQ(scene.materials[1].diffuseMap, m.diffuseMap);
}

TEST_F(SceneSections, ColorsOfPatternsMayBeNumbers) {
  const auto texelsOf = [&](const std::string& color) {
    return loadMembers("\"textures\": {\"c\": {\"pattern\": \"checker\", \"color\": " + color +
                       "}}, \"materials\": {\"m\": {\"diffuseMap\": \"c\"}}, \"scene\": ["
                       "{\"shape\": \"quad\", \"material\": \"m\"}]")
        .textures.at(0)
        .rows();
  };
  EXPECT_EQ(texelsOf("0.5"), texelsOf("[0.5, 0.5, 0.5]"));
  EXPECT_NE(texelsOf("0.5"), texelsOf("1"));
}

// Digests tell patterns apart by their recipes.
TEST_F(SceneSections, RecipesOfPatternsHoldTheValuesOfParameters) {
  const auto recipeOf = [&](const std::string& count, const std::string& parameter) {
    return loadMembers("\"parameters\": {\"n\": " + parameter +
                       "}, \"textures\": {\"c\": {\"pattern\": \"stripes\", \"count\": " + count +
                       "}}, \"materials\": {\"m\": {\"diffuseMap\": \"c\"}}, \"scene\": ["
                       "{\"shape\": \"quad\", \"material\": \"m\"}]")
        .textures.at(0)
        .shared->recipe;
  };
  EXPECT_EQ(recipeOf("\"$n\"", "3"), recipeOf("3", "4"));
  EXPECT_NE(recipeOf("\"$n\"", "3"), recipeOf("\"$n\"", "4"));
}

TEST_F(SceneSections, PatternsAndTheirErrors) {
  const SceneDescription scene = loadMembers(
      "\"textures\": {\"c\": {\"pattern\": \"checker\", \"columns\": 4, \"size\": 16}},"
      "\"materials\": {\"m\": {\"diffuseMap\": \"c\"}}");
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].width, 16);

  EXPECT_EQ(errorOfMembers("\"textures\": {\"c\": {\"pattern\": \"checker\", \"collumns\": 4}}"),
            "3 s.json#/textures/c/collumns: unknown key (is \"columns\" meant?)");
  EXPECT_EQ(errorOfMembers("\"textures\": {\"c\": {\"pattern\": \"checker\"}},"
                           "\"materials\": {\"m\": {\"normalMap\": \"c\"}}"),
            "3 s.json#/materials/m/normalMap: expected a texture that is read as data (this one is "
            "color), found \"c\"");
  EXPECT_EQ(errorOfMembers("\"textures\": {\"cc\": {\"pattern\": \"checker\"}},"
                           "\"materials\": {\"m\": {\"diffuseMap\": \"cd\"}}"),
            "3 s.json#/materials/m/diffuseMap: expected the name of a texture (is \"cc\" meant?), "
            "found \"cd\"");
}

TEST_F(SceneSections, ImagesThatAreNotThereAreErrors) {
  const std::string error = errorOfMembers("\"textures\": {\"t\": {\"image\": \"none.png\"}}");
  EXPECT_EQ(error.substr(0, 2), "4 ") << error;
  EXPECT_TRUE(hasText(error, "none.png"));
}

TEST_F(SceneSections, ParametersStandForNumbers) {
  const std::string members =
      "\"parameters\": {\"n\": 10, \"w\": 3}, \"size\": [\"$n*2\", \"$w/2\"],"
      "\"materials\": {\"m\": {\"roughness\": \"$n/100\"}}";
  const SceneDescription own = loadMembers(members);
  EXPECT_EQ(own.width, 20);
  EXPECT_EQ(own.height, 2);  // the nearest to 1.5, halves away from 0
  EXPECT_EQ(own.materials[0].roughness, 0.1f);

  const SceneDescription given = loadMembers(members, "?n=50&w=8");
  EXPECT_EQ(given.width, 100);
  EXPECT_EQ(given.height, 4);
  EXPECT_EQ(given.materials[0].roughness, 0.5f);
}

}  // namespace
}  // namespace whit
