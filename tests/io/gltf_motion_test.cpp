// Animations, skins and morph targets of glTF files, against poses worked out by hand.
#include <cmath>
#include <limits>

#include "bake/edit_scene.h"
#include "gltf_files.h"
#include "make/turntable.h"

namespace whit {
namespace {

const float kHalfRoot = std::sqrt(0.5f);

class GltfMotion : public GltfTest {
 protected:
  static std::string scalars(GltfBuilder& b, const std::vector<float>& x) {
    std::ostringstream bounds;
    bounds << ",\"min\":[" << x.front() << "],\"max\":[" << x.back() << "]";
    return b.accessor(b.view(bytesOf(x)), 5126, "SCALAR", x.size(), bounds.str());
  }
  static std::string fours(GltfBuilder& b, const std::vector<float>& x) {
    return b.accessor(b.view(bytesOf(x)), 5126, "VEC4", x.size() / 4);
  }
  static std::string animation(const std::string& input, const std::string& output, int node,
                               const std::string& path, const std::string& rest = "") {
    return "{\"samplers\":[{\"input\":" + input + ",\"output\":" + output + rest +
           "}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":" + std::to_string(node) +
           ",\"path\":\"" + path + "\"}}]}";
  }
  // Returns a file that shows a triangle whose node the animations move.
  static std::string moved(GltfBuilder& b, const std::string& animations) {
    return b.json(oneMesh(triangle(b)) + ",\"animations\":[" + animations + "]");
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
  GltfBuilder b;
  const std::string times = scalars(b, {1, 3}), to = b.positions({0, 0, 0, 4, 2, 0});
  const std::string text = moved(b, animation(times, to, 0, "translation"));

  expectNear(cornerOf(loadText(text), 0, 0, 0), {0, 0, 0});
  expectNear(movedCorner(at(0, text), 0), {0, 0, 0});
  expectNear(movedCorner(at(2.5, text), 0), {3, 1.5, 0});
  expectNear(movedCorner(at(9, text), 1), {5, 2, 0});
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfMotion, NodesTurnAndGrow) {
  GltfBuilder b;
  const std::string times = scalars(b, {0, 1});
  const std::string turn = fours(b, {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot});

  const SceneDescription turned = at(0.5, moved(b, animation(times, turn, 0, "rotation")));
  expectNear(movedCorner(turned, 1), {std::sqrt(0.5), std::sqrt(0.5), 0});

  GltfBuilder c;
  const std::string until = scalars(c, {0, 1}), size = c.positions({1, 1, 1, 3, 1, 1});
  const SceneDescription grown =

      at(0.5, moved(c, animation(until, size, 0, "scale", ",\"interpolation\":\"STEP\"")));
  expectNear(movedCorner(grown, 1), {1, 0, 0});
}

TEST_F(GltfMotion, AnimationsAreChosenByTheirNames) {
  GltfBuilder b;
  const std::string times = scalars(b, {0, 2});
  const std::string aside = b.positions({0, 0, 0, 1, 0, 0}), up = b.positions({0, 0, 0, 0, 1, 0});
  std::string second = animation(times, up, 0, "translation");
  second.insert(1, "\"name\":\"rise\",");
  const std::string text = moved(b, animation(times, aside, 0, "translation") + "," + second);

  expectNear(movedCorner(at(2, text), 0), {1, 0, 0});
  expectNear(movedCorner(at(2, text, "rise"), 0), {0, 1, 0});
  expectNear(movedCorner(at(2, text, "animation 0"), 0), {1, 0, 0});

  EXPECT_EQ(errorOf([&] { at(2, text, "rose"); }),
            "2 m has no animation 'rose'; did you mean 'rise'?");

  options_.instant = {};
  const std::vector<Animation> all = loadText(text).animations;
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].name, "rise");
  EXPECT_EQ(all[1].seconds, 2);
  EXPECT_EQ(all[1].nodes, 1u);
}

TEST_F(GltfMotion, WhatDoesNotMoveHasNoTime) {
  GltfBuilder b;
  const std::string text = b.json(oneMesh(triangle(b)));
  EXPECT_EQ(errorOf([&] { at(1, text); }), "2 --time: nothing moves in m");
}

TEST_F(GltfMotion, CamerasAndLightsMove) {
  GltfBuilder b;
  const std::string times = scalars(b, {0, 1}), to = b.positions({0, 0, 0, 0, 0, 8});
  const std::string text = b.json(
      "\"meshes\":[{\"primitives\":[" + triangle(b) +
      "]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}],"
      "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"}]}},\"nodes\":[{"
      "\"mesh\":0},{\"children\":[2,3]},{\"camera\":0},{\"extensions\":{\"KHR_lights_punctual\":{"
      "\"light\":0}}}],\"animations\":[" +
      animation(times, to, 1, "translation") + "]");

  Warnings none;
  const Scene scene = Scene::finalize(at(0.5, text), none);
  EXPECT_EQ(scene.cameras.at(0).eye, (Vec3f{0, 0, 4}));
  EXPECT_EQ(scene.lights.at(0).position, (Vec3f{0, 0, 4}));
}

