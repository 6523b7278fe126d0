// Exact spheres, and the ellipsoids that transforms make of them.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Spheres : public Agreement {
 protected:
  // Of any axes, and mirrored now and then.
  Transform stretched(Transform transform) {
    transform.scale = transform.scale * color(0.5, 1);
    if (chance(0.5)) transform.scale.x = -transform.scale.x;
    if (chance(0.2)) transform.scale.z = -transform.scale.z;
    transform.scale = asFloat(transform.scale);
    return transform;
  }

  // In one of `count` places beside each other: some round, most not.
  Transform ballStanding(int place, int count) {
    const Transform transform = standing(place, count);
    return chance(0.3) ? transform : stretched(transform);
  }

  double anyRadius() { return between(0.5, 0.9); }

  // Turned and stretched within what is turned and stretched: the axes of the unit sphere become no
  // axes of the ellipsoid. It hangs on another ball, which is smaller.
  void addSheared(const Material& material, const Transform& transform) {
    const int sheared = addSphere(0.8, material);
    const int holder = addSphere(0.25, matte());

    const Transform within = stretched(placement({0, 0.2, 0}, 1));
    scene.objects[holder].after.push_back({sheared, within, chance(0.5)});
    place(holder, stretched(transform), chance(0.5));
  }

  // Four in a row, of which the last is sheared.
  void addBalls(const std::function<Material()>& material) {
    for (int i = 0; i < 3; ++i) {
      const int ball = addSphere(anyRadius(), material());
      place(ball, ballStanding(i, 4));
    }
    addSheared(material(), standing(3, 4));
  }

  Material anyBallMaterial() {
    if (chance(0.3)) return mirror();
    if (chance(0.6)) return glossy();
    return matte();
  }

  Material anyFinish() {
    Material material = anyBallMaterial();
    if (chance(0.3)) material.emission = color(0, 1);
    return material;
  }

  // Among boxes, so that shadows of either fall on the other.
  void opaqueBalls() {
    room();
    addBalls([&] { return anyFinish(); });

    add(box(), glossy(), placement({-1, 2.2, 0.3}, 0.4));
    add(tetrahedron(), matte(), placement({1.2, 1, 1.2}, 0.5));
    addLamps(2);
  }

  Material anyPart() {
    Material material = chance(0.4) ? mirror() : glossy();
    material.coverage = between(0.1, 0.95);
    if (chance(0.5)) {
      material.coverage = between(0.5, 1);
      material.coverageMap = addMask();
    }
    material.castsShadow = material.coverage >= 0.5;
    return material;
  }

  Material film() {
    Material material = anyGlass();
    material.thin = true;
    return material;
  }

  Material water(int priority = 0) {
    Material material = anyGlass(priority);
    material.castsShadow = false;
    return material;
  }

  void roomBehindGlass() {
    room();
    thingsBehind();
    place(addSphere(0.4, anyFinish()), placement({0, 1.5, -2}, 1));
    addLamps(2);
  }

  // Within `reach` of the center, of some `radius`.
  void addGlassBall(const Vec& center, double reach, double radius, const Material& glass) {
    const Vec at = center + inBox(gray(-reach), gray(reach));
    const Transform transform = placement(at, 1);
    const bool round = chance(0.4);
    place(addSphere(radius, glass), round ? transform : stretched(transform));
  }

  // One within the other, and two that overlap.
  void nestedBalls(int outer, int inner, int left, int right) {
    roomBehindGlass();
    const Vec shells{-0.9, 1.1, 0.2}, pair{0.9, 1.1, 0.2};

    place(addSphere(0.8, anyGlass(outer)), placement(shells, 1));
    addGlassBall(shells, 0.1, 0.5, anyGlass(inner));
    addGlassBall(pair, 0.3, 0.7, anyGlass(left));
    addGlassBall(pair, 0.2, 0.8, anyGlass(right));
  }

  // Turned, stretched and mirrored uses of a few balls, one of them among others of an object.
  void usedOften(const std::function<Material()>& material) {
    room();
    const int balls[] = {addSphere(anyRadius(), material()), addSphere(anyRadius(), material()),
                         addSphere(0.4, material())};

    const Transform within = stretched(placement({0.3, 0.5, 0}, 0.6));
    scene.objects[balls[2]].after.push_back({balls[1], within, chance(0.7)});

    for (int i = 0; i < 9; ++i) {
      Transform transform = ballStanding(i % 5, 5);
      if (i >= 5) transform.translate += {0, 0.5, -1.5};
      transform.translate = asFloat(transform.translate);
      place(balls[i % 3], transform);
    }

    addLamps(2);
  }

  void opaqueInstances() {
    usedOften([&] { return anyFinish(); });
  }
};

TEST_F(Spheres, OpaqueOnesAndTheirShadows) {
  expectAgreement("opaque spheres", [&] { opaqueBalls(); });
  expectAgreement("opaque spheres, --terminator on", {.terminator = true}, [&] { opaqueBalls(); });
}

// Eyes and lights within a ball that has no other side.
TEST_F(Spheres, OpaqueOnesFromWithin) {
  expectAgreement("opaque spheres from within", [&] {
    opaqueBalls();
    const int shell = addSphere(12, anyFinish());
    place(shell, stretched(placement({0, 1, 0}, 1)));
  });
}

TEST_F(Spheres, Textures) {
  expectAgreementWithEachFilter("textured spheres", [&] {
    room();
    addBalls([&] { return painted(); });
    add(pane(), mirror(), placement({0.4, 2.3, -1.2}, 1.6));
    addLamps(2);
  });
}

