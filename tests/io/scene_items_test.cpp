// Items, transforms, groups, objects and models of scene files.

#include "bake/scene.h"
#include "noun_members.h"

namespace whit {
namespace {

using SceneItems = SceneFileTest;

TEST_F(SceneItems, TransformScalesThenRotatesThenTranslates) {
  save("t.obj", kTriangleObj);
  const SceneDescription scene = loadMembers(
      "'scene': [{'model': 't.obj', 'transform': {'translate': [10,0,0],'rotate': [0,0,1,90], "
      "'scale': [2,3,4]}}]");
  expectNear(cornerOf(scene, 1), {10, 2, 0});
  expectNear(cornerOf(scene, 2), {7, 0, 0});

  // Lists of transforms apply the first first: (1,0,0) -> (2,0,0) -> (0,2,0) -> (0,0,2) ->
  // (5,6,11).
  const SceneDescription list = loadMembers(
      "'scene': [{'model': 't.obj', 'transform': [{'translate': [1,0,0]},{'rotate': [[0,0,1,90], "
      "[1,0,0,90]]}, {'matrix': [1,0,0,5, 0,1,0,6, 0,0,2,7]}]}]");
  expectNear(cornerOf(list, 1), {5, 6, 11});
}

// A scene file that states a mirror asks for the sum of mirror and color, also for a model.
TEST_F(SceneItems, MirrorsOfModelsAreCoatsUnlessTheSceneStatesThem) {
  save("t.obj", kTriangleObj);
  const auto isCoat = [&](const std::string& members) {
    const std::string overrides = "'materials': {'*': {" + members + "}}";
    const SceneDescription scene = loadMembers("'scene': [{'model': 't.obj', " + overrides + "}]");
    return scene.materials.at(0).coat;
  };
  EXPECT_TRUE(isCoat("'diffuse': 0.4"));
  EXPECT_FALSE(isCoat("'mirror': 0.3"));
  EXPECT_TRUE(isCoat("'mirror': 0.3, 'coat': true"));
  EXPECT_FALSE(isCoat("'coat': false"));
}

// A stretched object looks the same whether it is baked once or instanced twice.
TEST_F(SceneItems, StretchedPartsKeepTheirNormals) {
  const std::string egg =
      "'objects': {'egg': [{'shape': 'sphere', 'segments': 64, 'transform': {'scale': [1, 3, "
      "0.5]}}]}, 'scene': [{'use': 'egg'}";

  const Scene once = bake(loadMembers(egg + "]"));
  const Scene twice =
      bake(loadMembers(egg + ", {'use': 'egg', 'transform': {'translate': [5, 0, 0]}}]"));

  EXPECT_TRUE(once.instances.empty());
  EXPECT_EQ(twice.instances.size(), 2u);
  ASSERT_EQ(once.normals.size(), twice.normals.size());

  constexpr float kUlpsOfOne = 3e-7f;  // an object that is instanced is normalized once more
  float shortest = 1;
  for (const auto i : indices(once.normals)) {
    const float* n = once.normals[i].normal;
    for (int k = 0; k < 9; ++k) ASSERT_NEAR(n[k], twice.normals[i].normal[k], kUlpsOfOne) << i;
    shortest = std::min(shortest, length(Vec3f{n[0], n[1], n[2]}));
  }

  EXPECT_LT(shortest, 0.9f) << "the object was meant to be stretched";
}

TEST_F(SceneItems, TransformsThatFlattenAreRefused) {
  const auto error = [&](const std::string& transform) {
    return errorOfMembers("'scene': [{'shape': 'sphere', 'transform': " + transform + "}]");
  };

  expectErrors(
      error,
      {
          {"{'scale': [1,0,1]}",
           "3 s.json#/scene/0/transform/scale: expected a scale other than 0, found [1,0,1]"},
          {"{'rotate': [0,0,0,90]}",
           "3 s.json#/scene/0/transform/rotate: expected an axis other than 0, found [0,0,0,90]"},
          {"{'matrix': [1,0,0,0, 1,0,0,0, 0,0,1,0]}",
           "3 s.json#/scene/0/transform: expected a transform that can be undone, found an object "
           "of 1"},
          {"{'matrix': [1,0,0,0], 'scale': 2}",
           "3 s.json#/scene/0/transform/matrix: expected 12 numbers: a matrix of 3 rows of 4, "
           "found [1,0,0,0]"},

          // A matrix excludes the other members.
          {"{'scale': 2, 'matrix': [1,0,0,0, 0,1,0,0, 0,0,1,0]}",
           "3 s.json#/scene/0/transform/scale: unknown key"},
      });
}

TEST_F(SceneItems, GroupsAndRepeats) {
  save("t.obj", kTriangleObj);
  const SceneDescription scene = loadMembers(
      "'scene': [{'group': [{'model': 't.obj', 'transform': {'translate': [1,0,0]}}],'transform': "
      "{'scale': 2}, 'repeat': {'count': [2,1,3], 'step': [10,0,100]}}]");
  ASSERT_EQ(scene.instances.size(), 6u);

  // The step is in the parent's space and is therefore not scaled.
  for (const auto i : indices(6)) {
    expectNear(cornerOf(scene, 0, i),
               {2.0 + 10.0 * static_cast<double>(i % 2), 0, 100.0 * static_cast<double>(i / 2)});
  }

  const Scene baked = bake(scene);
  EXPECT_EQ(baked.triangles.size(), 6u);
  EXPECT_TRUE(baked.instances.empty());
}

TEST_F(SceneItems, RepeatsAreLimited) {
  EXPECT_EQ(errorOfMembers("'scene': [{'shape': 'sphere', 'repeat': {'count': [10000,10000,10000], "
                           "'step': [1,1,1]}}]"),
            "3 s.json#/scene/0/repeat/count: expected at most 10000000 copies, found "
            "[10000,10000,10000]");

  options_.maxMemoryBytes = 1 << 20;
  expectLike(
      errorOfMembers(
          "'scene': [{'shape': 'quad', 'repeat': {'count': [100,100,100], 'step': [1,1,1]}}]"),
      "5 *");
}

TEST_F(SceneItems, ObjectsPlacedOnceAreBakedAndMoreOftenInstanced) {
  save("t.obj", kTriangleObj);
  const std::string objects =
      "'objects': {'pair': [{'use': 'one'}, {'use': 'one', 'transform': {'translate': [0,0,1]}}], "
      "'one': [{'model': 't.obj'}], 'never': [{'model': 't.obj'}]}, 'scene': [{'use': 'pair'}";

  const SceneDescription once = loadMembers(objects + "]");
  ASSERT_EQ(once.objects.size(), 1u);
  ASSERT_EQ(once.instances.size(), 2u);

  const SceneDescription thrice =
      loadMembers(objects + ", {'use': 'pair', 'repeat': {'count': [2,1,1], 'step': [10,0,0]}}]");
  ASSERT_EQ(thrice.objects.size(), 1u);
  ASSERT_EQ(thrice.instances.size(), 6u);
  expectNear(cornerOf(thrice, 1, 5), {11, 0, 1});
}

TEST_F(SceneItems, InstancedObjectsKeepTheTransformsOfTheirParts) {
  save("t.obj", kTriangleObj);
  const SceneDescription scene = loadMembers(
      "'objects': {'o': [{'model': 't.obj', 'transform': {'scale': -2}}]},'scene': [{'use': 'o'}, "
      "{'use': 'o', 'transform': {'translate': [5,0,0]}}]");

  ASSERT_EQ(scene.objects.size(), 1u);
  const Mesh& mesh = meshOf(scene);
  EXPECT_EQ(mesh.positions[1], Vec3f(-2, 0, 0));
  EXPECT_NE(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));  // a mirrored winding
  expectNear(cornerOf(scene, 2, 1), {3, 0, 0});
}

TEST_F(SceneItems, ObjectsMayNotContainThemselves) {
  expectErrorsOfMembers({
      {"'objects': {'a': [{'use': 'b'}], 'b': [{'use': 'a'}]}",
       "3 s.json#/objects/a: this object contains itself"},
      {"'objects': {'rock': []}, 'scene': [{'use': 'rok'}]",
       "3 s.json#/scene/0/use: expected the name of an object (is \"rock\" meant?), found \"rok\""},
  });
}

TEST_F(SceneItems, InstancesThatMultiplyAreLimited) {
  std::string objects = "'objects': {'o0': [{'shape': 'quad'}]";
  for (int i = 1; i <= 30; ++i) {
    std::string uses;
    for (int k = 0; k < 10; ++k) addItem(uses, joined("{'use': 'o", i - 1, "'}"));
    objects += joined(", 'o", i, "': [", uses, "]");
  }

  // There would be 10^30 instances.
  expectLike(errorOfMembers(objects + "}, 'scene': [{'use': 'o30'}]"), "5 instances*");
}

TEST_F(SceneItems, MaterialsOfShapesAndTheirSlots) {
  const std::string materials =
      "'materials': {'red': {}, 'green': {}},'scene': [{'shape': 'tree', 'leaves': 5, 'material': "
      "'red'";

  const SceneDescription scene =
      loadMembers(materials + ", 'materials': {'leaves': 'green'}}, {'shape': 'quad'}]");

  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.materials[meshOf(scene).material(0)].name, "red");                 // bark
  EXPECT_EQ(scene.materials[scene.objects[1].meshes[0].material(0)].name, "green");  // leaves
  EXPECT_EQ(scene.materials[scene.objects[2].meshes[0].material(0)].name, "default");

