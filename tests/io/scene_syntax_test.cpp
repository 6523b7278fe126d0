// Scene files that are wrong, and where the errors point.
#include "has_text.h"
#include "scene_files.h"

namespace whit {
namespace {

using SceneSyntax = SceneFileTest;

TEST_F(SceneSyntax, CommentsAreAllowed) {
  const SceneDescription scene = loadMembers("// one line\n 'size': [3, /* sides */ 2]");
  EXPECT_EQ(scene.width, 3);
  EXPECT_EQ(scene.height, 2);
  EXPECT_EQ(scene.name, "s");
}

TEST_F(SceneSyntax, SyntaxErrorsHaveLineAndColumn) {
  expectErrorsOf("s.json", {
                               {"{\n  'whit': 1,\n  'size' [1, 1]\n}", "3 s.json:3:10*"},
                               {"", "3 s.json:1:1*"},
                               {"{'whit': 1,}", "3 s.json:1:12*"},
                               {"{'whit': 1, 'size': '\xff'}", "3 s.json:1:2*"},
                           });
}

TEST_F(SceneSyntax, NumbersBeyondDoubleHaveTheirPlace) {
  expectErrorsOf(
      "s.json", {
                    {"{'whit': 1e999}", "3 s.json#/whit: expected a number that a double can hold"},
                    {"{'whit': 1, 'lights': [{}, {'position': [0, 1, -1e999]}]}",
                     "3 s.json#/lights/1/position/2: expected a number that a double can hold"},
                });
}

TEST_F(SceneSyntax, TheVersionIsRequired) {
  expectErrorsOf("s.json", {
                               {"{}", "3 s.json#: expected a member \"whit\""},
                               {"[1]", "3 s.json#: expected an object, found [1]"},
                               {"{'whit': 2}", "3 s.json#/whit: expected 1, found 2"},
                           });
}

TEST_F(SceneSyntax, MistakesSayWhatWasExpectedWhere) {
  expectErrorsOfMembers({
      // Keys that are given twice or unknown.
      {"'lights': [{}, {'radius': 1, 'radius': 2}]",
       "3 s.json#/lights/1/radius: this key is given twice"},
      {"'objects': {'a/b~': [], 'a/b~': []}", "3 s.json#/objects/a~1b~0: this key is given twice"},
      {"'sice': [1, 1]", "3 s.json#/sice: unknown key (is \"size\" meant?)"},
      {"'cameras': {'a': {'eye': [0,0,1], 'at': [0,0,0], 'fow': 4}}",
       "3 s.json#/cameras/a/fow: unknown key (is \"fov\" meant?)"},
      {"'scene': [{'shape': 'sphere', 'radiuss': 2}]",
       "3 s.json#/scene/0/radiuss: unknown key (is \"radius\" meant?)"},

      // Needed keys that are missing or misspelt.
      {"'cameras': {'a': {'eye': [0,0,1], 'att': [0,0,0]}}",
       "3 s.json#/cameras/a: expected a member \"at\", there is \"att\""},
      {"'cameras': {'a': {'eye': [0,0,1], 'fov': 30}}",
       "3 s.json#/cameras/a: expected a member \"at\""},

      // Wrong kinds and ranges.
      {"'size': [1]", "3 s.json#/size: expected [width, height], found [1]"},
      {"'size': [1.5, 1]", "3 s.json#/size/0: expected a whole number from 1 to 65536, found 1.5"},

      {"'lights': [{'position': [0, 1, 'x'], 'intensity': 1}]",
       "3 s.json#/lights/0/position/2: expected a number, found \"x\""},
      {"'lights': [{'position': [0, 1, 1e30], 'intensity': 1}]",
       "3 s.json#/lights/0/position/2: expected a number from -1e+18 to 1e+18, found 1e+30"},
      {"'sky': {'radiance': 1, 'scale': -1}",
       "3 s.json#/sky/scale: expected a number from 0 to 1e+18, found -1"},
      {"'sky': {'radiance': 1, 'scale': []}",
       "3 s.json#/sky/scale: expected a number not below 0, found []"},

      {"'materials': {'m': {'diffuse': [1, 2, 0]}}",
       "3 s.json#/materials/m/diffuse/1: expected a number from 0 to 1, found 2"},
      {"'materials': {'m': {'castsShadow': 1}}",
       "3 s.json#/materials/m/castsShadow: expected true or false, found 1"},

      {"'scene': [{'shape': 'spere'}]", "3 s.json#/scene/0/shape: expected one*"},
      {"'scene': [{'shape': 'spere'}]", "*(is \"sphere\" meant?)*"},

      // Cameras and paths that make no sense.
      {"'cameras': {'a': {'eye': [0,0,1], 'at': [0,0,1]}}",
       "3 s.json#/cameras/a: expected eye and at to differ, found an object of 2"},
      {"'cameras': {'a': {'eye': [0,1,0], 'at': [0,0,0]}}",
       "3 s.json#/cameras/a: expected an up that is not along the view, found an object of 2"},
      {"'path': [{'time': 1}, {'time': 1}]",
       "3 s.json#/path/1/time: expected a time after that of the keyframe before, found 1"},
  });
}

// Scene files had British spelling once. An old key is refused, not ignored as if it were missing.
TEST_F(SceneSyntax, OldSpellingsNameTheNewOnes) {
  expectErrorsOfMembers({
      {"'sky': {'colour': 1}", "3 s.json#/sky/colour: unknown key (is \"color\" meant?)"},
      {"'ambient': {'colour': 1}", "3 s.json#/ambient/colour: unknown key (is \"color\" meant?)"},
      {"'textures': {'t': {'image': 't.png', 'as': 'colour'}}", "*(is \"color\" meant?)*"},
      {"'textures': {'t': {'pattern': 'bricks', 'colour2': [1, 0, 0]}}",
       "3 s.json#/textures/t/colour2: unknown key (is \"color2\" meant?)"},
  });
}

TEST_F(SceneSyntax, NestingIsLimited) {
  const std::string deep = std::string(100, '[') + std::string(100, ']');
  const std::string error = errorOfMembers("'scene': " + deep);
  expectLike(error, "*nested deeper than 64 levels*");
  expectLike(error, "3 s.json#/scene/0*");
}

TEST_F(SceneSyntax, MembersAreLimited) {
  std::string many = "'materials': {";
  for (int i = 0; i < 5000; ++i) many += joined("'m", i, "': {},");
  expectLike(errorOfMembers(many + "'z': {}}"), "*more than 4096 members*");
}

TEST_F(SceneSyntax, ParametersAreCheckedWhereTheyAreUsed) {
  const std::string scene = "'parameters': {'count': 3}, 'size': [1, ";
  expectErrorsOfMembers({
      {scene + "'$cuont']",
       "3 s.json#/size/1: expected a number or a parameter (is \"$count\" meant?), found "
       "\"$cuont\""},
      {scene + "'$count*x']",
       "3 s.json#/size/1: expected a parameter such as \"$a\", \"$a*0.5\" or \"$a/2\", found "
       "\"$count*x\""},
      {scene + "'$count/0']",
       "3 s.json#/size/1: expected a number from -1e+18 to 1e+18, found \"$count/0\""},
  });

  EXPECT_EQ(errorOf([&] { loadMembers("'parameters': {'count': 3}", "?cont=1"); }),
            "2 s.json has no parameter 'cont'; did you mean 'count'?");
  EXPECT_EQ(errorOf([&] { loadMembers("'parameters': {'count': 3}", "?count=many"); }).substr(0, 2),
            "2 ");
}

}  // namespace
}  // namespace whit