// Matte: a lobe has no value for a viewer behind the normal.
TEST_F(Spheres, NormalMaps) {
  expectAgreementWithEachFilter("normal maps on spheres", [&] {
    room();
    addBalls([&] {
      Material material = matte();
      material.normalMap = addNormals(16);
      return material;
    });
    addLamps(2);
  });
}

// The far side is seen through what is cut out of the near one.
TEST_F(Spheres, AlphaMasks) {
  expectAgreement("masked spheres", [&] {
    room();
    addBalls([&] {
      Material material = chance(0.7) ? glossy() : mirror();
      material.alphaMap = addMask();
      if (chance(0.5)) material.alphaCutoff = between(0.3, 0.7);
      return material;
    });
    addLamps(2);
  });
}

TEST_F(Spheres, ThereInPart) {
  const auto ballsInPart = [&] {
    room();
    add(box(), glossy(), placement({-1.4, 0.8, -2}, 0.9));
    addBalls([&] { return chance(0.8) ? anyPart() : film(); });
    addLamps(2);
  };

  expectAgreement("spheres that are there in part", {.depth = 12}, ballsInPart);
  expectAgreement("spheres that are there in part, trilinear",
                  {.depth = 12, .filter = Filter::trilinear}, ballsInPart);
}

TEST_F(Spheres, Glass) {
  expectAgreement("glass spheres", [&] {
    roomBehindGlass();
    for (int i = 0; i < 3; ++i) {
      const Material glass = anyGlass();
      addGlassBall({1.4 * i - 1.4, 1.1, 0.2}, 0.1, 0.6, i == 1 ? coated(glass) : glass);
    }
  });
}

TEST_F(Spheres, NestedGlassOfEqualPriority) {
  expectAgreement("nested glass spheres, equal priorities", [&] { nestedBalls(0, 0, 2, 2); });
}

TEST_F(Spheres, NestedGlassOfUnequalPriority) {
  expectAgreement("nested glass spheres, unequal priorities", [&] {
    const bool innerWins = chance(0.5);
    nestedBalls(innerWins ? -1 : 0, innerWins ? 3 : -2, 1, 2);
  });
}

// A ball, a box and a ball, of any priorities.
TEST_F(Spheres, GlassAcrossBoxes) {
  expectAgreement("glass spheres across a box", [&] {
    roomBehindGlass();
    const Vec center{0, 1.2, 0.3};
    for (int i = 0; i < 3; ++i) {
      Material glass = anyGlass(below(3));
      glass.absorption = glass.absorption * 2;
      if (i == 1) {
        add(box(), glass, placement(center, 1));
      } else {
        addGlassBall(center, 0.4, 0.8, glass);
      }
    }
  });
}

// Two balls about the eye, of unequal priorities: of equal ones the ray that looks for them
// decides.
TEST_F(Spheres, EyesInside) {
  expectAgreement("eyes in spheres of a medium", [&] {
    opaqueBalls();
    const int innerWins = chance(0.5) ? 1 : -1;
    for (int i = 0; i < 2; ++i) {
      Material medium = water(i * innerWins);
      medium.absorption = color(0.1, 0.5);
      addGlassBall(scene.camera.eye, 0.2, 1.6 - 0.6 * i, medium);
    }
  });
}

// All that is seen lies in the ball: only absorption tells.
TEST_F(Spheres, EyesUnderWater) {
  expectAgreement("eyes in a sphere of water", [&] {
    opaqueBalls();
    addGlassBall({0, 0, 0}, 2, 40, water());
  });
}

// Each ray begins where it begins, in glass or beside it.
TEST_F(Spheres, ParallelRaysFromWithinGlassAndFromBeside) {
  expectAgreement("parallel rays across a sphere", [&] {
    opaqueBalls();
    scene.camera.orthographicHeight = 4;
    addGlassBall(scene.camera.eye, 0.6, 1.2, water());
  });
}

TEST_F(Spheres, Instances) {
  expectAgreement("instances of spheres", [&] { opaqueInstances(); });
}

TEST_F(Spheres, InstancesWithMaps) {
  const auto mapped = [&] {
    usedOften([&] {
      Material material = matte();
      material.diffuseMap = addColors();
      material.normalMap = addNormals(16);
      if (chance(0.4)) material.alphaMap = addMask();
      return material;
    });
  };

  expectAgreement("instances of spheres with maps", mapped);
  expectAgreement("instances of spheres with maps, trilinear", {.filter = Filter::trilinear},
                  mapped);
}

TEST_F(Spheres, InstancesFarFromTheOrigin) {
  const auto farAway = [&] {
    opaqueInstances();
    moveBy({150, -90, 120});
  };
  expectAgreement("instances of spheres far away", {}, farAway, 10);
}

// Copies of one object are one medium, each with its own surface.
TEST_F(Spheres, InstancesOfGlass) {
  expectAgreement("instances of glass spheres", [&] {
    roomBehindGlass();
    const int glass = addSphere(0.6, anyGlass(1));
    const int other = addSphere(0.5, anyGlass());
    for (int i = 0; i < 4; ++i) {
      const Vec at{0.8 * i - 1.2, 1.1, 0.3};
      const Vec beside = inBox(gray(-0.2), gray(0.2));
      place(i % 2 == 0 ? glass : other, stretched(placement(at + beside, 1)));
    }
  });
}

TEST_F(Spheres, Sampled) {
  expectAgreement("sampled spheres", {.depth = 2, .glossy = 16, .lightSamples = 8}, [&] {
    roomFromNear();
    scene.lights[0].radius = between(0.2, 0.6);
    addBalls([&] { return rough(); });
  });
}

}  // namespace
}  // namespace oracle
