// Exact spheres, and the ellipsoids that transforms make of them.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Spheres : public Agreement {};

// Of any axes, and mirrored now and then.
Transform stretched(SceneMaker& maker, Transform transform) {
  transform.scale = transform.scale * maker.random.color(0.5, 1);
  if (maker.random.chance(0.5)) transform.scale.x = -transform.scale.x;
  if (maker.random.chance(0.2)) transform.scale.z = -transform.scale.z;
  transform.scale = asFloat(transform.scale);
  return transform;
}

// In one of `count` places beside each other: some round, most not.
Transform ballStanding(SceneMaker& maker, int place, int count) {
  const Transform transform = maker.standing(place, count);
  return maker.random.chance(0.3) ? transform : stretched(maker, transform);
}

double anyRadius(SceneMaker& maker) { return maker.random.between(0.5, 0.9); }

// Turned and stretched within what is turned and stretched: the axes of the unit sphere become no
// axes of the ellipsoid. It hangs on another ball, which is smaller.
void addSheared(SceneMaker& maker, const Material& material, const Transform& transform) {
  const int sheared = maker.addSphere(0.8, material);
  const int holder = maker.addSphere(0.25, maker.matte());

  Body within;
  within.object = sheared;
  within.transform = stretched(maker, maker.random.placement({0, 0.2, 0}, 1));
  within.inPlace = maker.random.chance(0.5);

  maker.scene.objects[static_cast<std::size_t>(holder)].after.push_back(within);
  maker.place(holder, stretched(maker, transform), maker.random.chance(0.5));
}

// Four in a row, of which the last is sheared.
void addBalls(SceneMaker& maker, const std::function<Material()>& material) {
  for (int i = 0; i < 3; ++i) {
    const int ball = maker.addSphere(anyRadius(maker), material());
    maker.place(ball, ballStanding(maker, i, 4));
  }
  addSheared(maker, material(), maker.standing(3, 4));
}

Material anyBallMaterial(SceneMaker& maker) {
  if (maker.random.chance(0.3)) return maker.mirror();
  if (maker.random.chance(0.6)) return maker.glossy();
  return maker.matte();
}

Material anyFinish(SceneMaker& maker) {
  Material material = anyBallMaterial(maker);
  if (maker.random.chance(0.3)) material.emission = maker.random.color(0, 1);
  return material;
}

// Among boxes, so that shadows of either fall on the other.
void opaqueBalls(SceneMaker& maker) {
  maker.room();
  addBalls(maker, [&] { return anyFinish(maker); });

  maker.add(box(), maker.glossy(), maker.random.placement({-1, 2.2, 0.3}, 0.4));
  maker.add(tetrahedron(), maker.matte(), maker.random.placement({1.2, 1, 1.2}, 0.5));
  maker.addLamps(2);
}

TEST_F(Spheres, OpaqueOnesAndTheirShadows) {
  expectAgreement({"opaque spheres", opaqueBalls});
  expectAgreement({"opaque spheres, --terminator on", opaqueBalls, {.terminator = true}});
}

// Eyes and lights within a ball that has no other side.
TEST_F(Spheres, OpaqueOnesFromWithin) {
  expectAgreement({"opaque spheres from within", [](SceneMaker& maker) {
                     opaqueBalls(maker);
                     const int shell = maker.addSphere(12, anyFinish(maker));
                     maker.place(shell, stretched(maker, maker.random.placement({0, 1, 0}, 1)));
                   }});
}

void paintedBalls(SceneMaker& maker) {
  maker.room();
  addBalls(maker, [&] { return maker.painted(); });
  maker.add(pane(), maker.mirror(), maker.random.placement({0.4, 2.3, -1.2}, 1.6));
  maker.addLamps(2);
}

TEST_F(Spheres, Textures) { expectAgreementWithEachFilter({"textured spheres", paintedBalls}); }

// Matte: a lobe has no value for a viewer behind the normal.
void bumpyBalls(SceneMaker& maker) {
  maker.room();
  addBalls(maker, [&] {
    Material material = maker.matte();
    material.normalMap = maker.addData(16, 8, {80, 80, 200}, {176, 176, 255.99});
    return material;
  });
  maker.addLamps(2);
}

TEST_F(Spheres, NormalMaps) {
  expectAgreementWithEachFilter({"normal maps on spheres", bumpyBalls});
}

// The far side is seen through what is cut out of the near one.
void maskedBalls(SceneMaker& maker) {
  maker.room();
  addBalls(maker, [&] {
    Material material = maker.random.chance(0.7) ? maker.glossy() : maker.mirror();
    material.alphaMap = maker.addData(16, 8, {}, {255.99, 1, 1});
    if (maker.random.chance(0.5)) material.alphaCutoff = maker.random.between(0.3, 0.7);
    return material;
  });
  maker.addLamps(2);
}

