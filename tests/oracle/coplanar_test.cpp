// Faces in one place: blocks that stand on a floor and on each other, face in face, and decals.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Coplanar : public Agreement {
 protected:
  // On a grid: corners are exact, so that faces in one plane are in one place for the oracle as
  // well.
  Transform onGrid(const Vec& low, const Vec& size) {
    Transform transform;
    transform.scale = size;
    transform.translate = low + size / 2;
    if (chance(0.2)) transform.scale.x = -transform.scale.x;
    return transform;
  }

  Transform block() {
    const auto length = [&] { return 0.5 + 0.5 * below(3); };
    const Vec size{length(), length(), length()};
    const auto place = [&] { return 0.5 * below(5) - 1.5; };
    return onGrid({place(), 0.5 * below(3), place()}, size);
  }

  void gridRoom() {
    room();
    scene.bodies.back().transform.translate.y = 0;
    scene.camera.eye.y = between(1.6, 4);
    addLamps(1);
  }

  Material anyOpaque() {
    switch (below(3)) {
      case 0:
        return matte();
      case 1:
        return glossy();
      default:
        return mirror();
    }
  }

  void layDecals(int count) {
    for (int i = 0; i < count; ++i) {
      const Transform on = block();
      Transform decal;
      decal.scale = {on.scale.x * 2, 1, on.scale.z * 2};
      decal.translate = {on.translate.x, 0, on.translate.z};
      add(pane(), anyOpaque(), decal);
    }
  }

  int addHoles() {
    Texture mask{4, 4, {}, true};
    for (int i = 0; i < mask.width * mask.height; ++i) {
      mask.texels.push_back({chance(0.4) ? 0 : 255, 0, 0});
    }
    return addTexture(mask);
  }

  // Of every class by which whit sorts what it stores.
  Material ofAnyClass(bool mapped) {
    Material material = anyOpaque();
    if (chance(0.4)) material.castsShadow = false;
    if (mapped && chance(0.4)) material.alphaMap = addHoles();
    return material;
  }

  // A block with panes on its top, which the same panes of other blocks may cover.
  int addDecorated(int paneObject) {
    const int block = addObject(box(), ofAnyClass(false));
    Object& object = scene.objects[block];
    for (std::vector<Body>* list : {&object.before, &object.after}) {
      Transform onTop;
      onTop.scale = {0.5, 1, 0.5};
      onTop.translate = {0.25 * below(3) - 0.25, 0.5, 0.25};
      list->push_back({paneObject, onTop, chance(0.3)});
    }
    return block;
  }
};

TEST_F(Coplanar, OpaqueBlocksAndDecals) {
  expectAgreement("coplanar blocks", [&] {
    gridRoom();
    layDecals(3);
    for (int i = 0; i < 7; ++i) add(box(), anyOpaque(), block());
    layDecals(1);
  });
}

// One medium for each priority: which of two that are entered at once is entered last, nothing
// says.
TEST_F(Coplanar, BlocksOfGlass) {
  expectAgreement("coplanar blocks of glass", {.depth = 10}, [&] {
    gridRoom();
    std::vector<Material> glasses;
    for (int i = 0; i < 3; ++i) glasses.push_back(anyGlass(below(3) * 3 + i));

    layDecals(2);
    for (int i = 0; i < 7; ++i) {
      Material material = i % 2 == 0 ? glasses[i / 2 % 3] : anyOpaque();
      if (i == 6) material.mirror = color(0.05, 0.2);  // the same medium, coated
      add(box(), material, block());
    }
  });
}

// Nothing but glass on a floor.
TEST_F(Coplanar, GlassAgainstGlass) {
  expectAgreement("glass against glass", {.depth = 10}, [&] {
    gridRoom();
    for (int i = 0; i < 4; ++i) add(box(), anyGlass(i), block());
  });
}

// Objects that are used never, once or several times, some with others within, and what is written
// in place, all of any class.
TEST_F(Coplanar, OrderOfTheFile) {
  expectAgreement("coplanar in any order", {.depth = 10}, [&] {
    gridRoom();
    const int panes[] = {addObject(pane(), ofAnyClass(true)), addObject(pane(), ofAnyClass(true)),
                         addObject(pane(), ofAnyClass(true))};
    const int blocks[] = {addObject(box(), ofAnyClass(false)), addObject(box(), anyGlass(1)),
                          addDecorated(panes[0]), addDecorated(panes[1])};

    for (int i = 0; i < 14; ++i) {
      Transform transform = block();
      if (i % 2 == 0) {
        place(blocks[below(4)], transform, chance(0.3));
        continue;
      }

      transform.scale = {transform.scale.x * 2, 1, transform.scale.z * 2};
      transform.translate.y = 0.5 * below(2);
      place(panes[below(3)], transform, chance(0.3));
    }
  });
}

// Every object is there twice, so that all are instances.
TEST_F(Coplanar, Instances) {
  expectAgreement("coplanar instances", {.depth = 10}, [&] {
    gridRoom();
    std::vector<int> objects;
    for (int i = 0; i < 4; ++i) {
      objects.push_back(addObject(box(), i == 3 ? anyGlass() : anyOpaque()));
    }
    for (int i = 0; i < 8; ++i) place(objects[i % 4], block());
  });
}

}  // namespace
}  // namespace oracle
