// --set: members of a scene's description that are given apart from its file.
#include "io/scene/scene_settings.h"

#include "noun_members.h"
#include "scene/description.h"

namespace whit {
namespace {

constexpr char kMembers[] =
    "'size': [48, 32], 'lights': [{'name': 'lamp', 'position': [3, 6, 4], 'intensity': 60, "
    "'radius': 0.1}], 'materials': {'floor': {'diffuse': 0.5}, 'a/b~c=d': {'mirror': 0.8}}, "
    "'scene': [{'shape': 'quad', 'material': 'floor'}, {'shape': 'box', 'material': 'a/b~c=d'}]";

constexpr char kModel[] =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n";
constexpr char kLibrary[] = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";

class SceneSettings : public SceneFileTest {
 protected:
  SceneDescription with(const std::vector<std::string>& settings,
                        const std::string& members = kMembers) {
    options_.settings = settings;
    return loadMembers(members);
  }

  const ErrorOf errorWith = [this](const std::string& setting) {
    return errorOf([&] { with({setting}); });
  };

  SceneDescription modelWith(const std::vector<std::string>& settings) {
    save("m.mtl", kLibrary);
    options_.settings = settings;
    return loadObj(kModel);
  }
};

TEST_F(SceneSettings, TakeThePlaceOfMembers) {
  const SceneDescription scene =
      with({"/lights/0/intensity=[1, 2, 3]", "/materials/floor={'roughness': 0.25}",
            "/materials/a~1b~0c=d/mirror=0.5", "/size/1=16"});

  // The light keeps its radius, and the whole material is replaced.
  expectExactly(scene.lights[0], "{'intensity': [1,2,3], 'radius': 0.1}");
  expectExactly(scene.materials[0], "{'roughness': 0.25, 'diffuse': 0.8}");
  expectExactly(scene.materials[1], "{'mirror': 0.5}");
  EXPECT_EQ(scene.height, 16);
}

TEST_F(SceneSettings, MakeWhatIsMissing) {
  const SceneDescription scene =
      with({"/sky/color=0.5", "/lights/-={'position': [0, 1, 0], 'intensity': 7}",
            "/cameras/side/eye=[1, 0, 0]", "/cameras/side/at=[0, 0, 0]"});

  EXPECT_EQ(scene.sky.zenith, Rgb(0.5f));
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[1].intensity, Rgb(7));

  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "side");
}

TEST_F(SceneSettings, LaterOnesWin) {
  const SceneDescription scene =
      with({"/materials/floor/diffuse=0.1", "/materials/floor/diffuse=0.2"});
  EXPECT_EQ(scene.materials[0].diffuse, Rgb(0.2f));
}

TEST_F(SceneSettings, ErrorsAreThoseOfTheFile) {
  std::string deep;
  for (int i = 0; i <= kJsonDepthLimit; ++i) deep += "/a";
  expectErrors(
      errorWith,
      {
          {"/materials/floor/diffuse='red'", "3 s.json#/materials/floor/diffuse*"},
          {"/materials/floor/ruffness=1", "3 s.json#/materials/floor/ruffness*"},
          {"/lihgts/0=1", "3 s.json#/lihgts*"},
          {"/sky={'colour': 1}", "3 s.json#/sky/colour: unknown key (is \"color\" meant?)"},
          {"/lights/1/intensity=1",
           "3 s.json#/lights/1: expected an index below 1, or - for a new element, found a list of "
           "1"},
          {"/lights/00/intensity=1", "3 s.json#/lights/00: expected an index*"},
          {"/size/0/x=1", "3 s.json#/size/0: expected an object or a list, found 48"},
          {"/a={'b': 1, 'b': 2}", "3 --set /a#/b: this key is given twice"},
          {deep + "=1", "2 '--set /a/a*"},
      });

  for (const std::string text :
       {"", "/size", "=1", "size=1", "/sky/image=a.hdr", "/~2=1", "/a=[1,]"}) {
    expectErrors(errorWith, {{text, "2 '--set " + text + "': expected POINTER=VALUE*"}});
  }
}

TEST_F(SceneSettings, OfAModel) {
  const SceneDescription plain = modelWith({});
  ASSERT_EQ(plain.lights.size(), 2u);
  const SceneDescription scene =
      modelWith({"/materials/blue/mirror=0.5", "/lights/0/position=[1, 2, 3]", "/sky/color=0.1"});

  expectExactly(scene.materials[0], "{'mirror': 0}");
  expectExactly(scene.materials[1], "{'mirror': 0.5, 'diffuse': [0,0,1]}");
  EXPECT_EQ(scene.lights[0].position, Vec3f(1, 2, 3));
  EXPECT_EQ(scene.lights[0].intensity, plain.lights[0].intensity) << "every bit is kept";
  EXPECT_EQ(scene.lights[0].radius, plain.lights[0].radius);
  EXPECT_EQ(scene.sky.kind, Sky::Kind::color);

  EXPECT_EQ(errorOf([&] { modelWith({"/materials/bleu/mirror=0.5"}); }),
            "3 m.obj#/materials/bleu: unknown material of this model (is \"blue\" meant?)");
  expectLike(errorOf([&] { modelWith({"/camera=1"}); }), "3 m.obj#/camera*");
}

TEST_F(SceneSettings, OptionsOfAModel) {
  std::map<std::string, std::string> expected{
      {"background", "c8c8c8"}, {"exposure", "auto"}, {"terminator", "on"}, {"tonemap", "filmic"}};
  EXPECT_EQ(loadObj(kTriangleObj).options, expected);

  options_.settings = {"/options/exposure=2", "/options/spp=4", "/options/background='sky'"};
  expected["background"] = "sky";
  expected["exposure"] = "2";
  expected["spp"] = "4";
  EXPECT_EQ(loadObj(kTriangleObj).options, expected);
}

TEST_F(SceneSettings, ItemsWithoutAMaterialHaveTheDefaultOne) {
  const char* const members = "'scene': [{'shape': 'quad'}]";
  EXPECT_EQ(with({}, members).materials[0].pointer, "/materials/default");
  const SceneDescription scene = with({"/materials/default/mirror=0.5"}, members);
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].mirror, Rgb(0.5f));
}

// Wherever a material comes from, its pointer leads to it and to no other material.
TEST_F(SceneSettings, PointersLeadToTheirMaterial) {
  save("t.gltf",
       "{'asset': {'version': '2.0'}, 'materials': [{'name': 'same'}, {'name': 'same'}, {}, {}, "
       "{'name': 'same#2'}]}");
  save("m.mtl", kLibrary);
  save("m.obj", kModel);
  const std::string members =
      "'materials': {'own/er': {'diffuse': 0.5}}, 'objects': {'pair': [{'shape': 'quad', "
      "'material': 'own/er'}, {'model': 'm.obj'}]}, 'scene': [{'use': 'pair'}, {'group': "
      "[{'group': [{'model': 'm.obj', 'materials': {'*': {'diffuse': 0.4}, 'red': {'mirror': "
      "0.1}}}]}]}, {'model': 't.gltf'}, {'shape': 'box'}]";

  const std::vector<Material> before = with({}, members).materials;
  ASSERT_EQ(before.size(), 1u + 3 + 3 + 6 + 1);

  for (const Material& one : before) {
    const std::vector<Material> after = with({one.pointer + "/ior=1.125"}, members).materials;
    ASSERT_EQ(after.size(), before.size());
    for (const Material& m : after) EXPECT_EQ(m.ior == 1.125f, m.pointer == one.pointer);
  }
}

}  // namespace
}  // namespace whit