// Projects all corners at 60 times from `begin` to `end`, once if they are the same. Returns the
// largest distance from the middle of the picture, relative to half of its height and width, or
// infinity if a corner lies behind the eye.
double farthestInPicture(Scene& scene, const Camera& camera, double begin, double end) {
  const double aspect = static_cast<double>(scene.width) / scene.height;
  const double half = std::tan(double{camera.fov} * std::acos(-1.0) / 360);

  const Vec3d eye(camera.eye), forward = normalized(Vec3d(camera.at) - eye);
  const Vec3d right = normalized(cross(forward, Vec3d(camera.up))), up = cross(right, forward);

  const int times = begin == end ? 1 : 60;
  double farthest = 0;
  for (int k = 0; k < times; ++k) {
    moveScene(scene, begin + (end - begin) * k / 59);
    for (const InstanceRecord& instance : scene.instances) {
      const Geometry& geometry = scene.geometries.at(instance.geometry);
      for (const auto& corners : geometry.index) {
        for (const std::uint32_t corner : corners) {
          // Projects the corner onto the axes of the camera.
          const Vec3d p = instance.toWorld.point(Vec3d(geometry.position.at(corner))) - eye;
          const double depth = dot(p, forward);
          if (!(depth > 0)) return std::numeric_limits<double>::infinity();
          farthest = std::max({farthest, std::abs(dot(p, right)) / (depth * half * aspect),
                               std::abs(dot(p, up)) / (depth * half)});
        }
      }
    }
  }
  return farthest;
}

TEST_F(GltfMotion, TheSuppliedViewHoldsTheWholeAnimation) {
  GltfBuilder b;
  const std::string times = scalars(b, {0.5f, 2});
  const std::string box = triangle(b), primitive = "{\"primitives\":[" + box + "]}";

  const std::string grown = b.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto animated = [&](const std::string& path, const std::string& to, const char* how = "") {
    return ",\"animations\":[" + animation(times, to, 0, path, how) + "]";
  };

  const std::string lid = replaced(oneMesh(box), "{\"mesh\":0}]", "{\"mesh\":0},{\"mesh\":0}]");
  const std::string both = replaced(lid, "\"nodes\":[0]}", "\"nodes\":[0,1]}");
  const std::string opened = fours(b, {0, 0, 0, 1, 0, 0, 0.94f, -0.34f});

  // The curve leaves the range of its keys: it starts and ends at 0 and swings to 4.5 in between.
  const std::string swings = b.positions({0, 0, 0, 0, 0, 0, 0, 12, 0,  //
                                          0, -12, 0, 0, 0, 0, 0, 0, 0});

  const std::string texts[] = {
      oneMesh(box) + animated("translation", b.positions({0, 0, 0, 10, 0, 0})),
      oneMesh(box) + animated("translation", b.positions({0, 0, -20, 0, 0, 20})),
      oneMesh(box) + animated("translation", swings, ",\"interpolation\":\"CUBICSPLINE\""),
      oneMesh(box) + animated("scale", b.positions({0, 0, 0, 3, 3, 3})),
      both + animated("rotation", opened),
      oneMesh(triangle(b, ",\"targets\":[{\"POSITION\":" + grown + "}]")) +
          animated("weights", scalars(b, {0, 1})),
  };

  for (const std::string& members : texts) {
    SCOPED_TRACE(members);
    const std::string text = b.json(members);
    const SceneDescription scene = at(1.1, text), other = at(2, text);
    const Camera& camera = scene.cameras.at(0);

    Warnings none;
    Scene played = Scene::finalize(SceneDescription(scene), none);
    const double farthest = farthestInPicture(played, camera, 0, 2);
    EXPECT_LT(farthest, 1);
    EXPECT_GT(farthest, 0.9);

    // The view and the lights do not depend on the time at which the file is loaded.
    EXPECT_TRUE(sameView(camera, other.cameras.at(0))) << "the view trembles";
    EXPECT_EQ(scene.lights.at(0).position, other.lights.at(0).position);

    const Turntable turntable = aroundModel(scene, viewOf(scene), scene.width, scene.height);
    double turning = 0;
    for (int k = 0; k < 12; ++k) {
      const double now = scene.motion.seconds;
      turning = std::max(turning, farthestInPicture(played, turned(turntable, k / 12.0), now, now));
    }

    EXPECT_LT(turning, 1) << "a turntable shows one time";
    EXPECT_GT(turning, 0.8);
  }
}

