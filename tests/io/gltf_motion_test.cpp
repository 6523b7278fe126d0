// Animations, skins and morph targets of glTF files, against poses worked out by hand.
#include <cmath>

#include "bake/edit_scene.h"
#include "farthest_in_picture.h"
#include "gltf_files.h"
#include "make/turntable.h"

namespace whit {
namespace {

class GltfMotion : public GltfTest {
 protected:
  // Returns a file that shows a triangle whose node the animations move.
  std::string moved(const std::string& animations) {
    return json(oneMesh(triangle()) + played(animations));
  }

  SceneDescription at(double seconds, const std::string& text, const std::string& animation = "") {
    options_.instant = {seconds, animation};
    return loadText(text);
  }

  // Returns where a corner of the first instance is at the scene's time.
  static Vec3d movedCorner(const SceneDescription& scene, std::size_t corner) {
    const Instance& instance = scene.instances.at(0);
    const Mesh& mesh = scene.objects.at(instance.object).meshes.at(0);
    const double seconds = scene.motion.seconds;
    const std::vector<Vec3f> positions =
        mesh.deformation
            ? deformVertices(*mesh.deformation, poseAt(*mesh.deformation, seconds)).positions
            : mesh.positions;

    Affine map = instance.toWorld;
    if (instance.mover != kNoNode) {
      map = poseRig(scene.motion.rig, seconds).at(instance.mover) * map;
    }

    return map.point(Vec3d(positions.at(mesh.triangles.at(0).at(corner))));
  }
};

TEST_F(GltfMotion, NodesMove) {
  const std::string text = moved(animation("translation", {1, 3}, {0, 0, 0, 4, 2, 0}));

  expectNearInFloat(cornerOf(loadText(text), 0), {0, 0, 0});
  expectNearInFloat(movedCorner(at(0, text), 0), {0, 0, 0});
  expectNearInFloat(movedCorner(at(2.5, text), 0), {3, 1.5, 0});
  expectNearInFloat(movedCorner(at(9, text), 1), {5, 2, 0});
  expectNoWarnings();
}

TEST_F(GltfMotion, NodesTurnAndGrow) {
  const float half = std::sqrt(0.5f);
  const std::string turned = moved(animation("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, half, half}));
  expectNearInFloat(movedCorner(at(0.5, turned), 1), {half, half, 0});

  const std::string grown =
      moved(animation("scale", {0, 1}, {1, 1, 1, 3, 1, 1}, 0, ",'interpolation':'STEP'"));
  expectNearInFloat(movedCorner(at(0.5, grown), 1), {1, 0, 0});
}

TEST_F(GltfMotion, AnimationsAreChosenByTheirNames) {
  const std::string aside = animation("translation", {0, 2}, {0, 0, 0, 1, 0, 0}),
                    up = animation({{"translation", {0, 2}, {0, 0, 0, 0, 1, 0}},
                                    {"scale", {0, 1}, {1, 1, 1, 1, 1, 1}}});
  const std::string text = moved(aside + "," + named("rise", up));

  expectNearInFloat(movedCorner(at(2, text), 0), {1, 0, 0});
  expectNearInFloat(movedCorner(at(2, text, "rise"), 0), {0, 1, 0});
  expectNearInFloat(movedCorner(at(2, text, "animation 0"), 0), {1, 0, 0});

  EXPECT_EQ(errorOf([&] { at(2, text, "rose"); }),
            "2 m has no animation 'rose'; did you mean 'rise'?");

  options_.instant = {};
  const std::vector<Animation> all = loadText(text).animations;
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].name, "rise");
  EXPECT_EQ(all[1].seconds, 2);  // of the longest sampler
  EXPECT_EQ(all[1].nodes, 1u);

  // Accessors should state their largest number.
  const std::string silent = replaced(text, "'max':[2]", "'name':'times'");
  EXPECT_EQ(loadText(silent).animations.at(0).seconds, 2);
}

TEST_F(GltfMotion, WhatDoesNotMoveHasNoTime) {
  EXPECT_EQ(errorOf([&] { at(1, json(oneMesh(triangle()))); }), "2 --time: nothing moves in m");
}

TEST_F(GltfMotion, CamerasAndLightsMove) {
  const Scene scene = bake(at(
      0.5,
      json("'meshes':[{'primitives':[" + triangle() +
           "]}],'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}}],'extensions':"
           "{'KHR_lights_punctual':{'lights':[{'type':'point'}]}},'nodes':[{'mesh':0},{'children':["
           "2,3]},{'camera':0},{'extensions':{'KHR_lights_punctual':{'light':0}}}]" +
           played(animation("translation", {0, 1}, {0, 0, 0, 0, 0, 8}, 1)))));
  EXPECT_EQ(scene.cameras.at(0).eye, (Vec3f{0, 0, 4}));
  EXPECT_EQ(scene.lights.at(0).position, (Vec3f{0, 0, 4}));
}

// Returns how far the corners reach in the picture at 60 times from `begin` to `end`, or once if
// they are the same.
double farthestInFilm(Scene& scene, const Camera& camera, double begin, double end) {
  const int times = begin == end ? 1 : 60;
  std::vector<Vec3d> corners;
  for (int k = 0; k < times; ++k) {
    moveScene(scene, begin + (end - begin) * k / 59);
    for (const InstanceRecord& instance : scene.instances) {
      const Geometry& geometry = scene.geometries.at(instance.geometry);
      for (const auto& triangle : geometry.index) {
        for (const std::uint32_t corner : triangle) {
          corners.push_back(instance.toWorld.point(Vec3d(geometry.position.at(corner))));
        }
      }
    }
  }
  return farthestInPicture(makeCameraFrame(camera, scene.width, scene.height), corners);
}

TEST_F(GltfMotion, TheSuppliedViewHoldsTheWholeAnimation) {
  const std::vector<float> times{0.5f, 2};
  const std::string box = oneMesh(triangle());
  const std::string both = replaced(replaced(box, "{'mesh':0}]", "{'mesh':0},{'mesh':0}]"),
                                    "'nodes':[0]}", "'nodes':[0,1]}");
  const std::string grown =
      oneMesh(triangle(",'targets':[{'POSITION':" + positions(kTriangleXyz) + "}]"));

  const std::string all[] = {
      box + played(animation("translation", times, {0, 0, 0, 10, 0, 0})),
      box + played(animation("translation", times, {0, 0, -20, 0, 0, 20})),
      // The curve leaves the range of its keys: it starts and ends at 0 and swings to 4.5 in
      // between.
      box + played(animation("translation", times,
                             {0, 0, 0, 0, 0, 0, 0, 12, 0, 0, -12, 0, 0, 0, 0, 0, 0, 0}, 0,
                             ",'interpolation':'CUBICSPLINE'")),
      box + played(animation("scale", times, {0, 0, 0, 3, 3, 3})),
      both + played(animation("rotation", times, {0, 0, 0, 1, 0, 0, 0.94f, -0.34f})),
      grown + played(animation("weights", times, {0, 1})),
  };

  for (const std::string& members : all) {
    SCOPED_TRACE(members);
    const std::string text = json(members);
    const SceneDescription scene = at(1.1, text), other = at(2, text);
    const Camera& camera = scene.cameras.at(0);

    Scene film = bake(scene);
    const double farthest = farthestInFilm(film, camera, 0, 2);
    EXPECT_LT(farthest, 1);
    EXPECT_GT(farthest, 0.9);

    // The view and the lights do not depend on the time at which the file is loaded.
    EXPECT_TRUE(sameView(camera, other.cameras.at(0))) << "the view trembles";
    EXPECT_EQ(scene.lights.at(0).position, other.lights.at(0).position);

    const Turntable turntable = aroundModel(scene, viewOf(scene), scene.width, scene.height);
    double turning = 0;
    for (int k = 0; k < 12; ++k) {
      const double now = scene.motion.seconds;
      turning = std::max(turning, farthestInFilm(film, turned(turntable, k / 12.0), now, now));
    }

    EXPECT_LT(turning, 1) << "a turntable shows one time";
    EXPECT_GT(turning, 0.8);
  }
}

TEST_F(GltfMotion, TheSuppliedViewOfASceneHoldsAllThatMoves) {
  save("m.gltf", moved(animation("translation", {0, 1}, {0, 0, 0, 1, 0, 0})));
  options_.instant.plays = true;
  Scene film = bake(
      loadMembers("'view':'model','scene':[{'model':'m.gltf'},{'shape':'box','motion':{'keys':["
                  "{'time':0},{'time':4,'translate':[20,0,0]}]}}]"));
  EXPECT_LT(farthestInFilm(film, film.cameras.at(0), 0, 4), 1);
}

// Only the animation that is played affects the view, and only a view that is computed from the
// model.
TEST_F(GltfMotion, OtherAnimationsDoNotChangeTheSuppliedView) {
  const std::string moves = animation("translation", {0, 1}, {0, 0, 0, 10, 0, 0}),
                    still = animation("translation", {0, 1}, {0, 0, 0, 0, 0, 0});
  const std::string text = moved(moves + "," + named("still", still));
  const SceneDescription rest = loadText(text), moving = at(0, text), other = at(0, text, "still");

  EXPECT_FALSE(sameView(rest.cameras.at(0), moving.cameras.at(0)));
  EXPECT_TRUE(sameView(rest.cameras.at(0), other.cameras.at(0)));

  // No view is computed for a file with a camera, so that the animation does not move its lights.
  const std::string own = replaced(text, "{'mesh':0}]",
                                   "{'mesh':0,'camera':0}],'cameras':[{'type':'perspective',"
                                   "'perspective':{'yfov':1,'znear':1}}]");
  options_.instant = {};
  EXPECT_EQ(loadText(own).lights.at(0).position, at(0, own).lights.at(0).position);
}

TEST_F(GltfMotion, BrokenAnimationsAreRefusedWhenTheyArePlayed) {
  struct Case {
    std::vector<float> times, to;
    std::string error;
  };
  const Case cases[] = {
      {{0, 0},
       {0, 0, 0, 1, 0, 0},
       "input: expected finite times that increase, found 0 at index 1"},
      {{0, NAN, 1},
       {0, 0, 0, 1, 0, 0, 0, 0, 0},
       "input: expected finite times that increase, found nan at index 1"},
      {{0, 1}, {0, 0, 0}, "output: expected 6 numbers for 2 times, found 3"},
      {{0, 1}, {0, 0, 0, NAN, 0, 0}, "output: expected finite numbers, found one that is not"},
  };

  for (const auto& [times, to, error] : cases) {
    const std::string text = moved(animation("translation", times, to));
    options_.instant = {};
    loadText(text);  // It loads as long as the animation is not played.
    EXPECT_EQ(errorOf([&, t = text] { at(0, t); }), "3 m.gltf#/animations/0/samplers/0/" + error);
  }
}

TEST_F(GltfMotion, BrokenChannelsAreRefused) {
  options_.instant = {0, ""};
  const std::string place = "3 m.gltf#/animations/0/";
  expectErrorsOfDamage(
      moved(animation("translation", {0, 1}, {0, 0, 0, 1, 0, 0})),
      {
          {"'sampler':0", "'sampler':1",
           place + "channels/0/sampler: expected an index into samplers, from 0 to 0, found 1"},
          {"'input':0", "'input':'x'",
           place + "samplers/0/input: expected an index into accessors, from 0 to 2, found \"x\""},
          {"'output':1", "'output':1,'interpolation':'CUBICSPLINE'",
           place + "samplers/0/output: expected 18 numbers for 2 times, found 6"},
          {"'SCALAR'", "'LIST'", "3 m.gltf#/accessors/0/type: expected SCALAR, found \"LIST\""},
          // Channels of KHR_animation_pointer are left out, with or without their pointer.
          {"'node':0,'path':'translation'",
           "'path':'pointer','extensions':{'KHR_animation_pointer':{}}", "no error"},
      });
}

TEST_F(GltfMotion, MorphTargetsAddUp) {
  const std::string one = positions({1, 0, 0, 0, 0, 0, 0, 0, 0});
  const std::string two = positions({0, 0, 2, 0, 0, 0, 0, 0, 0});
  const std::string members =
      replaced(oneMesh(triangle(",'targets':[{'POSITION':" + one + "},{'POSITION':" + two + "}]")),
               "]}],'nodes'", "],'weights':[0.5,0.25]}],'nodes'");
  expectNearInFloat(cornerOf(loadText(json(members)), 0), {0.5, 0, 0.5});

  // The weights of the node replace those of the mesh.
  const std::string own = replaced(members, "{'mesh':0}", "{'mesh':0,'weights':[0,1]}");
  expectNearInFloat(cornerOf(loadText(json(own)), 0), {0, 0, 2});

  // An animation replaces both.
  const std::string weighted = played(animation("weights", {0, 1}, {0, 0, 1, 1}));
  const SceneDescription later = at(0.5, json(own + weighted));
  expectNearInFloat(movedCorner(later, 0), {0.5, 0, 1});
  expectNearInFloat(movedCorner(later, 1), {1, 0, 0});
  expectNoWarnings();
}

// A target without weight shows nothing that would be missing.
TEST_F(GltfMotion, MorphTargetsOfColorsAndCoordinatesAreSaidToBeLeftOut) {
  const std::string moved = positions({1, 0, 0, 0, 0, 0, 0, 0, 0});
  const std::string shown =
      triangle(",'targets':[{'POSITION':" + moved + ",'COLOR_0':" + moved + "}]");
  for (const std::uint64_t weight : {0u, 1u}) {
    loadText(json(
        replaced(oneMesh(shown), "]}],'nodes'", joined("],'weights':[", weight, "]}],'nodes'"))));
    expectWarned("colors or texture coordinates of a morph target left out: they stay as they are",
                 weight);
  }
}

// Two joints lie one above the other, at heights 0 and 1. The upper one is turned by a right angle
// about z. The corners of the triangle lie at heights 0, 1 and 2.
class GltfSkin : public GltfMotion {
 protected:
  std::vector<float> xyz = {0, 0, 0, 1, 1, 0, 0, 2, 0};
  std::vector<std::uint16_t> joints = {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  std::vector<float> weights = {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0};
  std::string attributes, rest;  // further attributes and members of the primitive

  // Returns a mesh and a skin whose members are given.
  std::string skinned(const std::string& skin) {
    const std::string influences =
        ",'JOINTS_0':" + add("VEC4", joints) + ",'WEIGHTS_0':" + floats("VEC4", weights);
    return "'meshes':[{'primitives':[" + primitive(positions(xyz), influences + attributes, rest) +
           "]}],'skins':[{" + skin + "}]";
  }

  // If `plays`, an animation turns the upper joint by 150 degrees.
  std::string text(const std::string& turn = "0,0,0.70710678,0.70710678", bool plays = false) {
    const std::string inverse = floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                                1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
    const std::string turns =
        played(animation("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0.96592583f, 0.25881905f}, 2));

    return json(skinned("'joints':[1,2],'inverseBindMatrices':" + inverse) +
                ",'nodes':[{'mesh':0,'skin':0,'translation':[50,0,0]},{'children':[2]},"
                "{'translation':[0,1,0],'rotation':[" +
                turn + "]}]" + (plays ? turns : ""));
  }
};

// The middle corner lies half at (1, 1), where the lower joint takes it, and half at (0, 2).
const std::vector<Vec3d> kTurnedCorners{{0, 0, 0}, {0.5, 1.5, 0}, {-1, 1, 0}};

// The position of the mesh's own node has no effect.
TEST_F(GltfSkin, VerticesFollowTheirJoints) {
  expectTriangle(loadText(text()), kTurnedCorners);

  const std::string atRest = text("0,0,0,1");
  expectTriangle(loadText(atRest), {{0, 0, 0}, {1, 1, 0}, {0, 2, 0}});

  // Skins that are mirrored keep their fronts.
  const std::string mirrored =
      replaced(atRest, "{'children':[2]}", "{'children':[2],'scale':[-1,1,1]}");
  expectTriangle(loadText(replaced(mirrored, "'translation':[50,0,0]", "'translation':[0,0,0]")),
                 {{0, 0, 0}, {0, 2, 0}, {-1, 1, 0}});
}

// Copies within the node would all be where the joints are.
TEST_F(GltfSkin, CopiesOfItAreLeftOut) {
  const std::string copies =
      joined("'skin':0,'extensions':{'EXT_mesh_gpu_instancing':{",
             "'attributes':{'TRANSLATION':", positions({1, 0, 0, 2, 0, 0}), "}}}");
  const SceneDescription scene = loadText(replaced(text(), "'skin':0", copies));
  EXPECT_EQ(scene.instances.size(), 1u);
  expectTriangle(scene, kTurnedCorners);
  expectWarned("copies of a skinned mesh left out");
}

TEST_F(GltfSkin, JointsArePlacedByHand) {
  options_.instant.movable = {"/nodes/2"};
  Scene scene = bake(loadText(text("0,0,0,1")));
  const Scene shared = scene;
  const auto corner = [](const Scene& of, std::size_t i) {
    return Vec3d(of.geometries.at(of.instances.at(0).geometry).position.at(i));
  };

  expectNearInFloat(corner(scene, 2), {0, 2, 0});
  const Affine turned{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
  setPlace(scene, "/nodes/2", turned);
  moveScene(scene, 0);

  for (const std::size_t i : {0, 1, 2}) expectNearInFloat(corner(scene, i), kTurnedCorners[i]);

  // Copies that were made before keep their geometry.
  expectNearInFloat(corner(shared, 2), {0, 2, 0});
  EXPECT_THROW(setPlace(scene, "/nodes/1", turned), Error);
}

TEST_F(GltfSkin, TheSuppliedViewHoldsTheWholeAnimation) {
  Scene scene = bake(at(0.2, text("0,0,0,1", true)));
  const double farthest = farthestInFilm(scene, scene.cameras.at(0), 0, 1);
  EXPECT_LT(farthest, 1);
  EXPECT_GT(farthest, 0.9);
}

// A joint that moves has thousands of children, three of which hold one corner each.
TEST_F(GltfSkin, ThousandsOfJointsHold) {
  std::string list, nodes;
  for (int i = 0; i < 9000; ++i) {
    addItem(list, joined(i + 2));
    nodes += joined(",{'translation':[", i, ",0,0]}");
  }

  joints = {0, 0, 0, 0, 5000, 0, 0, 0, 8999, 0, 0, 0};
  weights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const SceneDescription scene =
      at(1, json(skinned("'joints':[" + list + "]") +
                 ",'nodes':[{'mesh':0,'skin':0},{'children':[" + list + "]}" + nodes + "]" +
                 played(animation("translation", {0, 2}, {0, 0, 0, 0, 2, 0}, 1))));

  expectNearInFloat(movedCorner(scene, 0), {0, 1, 0});
  expectNearInFloat(movedCorner(scene, 1), {5001, 2, 0});
  expectNearInFloat(movedCorner(scene, 2), {8999, 3, 0});
}

TEST_F(GltfSkin, NormalsTurnWithTheirJoints) {
  attributes = ",'NORMAL':" + positions({0, 0, 1, 1, 0, 0, 0, 1, 0});
  const std::vector<Vec3f> normals = meshOf(loadText(text())).normals;
  ASSERT_EQ(normals.size(), 3u);
  expectNearInFloat(normals[0], {0, 0, 1});
  expectNearInFloat(normals[1], {std::sqrt(0.5), std::sqrt(0.5), 0});
  expectNearInFloat(normals[2], {-1, 0, 0});
}

// A second set has the same joints once more.
TEST_F(GltfSkin, WeightsOfAllSetsAreScaledToOne) {
  attributes = ",'JOINTS_1':" + add("VEC4", joints) + ",'WEIGHTS_1':" + floats("VEC4", weights);
  expectNearInFloat(cornerOf(loadText(text()), 1), kTurnedCorners[1]);
  attributes.clear();
  weights[4] = weights[5] = 2;
  expectNearInFloat(cornerOf(loadText(text()), 1), kTurnedCorners[1]);
}

TEST_F(GltfSkin, JointsThatAreMissingAreLeftOut) {
  joints[4] = 9;
  expectNearInFloat(cornerOf(loadText(text()), 1), {0, 2, 0});
  expectWarned("joint that the skin does not have left out");
  weights[5] = 0;
  // The node, at x = 50, would show the corner there without a skin.
  expectNearInFloat(cornerOf(loadText(text()), 1), {51, 1, 0});
  expectWarned("vertex that no joint holds placed by its node");
}

TEST_F(GltfSkin, TrianglesOfVerticesThatAreMissingAreLeftOut) {
  rest = ",'indices':" + add<std::uint32_t>("SCALAR", {0, 1, 2, 0, 1, 4294967295u});
  EXPECT_EQ(bake(loadText(text())).triangles.size(), 1u);
  expectWarned("triangle with a vertex index out of range dropped");
}

TEST_F(GltfSkin, BrokenSkinsAreRefused) {
  expectErrorsOfDamage(
      text(),
      {
          {"'joints':[1,2]", "'joints':[1,7]",
           "3 m.gltf#/skins/0/joints/1: expected an index into nodes, from 0 to 2, found 7"},
          {"'joints':[1,2]", "'joints':[]",
           "3 m.gltf#/skins/0/joints: expected at least one joint, found []"},
          {"'joints':[1,2]", "'joints':5", "3 m.gltf#/skins/0/joints: expected a list, found 5"},
          {"'inverseBindMatrices':0", "'inverseBindMatrices':5",
           "3 m.gltf#/accessors/5/type: expected MAT4, found \"VEC3\""},
          {"'joints':[1,2]", "'joints':[1,2,1]",
           "3 m.gltf#/skins/0/inverseBindMatrices: expected a matrix for each of 3 joints, found "
           "2"},
      });
}

}  // namespace
}  // namespace whit