  expectErrorsOfMembers({
      {materials + ", 'materials': {'leafs': 'green'}}]",
       "3 s.json#/scene/0/materials/leafs: unknown slot of this shape (is \"leaves\" meant?)"},
      {"'materials': {'red': {}}, 'scene': [{'shape': 'quad', 'material': 'rad'}]",
       "3 s.json#/scene/0/material: expected the name of a material (is \"red\" meant?), found "
       "\"rad\""},
  });
}

TEST_F(SceneItems, ShapesWithPlacementsBecomeInstances) {
  const SceneDescription scene = loadMembers(
      "'scene': [{'shape': 'forest', 'trees': 7, 'leaves': 5, 'transform': {'translate': "
      "[0,1000,0]}}]");
  ASSERT_GE(scene.instances.size(), 2u);
  EXPECT_LT(scene.objects.size(), scene.instances.size());
  for (const Instance& instance : scene.instances) EXPECT_GT(instance.toWorld.p.y, 500);
}

TEST_F(SceneItems, OverridesChangeOnlyWhatTheyGive) {
  saveImage("a.tga", {"0a141e"});
  saveImage("b.tga", {"28323c"});
  save("m.mtl",
       "newmtl x\nKd 0.5 0.5 0.5\nNs 6\nmap_Kd a.tga\nmap_Ks a.tga\nKs 0.1 0.1 0.1\nnewmtl y\n"
       "Kd 0.25 0.25 0.25\n");
  save("m.obj", "mtllib m.mtl\nusemtl x\n" + kTriangleObj + "usemtl y\nf 1 2 3\n");

  const std::string head = "'textures': {'b': {'image': 'b.tga'}}, 'scene': [{'model': 'm.obj'";
  const SceneDescription scene =
      loadMembers(head +
                  ", 'materials': {'x': {'specular': 0.5}, '*': {'emission': 2}}},{'model': "
                  "'m.obj', 'materials': {'x': {'diffuseMap': 'b', 'diffuse': 1}}}]");

  const auto materialOf = [&](std::size_t object, std::size_t triangle) {
    return scene.materials[scene.objects[object].meshes[0].material(triangle)];
  };
  const Material x = materialOf(0, 0), y = materialOf(0, 1), other = materialOf(1, 0);

  expectExactly(x, "{'diffuse': 0.5, 'specular': 0.5, 'emission': 2}");
  EXPECT_NE(x.specularMap, kNoTexture);  // the file's own
  expectExactly(y, "{'emission': 2, 'specular': 0}");
  expectExactly(other, "{'emission': 0, 'diffuse': 1}");
  EXPECT_NE(other.diffuseMap, x.diffuseMap);

  // Names of materials and their members are checked.
  expectErrorsOfMembers({
      {head + ", 'materials': {'xx': {}}}]",
       "3 s.json#/scene/0/materials/xx: unknown material of this model (is \"x\" meant?)"},
      {head + ", 'materials': {'x': {'difuse': 1}}}]",
       "3 s.json#/scene/0/materials/x/difuse: unknown key (is \"diffuse\" meant?)"},
  });
}

