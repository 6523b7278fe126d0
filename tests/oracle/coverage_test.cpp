// Surfaces that are there in part, and sheets that light goes straight through.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Coverage : public Agreement {
 protected:
  // Shadows follow from the share, unless the file says otherwise.
  Material inPart(Material material) {
    material.coverage = between(0.1, 0.95);
    const bool asItFollows = chance(0.7);
    material.castsShadow = (material.coverage >= 0.5) == asItFollows;
    return material;
  }

  Material anySheet() {
    switch (below(5)) {
      case 0:
        return inPart(matte());
      case 1:
        return inPart(glossy());
      case 2:
        return inPart(mirror());
      case 3: {
        Material clear = inPart(glass(1.5));
        clear.diffuse = color(0, 0.5);
        if (chance(0.5)) clear.mirror = color(0.1, 0.6);
        return clear;
      }
      default: {
        Material film = anyGlass(below(5));
        film.thin = true;
        if (chance(0.5)) film.mirror = color(0.05, 0.4);
        if (chance(0.3)) film.emission = color(0, 0.3);
        return film;
      }
    }
  }

  void litRoomWithSomethingBehind() {
    room();
    add(box(), glossy(), placement({-1.4, 0.8, -2}, 0.9));
    add(tetrahedron(), mirror(), placement({1.2, 0.9, -1.8}, 1));
    addLamps(2);
  }

  // From nothing to all, over whole texels and between them.
  int addShares() {
    Texture texture{16, 8, {}, true};
    for (int i = 0; i < texture.width * texture.height; ++i) {
      const int share = below(256), kind = below(4);
      texture.texels.push_back({kind > 1 ? share : 255 * kind, 0, 0});
    }
    return addTexture(texture);
  }

  // Face in face with opaque blocks, with glass and with each other.
  Transform onTheGrid(bool flat) {
    const auto size = [&] { return 0.5 + 0.5 * below(3); };
    Transform transform;
    transform.scale = {size(), flat ? 1 : size(), size()};
    const Vec low{0.5 * below(5) - 1.5, 0.5 * below(3), 0.5 * below(5) - 1.5};
    transform.translate = low + transform.scale / 2;
    if (flat) transform.translate.y = low.y;
    return transform;
  }

  Material besideOthers(int i) {
    if (i % 3 == 0) return anyGlass(i);
    return i % 6 == 4 ? glossy() : anySheet();
  }
};

// Seen from both sides: what is closed is left through its back faces.
TEST_F(Coverage, SheetsInARoom) {
  expectAgreement("sheets", {.depth = 12}, [&] {
    litRoomWithSomethingBehind();
    for (int i = 0; i < 4; ++i) add(solid(), anySheet(), standing(i, 4));

    const int veil = addObject(pane(), anySheet());
    for (int i = 0; i < 3; ++i) {
      Transform at = placement({0.5 * i - 0.5, 1.2, 1 + 0.4 * i}, 1);
      at.axis = {1, 0.2, 0.1};
      place(veil, at);
    }
  });
}

TEST_F(Coverage, Maps) {
  expectAgreementWithEachFilter("coverage maps", [&] {
    litRoomWithSomethingBehind();

    for (int i = 0; i < 4; ++i) {
      Material material = chance(0.5) ? glossy() : mirror();
      material.coverageMap = addShares();
      if (i % 2 == 1) material.coverage = between(0.5, 1);
      if (i == 2) {
        material.transmission = color(0.2, 0.9);
        material.thin = true;
        material.castsShadow = false;
      }

      if (i == 3) material.alphaMap = addShares();
      add(turnedPane(i == 0 ? 3 : 0.7), material, standing(i, 4));
    }
  });
}

// Within glass, across its faces, and around it.
TEST_F(Coverage, InGlass) {
  expectAgreement("sheets in glass", {.depth = 12}, [&] {
    litRoomWithSomethingBehind();
    const Vec left{-0.9, 1.2, 0.3}, right{0.9, 1.2, 0.3};
    for (const Vec& center : {left, right}) {
      const int priority = below(2);
      add(box(), anyGlass(priority), placement(center, 1.4));
      add(box(), anyGlass(2), placement(center + inBox({-0.3, -0.3, 0}, {0.3, 0.3, 0.5}), 0.8));
      add(pane(), anySheet(), placement(center, 1.9));
      add(box(), anySheet(), placement(center, 0.7));
    }
  });
}

TEST_F(Coverage, FaceInFace) {
  expectAgreement("coplanar sheets", {.depth = 12}, [&] {
    room();
    scene.bodies.back().transform.translate.y = 0;
    scene.camera.eye.y = between(1.6, 4);
    addLamps(1);

    const int twice = addObject(box(), anySheet());
    for (int i = 0; i < 12; ++i) {
      const bool flat = i % 3 == 2;
      const Transform transform = onTheGrid(flat);
      const int object = i % 6 == 1 ? twice : addObject(flat ? pane() : box(), besideOthers(i));
      place(object, transform);
    }
  });
}

// Of the lobe of what is there in part, and of lights upon it.
TEST_F(Coverage, Sampled) {
  expectAgreement("sampled sheets", {.depth = 3, .glossy = 16, .lightSamples = 8}, [&] {
    roomFromNear();
    scene.lights[0].radius = between(0.2, 0.6);
    for (int i = 0; i < 3; ++i) {
      Material material = rough();
      if (i < 2) material = inPart(material);
      add(box(), material, standing(i, 3));
    }
  });
}

}  // namespace
}  // namespace oracle
