// Where rays begin: parallel ones, and eyes within glass and water.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Cameras : public Agreement {};

void someSolids(SceneMaker& maker) {
  maker.room();
  for (int i = 0; i < 3; ++i) {
    const bool mirror = maker.random.chance(0.3);
    const Transform place = maker.standing(i, 3);
    const Material material = mirror ? maker.mirror() : maker.glossy();
    const Mesh mesh = i == 1 ? ball(12, 8) : maker.solid();
    maker.add(mesh, material, place);
  }
  maker.addLamps(2);
}

// A box about the point; its absorption shows at once, its tint only from outside.
void fillAround(SceneMaker& maker, const Vec& center, double size, int priority,
                bool absorbs = true) {
  Material water = maker.glass(maker.random.between(1.2, 1.6), priority);
  water.castsShadow = false;
  water.absorption = absorbs ? maker.random.color(0.1, 0.5) : gray(0);
  maker.add(box(), water, maker.random.placement(center, size));
}

TEST_F(Cameras, ParallelRays) {
  expectAgreement({"parallel camera", [](SceneMaker& maker) {
                     someSolids(maker);
                     maker.scene.camera.orthographicHeight = maker.random.between(2.5, 4);
                   }});
}

TEST_F(Cameras, EyesInsideAClearMedium) {
  expectAgreement({"eye in a clear medium", [](SceneMaker& maker) {
                     someSolids(maker);
                     fillAround(maker, maker.scene.camera.eye, 2.5, 0, false);
                     fillAround(maker, maker.scene.camera.eye, 1, 1, false);
                   }});
}

TEST_F(Cameras, EyesInsideAMedium) {
  expectAgreement({"eye in a medium", [](SceneMaker& maker) {
                     someSolids(maker);
                     fillAround(maker, maker.scene.camera.eye, 2, 0);
                   }});
}

// All that is seen lies in the water, the floor as well: only absorption tells.
TEST_F(Cameras, EyesUnderWater) {
  expectAgreement({"eye under water", [](SceneMaker& maker) {
                     someSolids(maker);
                     fillAround(maker, {0, 0, 0}, 30, 0);
                   }});
}

TEST_F(Cameras, EyesInsideNestedMedia) {
  expectAgreement({"eye in nested media",
                   [](SceneMaker& maker) {
                     someSolids(maker);
                     const bool innerWins = maker.random.chance(0.5);
                     fillAround(maker, maker.scene.camera.eye, 2.5, 0);
                     fillAround(maker, maker.scene.camera.eye, 1, innerWins ? 1 : -1);
                   },
                   {.depth = 10}});
}

// Each ray begins where it begins, in glass or beside it.
TEST_F(Cameras, ParallelRaysFromWithinAMediumAndFromBeside) {
  expectAgreement({"parallel camera across a medium", [](SceneMaker& maker) {
                     someSolids(maker);
                     maker.scene.camera.orthographicHeight = 4;
                     const bool eyeInside = maker.random.chance(0.5);
                     const Vec aside{eyeInside ? 0.4 : 1.6, 0, 0};
                     fillAround(maker, maker.scene.camera.eye + aside, 1.6, 0);
                   }});
}

}  // namespace
}  // namespace oracle