// The nesting is far deeper than that of any scene. Objects are read by recursion, unless they come
// after those that they use.
TEST_F(SceneItems, NestingHasALimit) {
  const auto chain = [](int length, bool innerFirst) {
    std::string objects;
    for (int i = 0; i <= length; ++i) {
      const int o = innerFirst ? length - i : i;
      addItem(objects,
              joined("'o", o, "': [",
                     o == length ? "{'shape': 'quad'}" : joined("{'use': 'o", o + 1, "'}"), "]"));
    }
    return "'objects': {" + objects + "}, 'scene': [{'use': 'o0'}]";
  };

  EXPECT_EQ(triangleCount(loadMembers(chain(200, false))), 2u);
  EXPECT_EQ(triangleCount(loadMembers(chain(200, true))), 2u);

  expectErrorsOfMembers({
      {chain(4000, false), "3 s.json#/objects/o256/0: nested deeper than 256 items"},
      {chain(4000, true), "5 objects are nested deeper than 256"},
  });
}

// Shapes that need much memory are refused before it is allocated.
TEST_F(SceneItems, ShapesAndPatternsKeepToTheMemoryLimit) {
  options_.maxMemoryBytes = 1 << 20;
  for (const std::string item :
       {"'vault', 'baysX': 1000, 'baysZ': 1000, 'segments': 2048",
        "'sphere', 'segments': 4096, 'rings': 4096",
        "'colonnade', 'columns': 10000, 'segments': 4096, 'rings': 4096", "'icosphere', 'level': 9",
        "'rock', 'level': 8", "'curtain', 'nx': 4096, 'ny': 4096",
        "'forest', 'trees': 1e7, 'leaves': 10"}) {
    expectErrorsOfMembers({{"'scene': [{'shape': " + item + "}]", "5 a shape or a patter*"}});
  }

  for (const std::string pattern : {"checker", "bricksNormals", "noise"}) {
    expectErrorsOfMembers({{"'textures': {'t': {'pattern': '" + pattern + "', 'size': 8192}}",
                            "5 a shape or a patter*"}});
  }
}

}  // namespace
}  // namespace whit