// Only the animation that is played affects the view, and only a view that is computed from the
// model.
TEST_F(GltfMotion, OtherAnimationsDoNotChangeTheSuppliedView) {
  GltfBuilder b;
  const std::string times = scalars(b, {0, 1}), to = b.positions({0, 0, 0, 10, 0, 0});
  const std::string still = b.positions({0, 0, 0, 0, 0, 0});
  std::string second = animation(times, still, 0, "translation");
  second.insert(1, "\"name\":\"still\",");

  const std::string members = oneMesh(triangle(b)) + ",\"animations\":[" +
                              animation(times, to, 0, "translation") + "," + second + "]";
  const SceneDescription rest = loadText(b.json(members)), moved = at(0, b.json(members)),
                         played = at(0, b.json(members), "still");

  EXPECT_FALSE(sameView(rest.cameras.at(0), moved.cameras.at(0)));
  EXPECT_TRUE(sameView(rest.cameras.at(0), played.cameras.at(0)));

  // No view is computed for a file with a camera, so that the animation does not move its lights.
  const std::string own =
      b.json(replaced(members, "{\"mesh\":0}]",
                      "{\"mesh\":0,\"camera\":0}],\"cameras\":[{\"type\":"
                      "\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}]"));
  options_.instant = {};
  EXPECT_EQ(loadText(own).lights.at(0).position, at(0, own).lights.at(0).position);
}

TEST_F(GltfMotion, BrokenAnimationsAreRefusedWhenTheyArePlayed) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const std::string place = "3 m.gltf#/animations/0/samplers/0/";
  const auto errorAt = [&](const std::vector<float>& times, const std::vector<float>& to) {
    GltfBuilder b;
    const std::string in = b.accessor(b.view(bytesOf(times)), 5126, "SCALAR", times.size());
    const std::string out = b.accessor(b.view(bytesOf(to)), 5126, "VEC3", to.size() / 3);

    const std::string text = moved(b, animation(in, out, 0, "translation"));
    options_.instant = {};
    loadText(text);  // It loads as long as the animation is not played.
    return errorOf([&] { at(0, text); });
  };

  EXPECT_EQ(errorAt({0, 0}, {0, 0, 0, 1, 0, 0}),
            place + "input: expected finite times that increase, found 0 at index 1");
  EXPECT_EQ(errorAt({0, kNone}, {0, 0, 0, 1, 0, 0}),
            place + "input: expected finite times that increase, found nan at index 1");
  EXPECT_EQ(errorAt({0, 1}, {0, 0, 0}), place + "output: expected 6 numbers for 2 times, found 3");
  EXPECT_EQ(errorAt({0, 1}, {0, 0, 0, kNone, 0, 0}),
            place + "output: expected finite numbers, found one that is not");
}