TEST_F(Spheres, AlphaMasks) { expectAgreement({"masked spheres", maskedBalls}); }

Material anyPart(SceneMaker& maker) {
  Material material = maker.random.chance(0.4) ? maker.mirror() : maker.glossy();
  material.coverage = maker.random.between(0.1, 0.95);
  if (maker.random.chance(0.5)) {
    material.coverage = maker.random.between(0.5, 1);
    material.coverageMap = maker.addData(16, 8, {}, {255.99, 1, 1});
  }
  material.castsShadow = material.coverage >= 0.5;
  return material;
}

Material film(SceneMaker& maker) {
  Material material = maker.anyGlass();
  material.thin = true;
  return material;
}

void ballsInPart(SceneMaker& maker) {
  maker.room();
  maker.add(box(), maker.glossy(), maker.random.placement({-1.4, 0.8, -2}, 0.9));
  addBalls(maker, [&] { return maker.random.chance(0.8) ? anyPart(maker) : film(maker); });
  maker.addLamps(2);
}

TEST_F(Spheres, ThereInPart) {
  expectAgreement({"spheres that are there in part", ballsInPart, {.depth = 12}});
  expectAgreement({"spheres that are there in part, trilinear",
                   ballsInPart,
                   {.depth = 12, .filter = Filter::trilinear}});
}

void roomBehindGlass(SceneMaker& maker) {
  maker.room();
  maker.add(box(), maker.glossy(), maker.random.placement({-1.4, 0.8, -2}, 0.9));
  maker.add(tetrahedron(), maker.matte(), maker.random.placement({1.2, 0.9, -1.8}, 1));
  maker.place(maker.addSphere(0.4, anyFinish(maker)), maker.random.placement({0, 1.5, -2}, 1));
  maker.addLamps(2);
}

// Within `reach` of the center, of some `radius`.
void addGlassBall(SceneMaker& maker, const Vec& center, double reach, double radius,
                  const Material& glass) {
  const Vec at = center + maker.random.inBox(gray(-reach), gray(reach));
  const Transform transform = maker.random.placement(at, 1);
  const bool round = maker.random.chance(0.4);
  maker.place(maker.addSphere(radius, glass), round ? transform : stretched(maker, transform));
}

TEST_F(Spheres, Glass) {
  expectAgreement({"glass spheres", [](SceneMaker& maker) {
                     roomBehindGlass(maker);
                     for (int i = 0; i < 3; ++i) {
                       Material glass = maker.anyGlass();
                       if (i == 1) glass.mirror = maker.random.color(0.05, 0.2);
                       if (i == 1) glass.mirrorGrazing = maker.random.color(0.3, 0.6);
                       addGlassBall(maker, {1.4 * i - 1.4, 1.1, 0.2}, 0.1, 0.6, glass);
                     }
                   }});
}

// One within the other, and two that overlap.
void nestedBalls(SceneMaker& maker, int outer, int inner, int left, int right) {
  roomBehindGlass(maker);
  const Vec shells{-0.9, 1.1, 0.2}, pair{0.9, 1.1, 0.2};

  maker.place(maker.addSphere(0.8, maker.anyGlass(outer)), maker.random.placement(shells, 1));
  addGlassBall(maker, shells, 0.1, 0.5, maker.anyGlass(inner));
  addGlassBall(maker, pair, 0.3, 0.7, maker.anyGlass(left));
  addGlassBall(maker, pair, 0.2, 0.8, maker.anyGlass(right));
}

TEST_F(Spheres, NestedGlassOfEqualPriority) {
  expectAgreement({"nested glass spheres, equal priorities",
                   [](SceneMaker& maker) { nestedBalls(maker, 0, 0, 2, 2); }});
}

TEST_F(Spheres, NestedGlassOfUnequalPriority) {
  expectAgreement({"nested glass spheres, unequal priorities", [](SceneMaker& maker) {
                     if (maker.random.chance(0.5)) {
                       nestedBalls(maker, -1, 3, 1, 2);
                     } else {
                       nestedBalls(maker, 0, -2, 1, 2);
                     }
                   }});
}

// A ball, a box and a ball, of any priorities.
TEST_F(Spheres, GlassAcrossBoxes) {
  expectAgreement({"glass spheres across a box", [](SceneMaker& maker) {
                     roomBehindGlass(maker);
                     const Vec center{0, 1.2, 0.3};
                     for (int i = 0; i < 3; ++i) {
                       Material glass = maker.anyGlass(maker.random.below(3));
                       glass.absorption = glass.absorption * 2;
                       if (i == 1) {
                         maker.add(box(), glass, maker.random.placement(center, 1));
                       } else {
                         addGlassBall(maker, center, 0.4, 0.8, glass);
                       }
                     }
                   }});
}

