// Glass: tinted, absorbing, within and across other glass.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Dielectrics : public Agreement {};

// A room with something to see through glass.
void somethingBehind(SceneMaker& maker) {
  maker.room();
  maker.add(box(), maker.glossy(), maker.random.placement({-1.4, 0.8, -2}, 0.9));
  maker.add(tetrahedron(), maker.matte(), maker.random.placement({1.2, 0.9, -1.8}, 1));
  maker.addLamps(2);
}

Transform about(SceneMaker& maker, const Vec& center, double reach, double size) {
  return maker.random.placement(
      center + maker.random.inBox({-reach, -reach, -reach}, {reach, reach, reach}), size);
}

void someGlass(SceneMaker& maker) {
  somethingBehind(maker);
  for (int i = 0; i < 3; ++i) {
    Material glass = maker.anyGlass();
    if (i == 1) glass.mirror = maker.random.color(0.05, 0.2);
    if (i == 1) glass.mirrorGrazing = maker.random.color(0.3, 0.6);

    const Transform place = maker.standing(i, 3);
    const Mesh mesh = maker.random.chance(0.6) ? box() : tetrahedron();
    maker.add(mesh, glass, place);
  }
}

TEST_F(Dielectrics, BoxesAndTetrahedra) {
  expectAgreement({"dielectric boxes", someGlass, {.depth = 10}});
  expectAgreement({"--fresnel schlick", someGlass, {.schlickFresnel = true}});
}

TEST_F(Dielectrics, Balls) {
  expectAgreement({"dielectric balls", [](SceneMaker& maker) {
                     somethingBehind(maker);
                     for (int i = 0; i < 2; ++i) {
                       maker.add(ball(16, 10), maker.anyGlass(), maker.standing(i, 2));
                     }
                   }});
}

// One within the other, and two that overlap.
void nested(SceneMaker& maker, int outer, int inner, int left, int right) {
  somethingBehind(maker);
  const Vec shells{-0.9, 1.1, 0.2}, pair{0.9, 1.1, 0.2};

  maker.add(box(), maker.anyGlass(outer), maker.random.placement(shells, 1.3));
  maker.add(box(), maker.anyGlass(inner), about(maker, shells, 0.1, 0.6));
  maker.add(box(), maker.anyGlass(left), about(maker, pair, 0.3, 1));
  maker.add(tetrahedron(), maker.anyGlass(right), about(maker, pair, 0.2, 1.3));
}

TEST_F(Dielectrics, NestedOnesOfEqualPriority) {
  expectAgreement(
      {"equal priorities", [](SceneMaker& maker) { nested(maker, 0, 0, 2, 2); }, {.depth = 10}});
}

TEST_F(Dielectrics, NestedOnesOfUnequalPriority) {
  expectAgreement({"unequal priorities",
                   [](SceneMaker& maker) {
                     if (maker.random.chance(0.5)) {
                       nested(maker, -1, 3, 1, 2);
                     } else {
                       nested(maker, 0, -2, 1, 2);
                     }
                   },
                   {.depth = 10}});
}

// Solids of one filling are one solid, where nothing else wins.
TEST_F(Dielectrics, OverlappingOnesOfOneMedium) {
  expectAgreement({"one medium",
                   [](SceneMaker& maker) {
                     somethingBehind(maker);
                     const Material glass = maker.anyGlass(1);
                     for (int i = 0; i < 3; ++i) {
                       Material alike = maker.glass(glass.ior, i == 2 ? 0 : 1);
                       alike.absorption = glass.absorption;
                       maker.add(box(), alike, about(maker, {0, 1.1, 0.2}, 0.3, 1.1));
                     }
                   },
                   {.depth = 10}});
}

TEST_F(Dielectrics, ThreeThatOverlap) {
  expectAgreement({"three media",
                   [](SceneMaker& maker) {
                     somethingBehind(maker);
                     const bool equal = maker.random.chance(0.4);
                     for (int i = 0; i < 3; ++i) {
                       const int priority = equal ? 0 : maker.random.below(3);
                       Material glass = maker.anyGlass(priority);
                       glass.absorption = glass.absorption * 3;
                       const Vec center{0, 1.2, 0.3};
                       if (i == 1) {
                         maker.add(tetrahedron(), glass, about(maker, center, 0.35, 1.7));
                       } else {
                         maker.add(box(), glass, about(maker, center, 0.35, 1.4));
                       }
                     }
                   },
                   {.depth = 12}});
}

// As many as a ray can be inside of at a time.
TEST_F(Dielectrics, FourWithinEachOther) {
  expectAgreement({"four media",
                   [](SceneMaker& maker) {
                     somethingBehind(maker);
                     for (int i = 0; i < 4; ++i) {
                       const double size = 1.7 - 0.38 * i;
                       maker.add(box(), maker.anyGlass(maker.random.below(3)),
                                 about(maker, {0, 1.2, 0.3}, 0.25, size));
                     }
                   },
                   {.depth = 10}});
}

// Copies of one object are one medium, each with its own surface.
TEST_F(Dielectrics, Instances) {
  expectAgreement({"dielectric instances",
                   [](SceneMaker& maker) {
                     somethingBehind(maker);
                     const int glass = maker.addObject(box(), maker.anyGlass(1));
                     const int other = maker.addObject(tetrahedron(), maker.anyGlass());
                     for (int i = 0; i < 4; ++i) {
                       maker.place(i % 2 == 0 ? glass : other,
                                   about(maker, {0.8 * i - 1.2, 1.1, 0.3}, 0.2, 0.9));
                     }
                   },
                   {.depth = 10}});
}

}  // namespace
}  // namespace oracle