TEST_F(GltfMotion, BrokenChannelsAreRefused) {
  GltfBuilder b;
  const std::string times = scalars(b, {0, 1}), to = b.positions({0, 0, 0, 1, 0, 0});
  const std::string whole = moved(b, animation(times, to, 0, "translation"));
  const auto errorWith = [&](const std::string& what, const std::string& by) {
    return errorOf([&] { at(0, replaced(whole, what, by)); });
  };
  // Each change breaks one reference of the channel.
  const std::string place = "3 m.gltf#/animations/0/";

  EXPECT_EQ(errorWith("\"sampler\":0", "\"sampler\":1"),
            place + "channels/0/sampler: expected an index into samplers, from 0 to 0, found 1");
  EXPECT_EQ(errorWith("\"input\":0", "\"input\":\"x\""),
            place + "samplers/0/input: expected an index into accessors, from 0 to 2, found \"x\"");
  EXPECT_EQ(errorWith("\"output\":1", "\"output\":1,\"interpolation\":\"CUBICSPLINE\""),
            place + "samplers/0/output: expected 18 numbers for 2 times, found 6");
  EXPECT_EQ(errorWith("\"SCALAR\"", "\"LIST\""),
            "3 m.gltf#/accessors/0/type: expected SCALAR, found \"LIST\"");

  // Channels of KHR_animation_pointer are left out, with or without their pointer.
  EXPECT_EQ(errorWith("\"node\":0,\"path\":\"translation\"",
                      "\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":{}}"),
            "no error");
}

TEST_F(GltfMotion, MorphTargetsAddUp) {
  GltfBuilder b;
  const std::string one = b.positions({1, 0, 0, 0, 0, 0, 0, 0, 0});
  const std::string two = b.positions({0, 0, 2, 0, 0, 0, 0, 0, 0});
  const std::string primitive =
      triangle(b, ",\"targets\":[{\"POSITION\":" + one + "},{\"POSITION\":" + two + "}]");
  const std::string members =
      replaced(oneMesh(primitive), "]}],\"nodes\"", "],\"weights\":[0.5,0.25]}],\"nodes\"");
  expectNear(cornerOf(loadText(b.json(members)), 0, 0, 0), {0.5, 0, 0.5});

  // The weights of the node replace those of the mesh.
  const std::string own = replaced(members, "{\"mesh\":0}", "{\"mesh\":0,\"weights\":[0,1]}");
  expectNear(cornerOf(loadText(b.json(own)), 0, 0, 0), {0, 0, 2});

  // An animation replaces both.
  const std::string times = scalars(b, {0, 1}), weights = scalars(b, {0, 0, 1, 1});
  const std::string text =
      b.json(own + ",\"animations\":[" + animation(times, weights, 0, "weights") + "]");
  expectNear(movedCorner(at(0.5, text), 0), {0.5, 0, 1});
  expectNear(movedCorner(at(0.5, text), 1), {1, 0, 0});
  EXPECT_EQ(warned("morph targets left out"), 0u);
}

// A target without weight shows nothing that would be missing.
TEST_F(GltfMotion, MorphTargetsOfColorsAndCoordinatesAreSaidToBeLeftOut) {
  const char* const kind =
      "colors or texture coordinates of a morph target left out: they stay as they are";
  GltfBuilder b;
  const std::string moved = b.positions({1, 0, 0, 0, 0, 0, 0, 0, 0});
  const std::string primitive =
      triangle(b, ",\"targets\":[{\"POSITION\":" + moved + ",\"COLOR_0\":" + moved + "}]");
  const auto loadWeighted = [&](const std::string& weight) {
    loadText(b.json(replaced(oneMesh(primitive), "]}],\"nodes\"",
                             "],\"weights\":[" + weight + "]}],\"nodes\"")));
    return warned(kind);
  };
  EXPECT_EQ(loadWeighted("0"), 0u);
  EXPECT_EQ(loadWeighted("0.5"), 1u);
}