// Two balls about the eye, of unequal priorities: of equal ones the ray that looks for them
// decides.
TEST_F(Spheres, EyesInside) {
  expectAgreement({"eyes in spheres of a medium", [](SceneMaker& maker) {
                     opaqueBalls(maker);
                     const int innerWins = maker.random.chance(0.5) ? 1 : -1;
                     for (int i = 0; i < 2; ++i) {
                       Material water = maker.anyGlass(i * innerWins);
                       water.castsShadow = false;
                       water.absorption = maker.random.color(0.1, 0.5);
                       addGlassBall(maker, maker.scene.camera.eye, 0.2, 1.6 - 0.6 * i, water);
                     }
                   }});
}

// All that is seen lies in the ball: only absorption tells.
TEST_F(Spheres, EyesUnderWater) {
  expectAgreement({"eyes in a sphere of water", [](SceneMaker& maker) {
                     opaqueBalls(maker);
                     Material water = maker.anyGlass();
                     water.castsShadow = false;
                     addGlassBall(maker, {0, 0, 0}, 2, 40, water);
                   }});
}

// Each ray begins where it begins, in glass or beside it.
TEST_F(Spheres, ParallelRaysFromWithinGlassAndFromBeside) {
  expectAgreement({"parallel rays across a sphere", [](SceneMaker& maker) {
                     opaqueBalls(maker);
                     maker.scene.camera.orthographicHeight = 4;
                     Material water = maker.anyGlass();
                     water.castsShadow = false;
                     addGlassBall(maker, maker.scene.camera.eye, 0.6, 1.2, water);
                   }});
}

// Turned, stretched and mirrored uses of a few balls, one of them among others of an object.
void usedOften(SceneMaker& maker, const std::function<Material()>& material) {
  maker.room();
  const int balls[] = {maker.addSphere(anyRadius(maker), material()),
                       maker.addSphere(anyRadius(maker), material()),
                       maker.addSphere(0.4, material())};

  Body within;
  within.object = balls[1];
  within.transform = stretched(maker, maker.random.placement({0.3, 0.5, 0}, 0.6));
  within.inPlace = maker.random.chance(0.7);
  maker.scene.objects[static_cast<std::size_t>(balls[2])].after.push_back(within);

  for (int i = 0; i < 9; ++i) {
    Transform transform = ballStanding(maker, i % 5, 5);
    if (i >= 5) transform.translate += {0, 0.5, -1.5};
    transform.translate = asFloat(transform.translate);
    maker.place(balls[i % 3], transform);
  }

  maker.addLamps(2);
}

void opaqueInstances(SceneMaker& maker) {
  usedOften(maker, [&] { return anyFinish(maker); });
}

TEST_F(Spheres, Instances) { expectAgreement({"instances of spheres", opaqueInstances}); }

TEST_F(Spheres, InstancesWithMaps) {
  const auto mapped = [](SceneMaker& maker) {
    usedOften(maker, [&] {
      Material material = maker.matte();
      material.diffuseMap = maker.addColors();
      material.normalMap = maker.addData(16, 8, {80, 80, 200}, {176, 176, 255.99});
      if (maker.random.chance(0.4)) {
        material.alphaMap = maker.addData(16, 8, {}, {255.99, 1, 1});
      }
      return material;
    });
  };

  expectAgreement({"instances of spheres with maps", mapped});
  expectAgreement(
      {"instances of spheres with maps, trilinear", mapped, {.filter = Filter::trilinear}});
}

TEST_F(Spheres, InstancesFarFromTheOrigin) {
  const auto make = [](SceneMaker& maker) {
    opaqueInstances(maker);
    maker.moveBy({150, -90, 120});
  };
  expectAgreement({"instances of spheres far away", make, {}, 10});
}

// Copies of one object are one medium, each with its own surface.
TEST_F(Spheres, InstancesOfGlass) {
  expectAgreement({"instances of glass spheres", [](SceneMaker& maker) {
                     roomBehindGlass(maker);
                     const int glass = maker.addSphere(0.6, maker.anyGlass(1));
                     const int other = maker.addSphere(0.5, maker.anyGlass());
                     for (int i = 0; i < 4; ++i) {
                       const Vec at{0.8 * i - 1.2, 1.1, 0.3};
                       const Vec beside = maker.random.inBox(gray(-0.2), gray(0.2));
                       maker.place(i % 2 == 0 ? glass : other,
                                   stretched(maker, maker.random.placement(at + beside, 1)));
                     }
                   }});
}

void roughBalls(SceneMaker& maker) {
  maker.roomFromNear();
  maker.scene.lights[0].radius = maker.random.between(0.2, 0.6);
  addBalls(maker, [&] { return maker.rough(); });
}

TEST_F(Spheres, Sampled) {
  expectAgreement({"sampled spheres", roughBalls, {.depth = 2, .glossy = 16, .lightSamples = 8}});
}

}  // namespace
}  // namespace oracle
