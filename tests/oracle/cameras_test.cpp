// Where rays begin: parallel ones, and eyes within glass and water.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Cameras : public Agreement {
 protected:
  void someSolids() {
    room();
    for (int i = 0; i < 3; ++i) {
      const Material material = chance(0.3) ? mirror() : glossy();
      add(i == 1 ? ball(12, 8) : solid(), material, standing(i, 3));
    }
    addLamps(2);
  }

  // A box about the point; its absorption shows at once, its tint only from outside.
  void fillAround(const Vec& center, double size, int priority, bool absorbs = true) {
    Material water = glass(between(1.2, 1.6), priority);
    water.castsShadow = false;
    water.absorption = absorbs ? color(0.1, 0.5) : gray(0);
    add(box(), water, placement(center, size));
  }
};

TEST_F(Cameras, ParallelRays) {
  expectAgreement("parallel camera", [&] {
    someSolids();
    scene.camera.orthographicHeight = between(2.5, 4);
  });
}

TEST_F(Cameras, EyesInsideAClearMedium) {
  expectAgreement("eye in a clear medium", [&] {
    someSolids();
    fillAround(scene.camera.eye, 2.5, 0, false);
    fillAround(scene.camera.eye, 1, 1, false);
  });
}

TEST_F(Cameras, EyesInsideAMedium) {
  expectAgreement("eye in a medium", [&] {
    someSolids();
    fillAround(scene.camera.eye, 2, 0);
  });
}

// All that is seen lies in the water, the floor as well: only absorption tells.
TEST_F(Cameras, EyesUnderWater) {
  expectAgreement("eye under water", [&] {
    someSolids();
    fillAround({0, 0, 0}, 30, 0);
  });
}

TEST_F(Cameras, EyesInsideNestedMedia) {
  expectAgreement("eye in nested media", {.depth = 10}, [&] {
    someSolids();
    const bool innerWins = chance(0.5);
    fillAround(scene.camera.eye, 2.5, 0);
    fillAround(scene.camera.eye, 1, innerWins ? 1 : -1);
  });
}

// Each ray begins where it begins, in glass or beside it.
TEST_F(Cameras, ParallelRaysFromWithinAMediumAndFromBeside) {
  expectAgreement("parallel camera across a medium", [&] {
    someSolids();
    scene.camera.orthographicHeight = 4;
    const bool eyeInside = chance(0.5);
    const Vec aside{eyeInside ? 0.4 : 1.6, 0, 0};
    fillAround(scene.camera.eye + aside, 1.6, 0);
  });
}

}  // namespace
}  // namespace oracle