// Two joints lie one above the other, at heights 0 and 1. The upper one is turned by a right angle
// about z. The corners of the triangle lie at heights 0, 1 and 2.
class GltfSkin : public GltfMotion {
 protected:
  std::vector<float> xyz = {0, 0, 0, 1, 1, 0, 0, 2, 0};
  std::vector<std::uint16_t> joints = {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  std::vector<float> weights = {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0};
  std::string attributes;  // further attributes of the primitive

  // If `plays`, an animation turns the upper joint by 150 degrees.
  std::string text(const std::string& turn = "0,0,0.70710678,0.70710678",
                   bool plays = false) const {
    GltfBuilder b;
    const std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};

    b.positions(xyz);
    b.accessor(b.view(bytesOf(joints), 8), 5123, "VEC4", 3);
    b.accessor(b.view(bytesOf(weights), 16), 5126, "VEC4", 3);
    b.accessor(b.view(bytesOf(inverse)), 5126, "MAT4", 2);
    b.positions({0, 0, 1, 1, 0, 0, 0, 1, 0});

    const std::string times = scalars(b, {0, 1});
    const std::string rotations = fours(b, {0, 0, 0, 1, 0, 0, 0.96592583f, 0.25881905f});
    const std::string played =
        plays ? ",\"animations\":[" + animation(times, rotations, 2, "rotation") + "]" : "";

    return b.json(
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":"
        "2" +
        attributes +
        "}}]}],\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":3}],\"nodes\":[{\"mesh\":0,"
        "\"skin\":0,\"translation\":[50,0,0]},{\"children\":[2]},{\"translation\":[0,1,0],"
        "\"rotation\":[" +
        turn + "]}]" + played);
  }
};

// The position of the mesh's own node has no effect.
TEST_F(GltfSkin, VerticesFollowTheirJoints) {
  const SceneDescription scene = loadText(text());
  expectNear(cornerOf(scene, 0, 0, 0), {0, 0, 0});

  // This corner lies half at (1, 1), where the lower joint takes it, and half at (0, 2).
  expectNear(cornerOf(scene, 0, 0, 1), {0.5, 1.5, 0});
  expectNear(cornerOf(scene, 0, 0, 2), {-1, 1, 0});
}

