// Cameras, lights, sky, materials and textures of scene files.
#include <clocale>
#include <cstdlib>

#include "make/studio_sky.h"
#include "noun_members.h"

namespace whit {
namespace {

class SceneSections : public SceneFileTest {
 protected:
  // A camera with these further members, of which each begins with a comma.
  static std::string cameraWith(const std::string& members) {
    return "'cameras': {'a': {'eye': [0,0,9], 'at': [0,0,5]" + members + "}}";
  }
  Camera loadCamera(const std::string& members) {
    return loadMembers(cameraWith(members)).cameras.at(0);
  }
};

TEST_F(SceneSections, DefaultsOfAnEmptyScene) {
  const SceneDescription scene = loadMembers("'scene': []");
  EXPECT_EQ(scene.width, 480);
  EXPECT_EQ(scene.height, 300);
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_TRUE(scene.objects.empty());
  EXPECT_TRUE(scene.options.empty());
  EXPECT_EQ(scene.sky.kind, Sky::Kind::none);
}

TEST_F(SceneSections, CamerasKeepTheFilesOrder) {
  const SceneDescription scene = loadMembers(
      "'cameras': {'z': {'eye': [1,2,3], 'at': [0,0,0], 'fov': 60}, "
      "'a': {'eye': [0,0,9], 'at': [0,0,0], 'up': [1,0,0]}}");

  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "z");
  expectExactly(scene.cameras[0], "{'eye': [1,2,3], 'fov': 60}");
  EXPECT_EQ(scene.cameras[1].name, "a");
  expectExactly(scene.cameras[1], "{'up': [1,0,0], 'fov': 45}");
}

TEST_F(SceneSections, CamerasHaveALens) {
  const Camera lens = loadCamera(", 'aperture': 0.25, 'focus': 3"), plain = loadCamera("");
  EXPECT_EQ(lens.aperture, 0.25f);
  EXPECT_EQ(lens.focusDistance(), 3);
  EXPECT_EQ(plain.aperture, 0);
  EXPECT_EQ(plain.focusDistance(), 4);

  expectErrorsOfMembers({{cameraWith(", 'aperture': -1"), "*/cameras/a/aperture*"},
                         {cameraWith(", 'focus': -1"), "*/cameras/a/focus*"}});
}

TEST_F(SceneSections, CamerasHaveAProjection) {
  // What the file says, and what follows from it.
  const std::pair<std::string, std::string> cameras[] = {
      {"'k': [500, 510, 320, 240, 1.5], 'kSize': [640, 480], 'distortion': [-0.1, 0.02]",
       "'projection': 'perspective'"},
      {"'projection': 'equisolid', 'angle': 220", "'k': []"},
      {"'projection': 'equidistant'", "'angle': 180"},
      {"'projection': 'directions', 'azimuths': [-5, 0, 5], 'elevations': [2, -2]",
       "'stereo': 'none'"},
      {"'projection': 'panorama', 'stereo': 'topBottom'", "'eyeDistance': 0.065"},
  };
  for (const auto& [said, rest] : cameras) {
    expectExactly(loadCamera(", " + said), "{" + said + ", " + rest + "}");
  }
}

TEST_F(SceneSections, CamerasThatImageNothing) {
  const auto error = [&](const std::string& members) {
    return replaced(errorOfMembers(cameraWith(", " + members)), "3 s.json#/cameras/a", "");
  };
  expectErrors(
      error,
      {
          {"'projection': 'panoramic'",
           "/projection: expected one of \"perspective\", \"equidistant\", \"equisolid\", "
           "\"fisheye\", \"panorama\", \"directions\", \"cubeMap\" (is \"panorama\" meant?), "
           "found \"panoramic\""},

          // The intrinsic matrix and the distortion of a lens.
          {"'k': [5, 5, 2], 'kSize': [4, 4]",
           "/k: expected [fx, fy, cx, cy], fx and fy above 0, and perhaps the skew, found [5,5,2]"},
          {"'k': [5, 0, 2, 2], 'kSize': [4, 4]",
           "/k: expected [fx, fy, cx, cy], fx and fy above 0, and perhaps the skew, found "
           "[5,0,2,2]"},
          {"'k': [5, 5, 'x', 2]", "/k/2:*"},
          {"'k': [5, 5, 2, 2]", ": expected a member \"kSize\""},
          {"'k': [5, 5, 2, 2], 'kSize': [4]",
           "/kSize: expected the [width, height] of the picture that k is for, found [4]"},
          {"'k': [5, 5, 2, 2], 'kSize': [0, 4]", "/kSize/0:*"},
          {"'projection': 'fisheye', 'k': [5, 5, 2, 2], 'kSize': [4, 4], "
           "'distortion': [0, 0, 0, 0, 1]",
           "/distortion: expected at most 4 coefficients, found [0,0,0,0,1]"},
          {"'distortion': [0.1], 'orthographicHeight': 2",
           ": expected no orthographicHeight beside k or distortion, found an object of 4"},

          // Tables of directions, and fisheyes.
          {"'projection': 'directions', 'azimuths': [1]",
           ": expected azimuths of the columns and elevations of the rows, found an object of 4"},
          {"'projection': 'directions', 'azimuths': [], 'elevations': [1]",
           ": expected azimuths of the columns and elevations of the rows, found an object of 5"},
          {"'projection': 'fisheye'", ": expected a member \"k\""},
          {"'projection': 'directions', 'azimuths': [0], 'elevations': [91]", "/elevations/0*"},

          // Members of other projections are unknown, except fov.
          {"'projection': 'panorama', 'aperture': 1", "*unknown*"},
          {"'projection': 'panorama', 'orthographicHeight': 1", "*unknown*"},
          {"'projection': 'panorama', 'k': [1, 1, 0, 0]", "*unknown*"},
          {"'projection': 'panorama', 'azimuths': [1]", "*unknown*"},
      });
}

// A fov that does nothing is told, so that --set may change the projection of any camera alone.
TEST_F(SceneSections, FovsThatDoNothingAreTold) {
  const char* const kUnused =
      "fov of a camera with k, orthographicHeight or another projection does nothing";
  const std::pair<const char*, bool> cameras[] = {
      {", 'fov': 40", true},
      {", 'fov': 40, 'orthographicHeight': 0", true},
      {", 'projection': 'perspective'", true},
      {", 'fov': 40, 'projection': 'panorama'", false},
      {", 'fov': 40, 'orthographicHeight': 2", false},
      {", 'fov': 40, 'k': [5, 5, 2, 2], 'kSize': [4, 4]", false}};

  std::uint64_t count = 0;
  for (const auto& [members, isUsed] : cameras) {
    SCOPED_TRACE(members);
    EXPECT_EQ(describe(loadCamera(members)).contains("fov"), isUsed);
    expectWarned(kUnused, count += isUsed ? 0 : 1);
  }
  expectLike(warnings_.entries().at(kUnused).first, "*s.json#/cameras/a/fov*");
}

TEST_F(SceneSections, OptionsOfThePicture) {
  const SceneDescription scene = loadMembers(
      "'parameters': {'n': 4}, 'options': {'indirect': '$n', 'exposure': 'auto', 'cutoff': 1e-3, "
      "'adaptive': true, 'fresnel': 'schlick', 'background': 'ff8000'}");

  const std::map<std::string, std::string> expected{
      {"indirect", "4"},  {"exposure", "auto"},   {"cutoff", "0.001"},
      {"adaptive", "on"}, {"fresnel", "schlick"}, {"background", "ff8000"}};
  EXPECT_EQ(scene.options, expected);
}

TEST_F(SceneSections, OptionsThatAreNone) {
  const auto error = [&](const std::string& member) {
    return errorOfMembers("'options': {" + member + "}");
  };

  expectErrors(
      error,
      {
          {"'indirct': 4",
           "3 s.json#/options/indirct: expected an option of the picture (is \"indirect\" meant?), "
           "found \"indirct\""},
          {"'threads': 4",
           "3 s.json#/options/threads: expected an option of the picture, found \"threads\""},

          // Values are checked like those of the command line.
          {"'indirect': 65",
           "3 s.json#/options/indirect: expected a whole number from 0 to 64, found '65'"},
          {"'fresnel': 'shlick'",
           "3 s.json#/options/fresnel: expected one of exact|schlick, found 'shlick'; did you mean "
           "'schlick'?"},
          {"'disable': 'mirrr'",
           "3 s.json#/options/disable: no effect is called 'mirrr'; did you mean 'mirror'?"},
          {"'spp': [4]",
           "3 s.json#/options/spp: expected a number, a word, true or false, found [4]"},
      });
  EXPECT_EQ(errorOfMembers("'options': 4"), "3 s.json#/options: expected an object, found 4");
}

TEST_F(SceneSections, KeyframesRepeatWhatIsMissing) {
  const SceneDescription scene = loadMembers(
      "'path': [{'time': 0, 'eye': [0,0,5], 'at': [0,0,0], 'fov': 30},{'time': 2, 'eye': [0,0,7]}, "
      "{'time': 3, 'fov': 50}]");

  ASSERT_EQ(scene.cameraPath.size(), 3u);
  expectExactly(scene.cameraPath[1].camera, "{'eye': [0,0,7], 'fov': 30}");
  expectExactly(scene.cameraPath[2].camera, "{'eye': [0,0,7], 'fov': 50}");
  EXPECT_EQ(scene.cameraPath[2].time, 3);
}

TEST_F(SceneSections, LightsOfEveryType) {
  const SceneDescription scene = loadMembers(
      "'lights': [{'position': [1,2,3], 'intensity': 7}, "
      "{'name': 'key', 'type': 'point', 'position': [0,0,0], 'intensity': [1,2,3], 'radius': 0.5}, "
      "{'type': 'spot', 'position': [1,2,3], 'direction': [0,-2,0], 'intensity': 7, "
      "'innerConeAngle': 10, 'outerConeAngle': 20}, "
      "{'type': 'directional', 'direction': [1,0,0], 'irradiance': [1,2,3]}]");

  ASSERT_EQ(scene.lights.size(), 4u);
  expectExactly(scene.lights[0], "{'type': 'point', 'intensity': 7, 'position': [1,2,3]}");
  expectExactly(scene.lights[1], "{'type': 'point', 'intensity': [1,2,3], 'radius': 0.5}");
  EXPECT_EQ(scene.lights[1].name, "key");
  expectExactly(scene.lights[2],
                "{'type': 'spot', 'direction': [0,-2,0], 'innerConeAngle': 10, "
                "'outerConeAngle': 20}");
  expectExactly(scene.lights[3], "{'type': 'directional', 'irradiance': [1,2,3]}");
}

TEST_F(SceneSections, LightsThatAreNone) {
  const auto error = [&](const std::string& light) {
    return errorOfMembers("'lights': [{" + light + "}]");
  };
  const std::string spot = "'type': 'spot', 'position': [0,0,0], 'intensity': 1";
  expectErrors(
      error,
      {
          {"'type': 'spots', 'position': [0,0,0], 'intensity': 1", "*/lights/0/type*"},
          {spot, "*\"direction\"*"},
          {spot + ", 'direction': [0,0,0]", "*/lights/0/direction*"},
          {spot + ", 'direction': [0,1,0], 'innerConeAngle': 50", "*below the outerConeAngle*"},
          {spot + ", 'direction': [0,1,0], 'outerConeAngle': 91", "*/outerConeAngle*"},
          {"'type': 'directional', 'direction': [0,1,0], 'intensity': 1", "*\"irradiance\"*"},
          {"'position': [0,0,0], 'intensity': 1, 'direction': [0,1,0]", "*/direction*"},
      });
}

TEST_F(SceneSections, SkyOfOneColorAndAmbientFromIt) {
  const SceneDescription scene = loadMembers(
      "'sky': {'color': [1,2,4], 'scale': 0.5}, 'ambient': {'fromSky': 0.25, 'occlusion': 2}");
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
  const SceneDescription dull = loadMembers("'sky': {'color': 1}, 'ambient': {'reflection': 0}");
  EXPECT_EQ(dull.ambient.reflection, 0);
  EXPECT_EQ(dull.ambient.up, Rgb(0.0f));
  EXPECT_EQ(loadMembers("'ambient': {'occlusion': 1}").ambient.occlusion, 1);
  expectLike(errorOfMembers("'ambient': {}"), "*#/ambient: expected*");
}

TEST_F(SceneSections, TheStudioIsAPreset) {
  const SceneDescription scene =
      loadMembers("'sky': {'preset': 'studio', 'scale': 2, 'rotation': 30}");
  EXPECT_EQ(scene.sky.name, kStudio);
  EXPECT_EQ(scene.sky.image.r, studioSky().image.r);
  expectExactly(scene.sky, "{'scale': 2, 'rotation': 30}");
  expectLike(errorOfMembers("'sky': {'preset': 'stadium'}"), "*#/sky/preset*");
}

TEST_F(SceneSections, SkyGradientAndImage) {
  const SceneDescription gradient = loadMembers(
      "'sky': {'zenith': 1, 'horizon': 2, 'ground': 3}, 'ambient': {'up': 1, 'down': [0,0.5,0]}");

  EXPECT_EQ(gradient.sky.kind, Sky::Kind::gradient);
  EXPECT_EQ(gradient.sky.horizon, Rgb(2, 2, 2));
  EXPECT_EQ(gradient.ambient.down, Rgb(0, 0.5f, 0));

  saveImage("sky.tga", {"ff0000", "0000ff"});
  const SceneDescription image = loadMembers("'sky': {'image': 'sky.tga', 'rotation': 90}");
  EXPECT_EQ(image.sky.kind, Sky::Kind::image);
  EXPECT_EQ(image.sky.rotation, 90);
  ASSERT_EQ(image.sky.image.width, 2);
  EXPECT_EQ(image.sky.image.r[0], 1);
  EXPECT_EQ(image.sky.image.b[1], 1);

  expectErrorsOfMembers({
      {"'sky': {'zenith': 1, 'ground': 3}", "3 s.json#/sky: expected a member \"horizon\""},
      {"'ambient': {'color': 1, 'occlusion': -1}",
       "3 s.json#/ambient/occlusion: expected a number from 0 to 1e+18, found -1"},
      {"'ambient': {'fromSky': 1}",
       "3 s.json#/ambient/fromSky: expected a scene with a sky, found 1"},
  });
}

TEST_F(SceneSections, MaterialsAndTheirDefaults) {
  const SceneDescription scene = loadMembers(
      "'materials': {'plain': {'diffuse': 0.25, 'diffuseReflection': false},'glass': "
      "{'transmission': 0.9, 'ior': 1.33, 'absorption': [0,1,2], 'priority': 2},'shadowGlass': "
      "{'transmission': 0.9, 'castsShadow': true},'mirror': {'mirror': [0.5,0.25,0.125], "
      "'roughness': 0.1, 'specular': 0.5},'coat': {'mirror': 0.1, 'mirrorGrazing': 1, 'emission': "
      "[3,2,1]},'both': {'mirror': 0.1, 'specular': 0.5, 'glossyReflection': true},'dull': "
      "{'specular': 0.5, 'glossyReflection': false}}");

  const char* const expected[] = {
      ("{'diffuse': 0.25, 'castsShadow': true, 'diffuseReflection': false, "
       "'glossyReflection': true}"),
      ("{'transmission': 0.9, 'ior': 1.33, 'absorption': [0,1,2], 'priority': 2, "
       "'castsShadow': false, 'glossyReflection': false}"),
      "{'castsShadow': true, 'glossyReflection': false}",
      // A material that reflects by a mirror does not sample its lobe unless it says so.
      "{'mirrorGrazing': [0.5,0.25,0.125], 'glossyReflection': false}",
      ("{'mirrorGrazing': 1, 'emission': [3,2,1], 'diffuseReflection': true, "
       "'glossyReflection': false}"),
      "{'glossyReflection': true}",
      "{'glossyReflection': false}",
  };

  ASSERT_EQ(scene.materials.size(), std::size(expected));
  for (const auto i : indices(expected)) {
    SCOPED_TRACE(scene.materials[i].name);
    expectExactly(scene.materials[i], expected[i]);
  }
  EXPECT_EQ(scene.materials[0].name, "plain");
}

// Materials with maps, or with lobes that only show lights, may send out less than their members
// add up to; they are not reported.
TEST_F(SceneSections, MaterialsOfMoreThanAllLightAreNamed) {
  loadMembers(
      "'textures': {'t': {'pattern': 'checker'}},'materials': {'coated': {'diffuse': 0, "
      "'transmission': 1, 'mirror': 0.09},'mapped': {'diffuse': 1, 'diffuseMap': 't', 'mirror': "
      "0.5},'lit': {'diffuse': 0.1, 'specular': 0.9, 'mirror': 0.9}}");

  expectNoWarnings();
  loadMembers(
      "'materials': {'m': {'specular': 0.5, 'transmission': [0.6, 0.7, 0.1],'glossyReflection': "
      "true}, 'n': {'mirror': 0.5}}");

  ASSERT_EQ(warnings_.entries().size(), 1u);
  const Warnings::Entry entry = warnings_.entries().begin()->second;
  EXPECT_EQ(entry.count, 2u);
  EXPECT_EQ(entry.first,
            root_ + "s.json#/materials/m: specular 0.5 + transmission 0.7 + diffuse 0.8 = 2");
}

TEST_F(SceneSections, TexturesAreReadAsTheMapNeedsAndShared) {
  saveImage("a.tga", {"8080ff"});
  const SceneDescription scene = loadMembers(
      "'textures': {'t': {'image': 'a.tga', 'wrap': ['clamp', 'mirror']}, 'same': {'image': "
      "'a.tga', 'wrap': ['clamp', 'mirror']}, 'data': {'image': 'a.tga', 'wrap': ['clamp', "
      "'mirror'], 'as': 'data'}}, 'materials': {'m': {'diffuseMap': 't', 'normalMap': 't'}, 'n': "
      "{'diffuseMap': 'same', 'roughnessMap': 'data'}}");
  ASSERT_EQ(scene.textures.size(), 2u);  // the same image and format only once

  const Material& m = scene.materials[0];
  const Texture &color = textureOf(scene, m.diffuseMap), &data = textureOf(scene, m.normalMap);
  EXPECT_EQ(color.format, TexelFormat::color);
  EXPECT_EQ(color.wrapU, Wrap::clamp);
  EXPECT_EQ(color.wrapV, Wrap::mirror);
  EXPECT_EQ(data.format, TexelFormat::data);
  EXPECT_EQ(data.texels[0] & 0xffffffu, 0xff8080u);
  EXPECT_EQ(scene.materials[1].diffuseMap, m.diffuseMap);
}

TEST_F(SceneSections, ColorsOfPatternsMayBeNumbers) {
  const auto texelsOf = [&](const std::string& color) {
    return loadMembers("'textures': {'c': {'pattern': 'checker', 'color': " + color +
                       "}}, 'materials': {'m': {'diffuseMap': 'c'}}, 'scene': [{'shape': 'quad', "
                       "'material': 'm'}]")
        .textures.at(0)
        .rows();
  };
  EXPECT_EQ(texelsOf("0.5"), texelsOf("[0.5, 0.5, 0.5]"));
  EXPECT_NE(texelsOf("0.5"), texelsOf("1"));
}

// Digests tell patterns apart by their recipes.
TEST_F(SceneSections, RecipesOfPatternsHoldTheValuesOfParameters) {
  const auto recipeOf = [&](const std::string& count, const std::string& parameter) {
    return loadMembers("'parameters': {'n': " + parameter +
                       "}, 'textures': {'c': {'pattern': 'stripes', 'count': " + count +
                       "}}, 'materials': {'m': {'diffuseMap': 'c'}}, 'scene': [{'shape': 'quad', "
                       "'material': 'm'}]")
        .textures.at(0)
        .shared->recipe;
  };
  EXPECT_EQ(recipeOf("'$n'", "3"), recipeOf("3", "4"));
  EXPECT_NE(recipeOf("'$n'", "3"), recipeOf("'$n'", "4"));
}

TEST_F(SceneSections, PatternsAndTheirErrors) {
  const SceneDescription scene = loadMembers(
      "'textures': {'c': {'pattern': 'checker', 'columns': 4, 'size': 16}},'materials': {'m': "
      "{'diffuseMap': 'c'}}");
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].width, 16);

  expectErrorsOfMembers({
      {"'textures': {'c': {'pattern': 'checker', 'collumns': 4}}",
       "3 s.json#/textures/c/collumns: unknown key (is \"columns\" meant?)"},
      {"'textures': {'c': {'pattern': 'checker'}},'materials': {'m': {'normalMap': 'c'}}",
       "3 s.json#/materials/m/normalMap: expected a texture that is read as data (this one is "
       "color), found \"c\""},
      {"'textures': {'cc': {'pattern': 'checker'}},'materials': {'m': {'diffuseMap': 'cd'}}",
       "3 s.json#/materials/m/diffuseMap: expected the name of a texture (is \"cc\" meant?), found "
       "\"cd\""},
  });
}

