// "motion" in scene files, against positions worked out by hand.

#include "bake/edit_scene.h"
#include "scene_files.h"

namespace whit {
namespace {

class SceneMotionFile : public SceneFileTest {
 protected:
  // Returns an item with this "motion" and these other members.
  static std::string item(const std::string& motion, const std::string& rest = "") {
    return "{'shape': 'sphere', " + rest + "'motion': {" + motion + "}}";
  }

  static std::string scene(const std::string& items) { return "'scene': [" + items + "]"; }

  SceneDescription at(double seconds, const std::string& members) {
    options_.instant.seconds = seconds;
    return loadMembers(members);
  }

  // Returns where the sphere of the first instance has `point` at the scene's time.
  static Vec3d placed(const SceneDescription& scene, const Vec3d& point = {}) {
    const Instance& instance = scene.instances.at(0);
    const std::vector<Affine> poses = poseRig(scene.motion.rig, scene.motion.seconds);
    const Affine map =
        instance.mover == kNoNode ? instance.toWorld : poses.at(instance.mover) * instance.toWorld;
    return (map * scene.objects.at(instance.object).meshes.at(0).spheres.at(0)).point(point);
  }
};

TEST_F(SceneMotionFile, KeysScaleThenTurnThenTranslate) {
  const std::string moving =
      scene(item("'keys': [{'time': 1}, {'time': 3, 'translate': [4, 0, 2], 'rotate': [0, 0, 2, "
                 "180], 'scale': [3, 1, 1]}]"));

  expectNear(placed(at(0, moving), {1, 0, 0}), {1, 0, 0});
  expectNear(placed(at(2, moving), {1, 0, 0}), {2, 2, 1});
  expectNear(placed(at(9, moving), {1, 0, 0}), {1, 0, 2});
}

// Far from the origin, `at` is moved so far ahead that its rounding does not turn the view.
TEST_F(SceneMotionFile, CamerasKeepTheirPlaneOfFocus) {
  const std::string moving =
      "'cameras': {'a': {'eye': [1000, 0, 0], 'at': [1000, 0, -5], 'aperture': 0.5, 'motion': "
      "{'keys': [{'time': 0}, {'time': 1, 'translate': [0, 4, 0]}]}}}";

  const Camera camera = at(1, moving).cameras.at(0);
  EXPECT_GT(length(Vec3d(camera.at) - Vec3d(camera.eye)), 50);
  EXPECT_NEAR(camera.focusDistance(), 5, 1e-6);
}

TEST_F(SceneMotionFile, AnItemIsMovedFromWhereItsTransformPutsIt) {
  const std::string moving =
      scene(item("'keys': [{'time': 0}, {'time': 1, 'rotate': [0, 1, 0, 90]}]",
                 "'transform': {'translate': [2, 1, 0]}, "));
  expectNear(placed(at(1, moving)), {0, 1, -2});
}

TEST_F(SceneMotionFile, GroupsCarryWhatMovesInThem) {
  const std::string moon = item("'keys': [{'time': 0}, {'time': 1, 'rotate': [0, 1, 0, 180]}]",
                                "'transform': {'translate': [1, 0, 0]}, ");

  const std::string moving = scene("{'group': [{'group': [" + moon +
                                   "], 'transform': {'translate': [5, 0, 0]}}], 'motion': {'keys': "
                                   "[{'time': 0}, {'time': 1, 'rotate': [0, 1, 0, 90]}]}}");

  expectNear(placed(at(1, moving)), {0, 0, -4});
  expectNear(placed(at(0.5, moving)),
             {5 * std::sqrt(0.5) - std::sqrt(0.5), 0, -5 * std::sqrt(0.5) - std::sqrt(0.5)});
}

TEST_F(SceneMotionFile, StepsHoldAndCurvesGoThroughTheirKeys) {
  const auto keys = [](const std::string& interpolation) {
    return scene(
        item("'interpolation': '" + interpolation +
             "', 'keys': [{'time': 0, 'translate': [1, 0, 0]}, {'time': 1, 'translate': [3, 0, "
             "0]}, {'time': 2, 'translate': [9, 0, 0]}, {'time': 3, 'translate': [2, 0, 0]}]"));
  };

  expectNear(placed(at(1.9, keys("step"))), {3, 0, 0});
  expectNear(placed(at(2, keys("cubic"))), {9, 0, 0});
  expectNear(placed(at(1.5, keys("cubic"))), {(-1 + 9 * 3 + 9 * 9 - 2) / 16.0, 0, 0});
}

TEST_F(SceneMotionFile, LoopsBeginAgain) {
  const std::string line = "'keys': [{'time': 1}, {'time': 3, 'translate': [4, 0, 0]}], 'loop': ";
  expectNear(placed(at(3.5, scene(item(line + "true")))), {1, 0, 0});
  expectNear(placed(at(0.5, scene(item(line + "true")))), {3, 0, 0});
  expectNear(placed(at(3.5, scene(item(line + "false")))), {4, 0, 0});

  // 0.6 is a little less than three times 0.2.
  const std::string steps =
      "'interpolation': 'step', 'loop': true, 'keys': [{'time': 0}, {'time': 0.1, 'translate': "
      "[1, 0, 0]}, {'time': 0.2, 'translate': [2, 0, 0]}]";
  for (const double seconds : {0.2, 0.4, 0.6, 1.2}) {
    expectNear(placed(at(seconds, scene(item(steps)))), {0, 0, 0});
  }
}

// In a closed loop the speed at the end is that at the beginning. It points from the key before to
// the key after, which are three seconds apart.
TEST_F(SceneMotionFile, ClosedCurvesGoOnWhereTheyBegan) {
  const std::string closed =
      scene(item("'interpolation': 'cubic', 'loop': true, 'keys': [{'time': 0}, {'time': 1, "
                 "'translate': [3, 0, 0]}, {'time': 2, 'translate': [0, 5, 0]}, {'time': 4}]"));

  constexpr double kStep = 1e-4, kCurvature = 1e-2;
  const Vec3d before = placed(at(4 - kStep, closed)), after = placed(at(4 + kStep, closed));
  const Vec3d step = Vec3d(3, -5, 0) / 3.0 * kStep;

  EXPECT_LT(length(after - step), kCurvature * length(step));
  EXPECT_LT(length(before + step), kCurvature * length(step));
}

TEST_F(SceneMotionFile, CamerasAndLightsAreCarried) {
  const std::string moving =
      "'cameras': {'c': {'eye': [0, 0, 4], 'at': [0, 0, 0], 'motion': {'keys': [{'time': 0}, "
      "{'time': 2, 'rotate': [0, 1, 0, 180]}]}}}, 'lights': [{'type': 'spot', 'position': [1, 0, "
      "0], 'direction': [1, 0, 0], 'intensity': 1, 'motion': {'keys': [{'time': 0, 'translate': "
      "[0, 1, 0]}, {'time': 2, 'translate': [0, 3, 0], 'rotate': [0, 0, 1, 90]}]}}]";

  const Scene later = bake(at(2, moving));
  expectNearInFloat(later.cameras.at(0).eye, {0, 0, -4});
  expectNearInFloat(later.cameras.at(0).at, {});
  expectNearInFloat(later.lights.at(0).position, {0, 4, 0});
  expectNearInFloat(later.lights.at(0).direction, {0, 1, 0});

  options_.instant = {};
  EXPECT_EQ(loadMembers(moving).lights.at(0).position, (Vec3f{1, 1, 0}));
}

// At an instant the camera of the path comes before the cameras of the file.
TEST_F(SceneMotionFile, CamerasMoveBesideAPath) {
  const Scene later =
      bake(at(1,
              "'cameras': {'c': {'eye': [0, 0, 4], 'at': [0, 0, 0], 'motion': {'keys': [{'time': "
              "0}, {'time': 1, 'translate': [1, 0, 0]}]}}}, 'path': [{'time': 0, 'eye': [0, 0, "
              "9]}, {'time': 2, 'eye': [0, 2, 9]}]"));

  ASSERT_EQ(later.cameras.size(), 2u);
  EXPECT_EQ(later.cameras[0].eye, (Vec3f{0, 1, 9}));
  EXPECT_EQ(later.cameras[1].eye, (Vec3f{1, 0, 4}));
}

// In a film along the path nothing but the camera moves.
TEST_F(SceneMotionFile, APathMovesTheCameraAlone) {
  const std::string flown =
      scene(
          "{'shape': 'box'}, {'shape': 'box', 'repeat': {'count': [2, 1, 1], 'step': [3, 0, 0]}}") +
      ", 'path': [{'time': 0, 'eye': [0, 0, 9]}, {'time': 2, 'eye': [0, 2, 9]}]";
  options_.instant.plays = options_.instant.alongPath = true;
  Scene film = bake(loadMembers(flown));
  EXPECT_FALSE(film.motion.empty());
  EXPECT_FALSE(film.motion.ofGeometry);
  EXPECT_EQ(film.cameras.at(0).eye, (Vec3f{0, 0, 9}));

  moveScene(film, 1);
  EXPECT_EQ(film.cameras.at(0).eye, (Vec3f{0, 1, 9}));
  EXPECT_EQ(film.cameras.at(0).name, "path");
  EXPECT_EQ(cameraAt(film, 0, 2).eye, (Vec3f{0, 2, 9}));
}

// Without a time the scene is as at 0, and is not prepared for motion.
TEST_F(SceneMotionFile, NothingIsPaidForWhereNoTimeIsGiven) {
  const std::string moving = scene(
      item("'keys': [{'time': -1}, {'time': 1, 'translate': [4, 0, 0]}]") + ", {'shape': 'box'}");

  const SceneDescription still = loadMembers(moving);
  EXPECT_TRUE(still.motion.rig.empty());
  expectNear(placed(still), {2, 0, 0});

  ASSERT_EQ(still.animations.size(), 1u);
  EXPECT_EQ(still.animations[0].name, kSceneMotion);
  EXPECT_EQ(still.animations[0].seconds, 1);
  EXPECT_EQ(still.animations[0].nodes, 1u);

  EXPECT_TRUE(bake(loadMembers(moving)).instances.empty());
  const Scene played = bake(at(0, moving));
  EXPECT_EQ(played.instances.size(), 1u);
  EXPECT_EQ(played.geometries.at(0).index.size(), 12u);  // the box
}

TEST_F(SceneMotionFile, MistakesAreNamed) {
  const auto error = [&](const std::string& motion) { return errorOfMembers(scene(item(motion))); };
  const std::string place = "3 s.json#/scene/0/motion/keys";

  expectErrors(
      error,
      {
          {"'keys': []", place + ": expected at least one key, found []"},
          {"'keys': [{}]", place + "/0: expected a member \"time\""},
          {"'keys': [{'time': 1}, {'time': 1}]",
           place + "/1/time: expected a time after that of the key before, found 1"},
          {"'keys': [{'time': 1, 'scale': [1, 0, 1]}]",
           place + "/0/scale: expected a scale above 0, found [1,0,1]"},
          {"'keys': [{'time': 1, 'rotate': [0, 0, 0, 1]}]",
           place + "/0/rotate: expected an axis other than 0, found [0,0,0,1]"},
          {"'keys': [{'time': 1, 'rotate': [0, 0, 1, 1]}, {'time': 2, 'rotate': [0, 1, 0, 1]}]",
           place + "/1/rotate: expected the axis of the keys before: groups turn about several, "
                   "found [0,1,0,1]"},

          {"'keys': [{'time': 1}], 'interpolation': 'cubik'",
           "3 s.json#/scene/0/motion/interpolation: expected one of \"linear\", \"step\", "
           "\"cubic\" (is \"cubic\" meant?), found \"cubik\""},
          {"'keys': [{'time': 1}], 'looop': true",
           "3 s.json#/scene/0/motion/looop: unknown key (is \"loop\" meant?)"},
      });
}

}  // namespace
}  // namespace whit