TEST_F(GltfSkin, JointsArePlacedByHand) {
  options_.instant.movable = {"/nodes/2"};
  Scene scene = Scene::finalize(loadText(text("0,0,0,1")), warnings_);
  const Scene shared = scene;
  const auto corner = [](const Scene& of, std::size_t i) {
    return Vec3d(of.geometries.at(of.instances.at(0).geometry).position.at(i));
  };

  expectNear(corner(scene, 2), {0, 2, 0});
  const Affine turned{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
  setPlace(scene, "/nodes/2", turned);
  moveScene(scene, 0);

  expectNear(corner(scene, 0), {0, 0, 0});
  expectNear(corner(scene, 1), {0.5, 1.5, 0});
  expectNear(corner(scene, 2), {-1, 1, 0});

  // Copies that were made before keep their geometry.
  expectNear(corner(shared, 2), {0, 2, 0});
  EXPECT_THROW(setPlace(scene, "/nodes/1", turned), Error);
}

TEST_F(GltfSkin, TheSuppliedViewHoldsTheWholeAnimation) {
  Warnings none;
  Scene scene = Scene::finalize(at(0.2, text("0,0,0,1", true)), none);
  const double farthest = farthestInPicture(scene, scene.cameras.at(0), 0, 1);
  EXPECT_LT(farthest, 1);
  EXPECT_GT(farthest, 0.9);
}

// A joint that moves has thousands of children, three of which hold one corner each.
TEST_F(GltfSkin, ThousandsOfJointsHold) {
  constexpr std::uint16_t kJoints = 9000;
  std::string children, list, nodes;
  for (int i = 0; i < kJoints; ++i) {
    const std::string node = std::to_string(i + 2), comma = i == 0 ? "" : ",";
    children += comma + node;
    list += comma + node;
    nodes += ",{\"translation\":[" + std::to_string(i) + ",0,0]}";
  }

  GltfBuilder b;
  b.positions(xyz);
  b.accessor(b.view(bytesOf<std::uint16_t>({0, 0, 0, 0, 5000, 0, 0, 0, 8999, 0, 0, 0}), 8), 5123,
             "VEC4", 3);
  b.accessor(b.view(bytesOf<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 16), 5126, "VEC4", 3);

  const std::string times = scalars(b, {0, 2}), up = b.positions({0, 0, 0, 0, 2, 0});
  const SceneDescription scene = at(
      1, b.json("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,"
                "\"WEIGHTS_0\":2}}]}],\"skins\":[{\"joints\":[" +
                list + "]}],\"nodes\":[{\"mesh\":0,\"skin\":0},{\"children\":[" + children + "]}" +
                nodes + "],\"animations\":[" + animation(times, up, 1, "translation") + "]"));

  expectNear(movedCorner(scene, 0), {0, 1, 0});
  expectNear(movedCorner(scene, 1), {5001, 2, 0});
  expectNear(movedCorner(scene, 2), {8999, 3, 0});
}

TEST_F(GltfSkin, AtRestItIsAsItWasModelled) {
  const SceneDescription scene = loadText(text("0,0,0,1"));
  for (std::size_t i = 0; i < 3; ++i) {
    expectNear(cornerOf(scene, 0, 0, i), {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
  }
}

TEST_F(GltfSkin, NormalsTurnWithTheirJoints) {
  attributes = ",\"NORMAL\":4";
  const std::vector<Vec3f> normals = loadText(text()).objects.at(0).meshes.at(0).normals;
  ASSERT_EQ(normals.size(), 3u);
  expectNear(Vec3d(normals[0]), {0, 0, 1});
  expectNear(Vec3d(normals[1]), {std::sqrt(0.5), std::sqrt(0.5), 0});
  expectNear(Vec3d(normals[2]), {-1, 0, 0});
}

TEST_F(GltfSkin, FurtherSetsOfJointsCount) {
  attributes = ",\"JOINTS_1\":1,\"WEIGHTS_1\":2";  // the same joints once more
  expectNear(cornerOf(loadText(text()), 0, 0, 1), {0.5, 1.5, 0});
}

TEST_F(GltfSkin, WeightsAreScaledToOne) {
  weights[4] = weights[5] = 2;
  expectNear(cornerOf(loadText(text()), 0, 0, 1), {0.5, 1.5, 0});
}

TEST_F(GltfSkin, JointsThatAreMissingAreLeftOut) {
  joints[4] = 9;
  expectNear(cornerOf(loadText(text()), 0, 0, 1), {0, 2, 0});
  EXPECT_EQ(warned("joint that the skin does not have left out"), 1u);
  weights[5] = 0;
  // The node, at x = 50, would show the corner there without a skin.
  expectNear(cornerOf(loadText(text()), 0, 0, 1), {51, 1, 0});
  EXPECT_EQ(warned("vertex that no joint holds placed by its node"), 1u);
}

TEST_F(GltfSkin, MirroredSkinsKeepTheirFronts) {
  const std::string mirrored = replaced(
      replaced(text("0,0,0,1"), "{\"children\":[2]}", "{\"children\":[2],\"scale\":[-1,1,1]}"),
      "\"translation\":[50,0,0]", "\"translation\":[0,0,0]");
  const SceneDescription scene = loadText(mirrored);
  expectNear(cornerOf(scene, 0, 0, 2), {-1, 1, 0});
  expectNear(cornerOf(scene, 0, 0, 1), {0, 2, 0});
}

TEST_F(GltfSkin, BrokenSkinsAreRefused) {
  struct Case {
    const char *what, *by, *error;
  };
  const Case cases[] = {
      {"\"joints\":[1,2]", "\"joints\":[1,7]",
       "#/skins/0/joints/1: expected an index into nodes, from 0 to 2, found 7"},
      {"\"joints\":[1,2]", "\"joints\":[]",
       "#/skins/0/joints: expected at least one joint, found []"},
      {"\"joints\":[1,2]", "\"joints\":5", "#/skins/0/joints: expected a list, found 5"},
      {"\"inverseBindMatrices\":3", "\"inverseBindMatrices\":0",
       "#/accessors/0/type: expected MAT4, found \"VEC3\""},
      {"\"joints\":[1,2]", "\"joints\":[1,2,1]",
       "#/skins/0/inverseBindMatrices: expected a matrix for each of 3 joints, found 2"},
  };

  for (const Case& c : cases) {
    EXPECT_EQ(errorOfText(replaced(text(), c.what, c.by)), std::string("3 m.gltf") + c.error);
  }
}

}  // namespace
}  // namespace whit
