// Glass: tinted, absorbing, within and across other glass.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Dielectrics : public Agreement {
 protected:
  // A room with something to see through glass.
  void somethingBehind() {
    room();
    thingsBehind();
    addLamps(2);
  }

  Transform about(const Vec& center, double reach, double size) {
    return placement(center + inBox(gray(-reach), gray(reach)), size);
  }

  // One within the other, and two that overlap.
  void nested(int outer, int inner, int left, int right) {
    somethingBehind();
    const Vec shells{-0.9, 1.1, 0.2}, pair{0.9, 1.1, 0.2};

    add(box(), anyGlass(outer), placement(shells, 1.3));
    add(box(), anyGlass(inner), about(shells, 0.1, 0.6));
    add(box(), anyGlass(left), about(pair, 0.3, 1));
    add(tetrahedron(), anyGlass(right), about(pair, 0.2, 1.3));
  }
};

TEST_F(Dielectrics, BoxesAndTetrahedra) {
  const auto someGlass = [&] {
    somethingBehind();
    for (int i = 0; i < 3; ++i) {
      const Material glass = anyGlass();
      add(chance(0.6) ? box() : tetrahedron(), i == 1 ? coated(glass) : glass, standing(i, 3));
    }
  };

  expectAgreement("dielectric boxes", {.depth = 10}, someGlass);
  expectAgreement("--fresnel schlick", {.schlickFresnel = true}, someGlass);
}

TEST_F(Dielectrics, Balls) {
  expectAgreement("dielectric balls", [&] {
    somethingBehind();
    for (int i = 0; i < 2; ++i) add(ball(16, 10), anyGlass(), standing(i, 2));
  });
}

TEST_F(Dielectrics, NestedOnesOfEqualPriority) {
  expectAgreement("equal priorities", {.depth = 10}, [&] { nested(0, 0, 2, 2); });
}

TEST_F(Dielectrics, NestedOnesOfUnequalPriority) {
  expectAgreement("unequal priorities", {.depth = 10}, [&] {
    const bool innerWins = chance(0.5);
    nested(innerWins ? -1 : 0, innerWins ? 3 : -2, 1, 2);
  });
}

// Solids of one filling are one solid, where nothing else wins.
TEST_F(Dielectrics, OverlappingOnesOfOneMedium) {
  expectAgreement("one medium", {.depth = 10}, [&] {
    somethingBehind();
    const Material first = anyGlass(1);
    for (int i = 0; i < 3; ++i) {
      Material alike = glass(first.ior, i == 2 ? 0 : 1);
      alike.absorption = first.absorption;
      add(box(), alike, about({0, 1.1, 0.2}, 0.3, 1.1));
    }
  });
}

TEST_F(Dielectrics, ThreeThatOverlap) {
  expectAgreement("three media", {.depth = 12}, [&] {
    somethingBehind();
    const bool equal = chance(0.4);
    for (int i = 0; i < 3; ++i) {
      Material glass = anyGlass(equal ? 0 : below(3));
      glass.absorption = glass.absorption * 3;
      const bool sharp = i == 1;
      add(sharp ? tetrahedron() : box(), glass, about({0, 1.2, 0.3}, 0.35, sharp ? 1.7 : 1.4));
    }
  });
}

// As many as a ray can be inside of at a time.
TEST_F(Dielectrics, FourWithinEachOther) {
  expectAgreement("four media", {.depth = 10}, [&] {
    somethingBehind();
    for (int i = 0; i < 4; ++i) {
      const double size = 1.7 - 0.38 * i;
      add(box(), anyGlass(below(3)), about({0, 1.2, 0.3}, 0.25, size));
    }
  });
}

// Copies of one object are one medium, each with its own surface.
TEST_F(Dielectrics, Instances) {
  expectAgreement("dielectric instances", {.depth = 10}, [&] {
    somethingBehind();
    const int glass = addObject(box(), anyGlass(1));
    const int other = addObject(tetrahedron(), anyGlass());
    for (int i = 0; i < 4; ++i) {
      place(i % 2 == 0 ? glass : other, about({0.8 * i - 1.2, 1.1, 0.3}, 0.2, 0.9));
    }
  });
}

}  // namespace
}  // namespace oracle