TEST_F(SceneSections, ParametersStandForNumbers) {
  const std::string members =
      "'parameters': {'n': 10, 'w': 3}, 'size': ['$n*2', '$w/2'],'materials': {'m': {'roughness': "
      "'$n/100'}}";
  const SceneDescription own = loadMembers(members);
  EXPECT_EQ(own.width, 20);
  EXPECT_EQ(own.height, 2);  // the nearest to 1.5, halves away from 0
  EXPECT_EQ(own.materials[0].roughness, 0.1f);

  const SceneDescription given = loadMembers(members, "?n=50&w=8");
  EXPECT_EQ(given.width, 100);
  EXPECT_EQ(given.height, 4);
  EXPECT_EQ(given.materials[0].roughness, 0.5f);
}

// Numbers have points, also where a program that uses the library writes its own with commas.
TEST_F(SceneSections, NumbersDoNotFollowTheLocale) {
  const std::string make = "localedef -i de_DE -f UTF-8 " + folder_ + "/de_DE.UTF-8 2>/dev/null";
  setenv("LOCPATH", folder_.c_str(), 1);
  const bool isMade = std::system(make.c_str()) == 0 && setlocale(LC_NUMERIC, "de_DE.UTF-8");
  unsetenv("LOCPATH");
  if (!isMade) GTEST_SKIP() << "no German locale can be made: numbers with commas are NOT checked";

  const SceneDescription scene =
      loadMembers("'parameters': {'n': 1}, 'size': ['$n*2.5', 9]", "?n=1.6");
  setlocale(LC_NUMERIC, "C");
  EXPECT_EQ(scene.width, 4);
}

}  // namespace
}  // namespace whit
