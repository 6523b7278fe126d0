// Faces in one place: blocks that stand on a floor and on each other, face in face, and decals.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Coplanar : public Agreement {};

// On a grid: corners are exact, so that faces in one plane are in one place for the oracle as well.
Transform onGrid(SceneMaker& maker, const Vec& low, const Vec& size) {
  Transform transform;
  transform.scale = size;
  transform.translate = low + size / 2;
  if (maker.random.chance(0.2)) transform.scale.x = -transform.scale.x;
  return transform;
}

Transform block(SceneMaker& maker) {
  const auto length = [&] { return 0.5 + 0.5 * maker.random.below(3); };
  const Vec size{length(), length(), length()};
  const auto place = [&] { return 0.5 * maker.random.below(5) - 1.5; };
  return onGrid(maker, {place(), 0.5 * maker.random.below(3), place()}, size);
}

void gridRoom(SceneMaker& maker) {
  maker.room();
  maker.scene.bodies.back().transform.translate.y = 0;
  maker.scene.camera.eye.y = maker.random.between(1.6, 4);
  maker.addLamps(1);
}

Material anyOpaque(SceneMaker& maker) {
  switch (maker.random.below(3)) {
    case 0:
      return maker.matte();
    case 1:
      return maker.glossy();
    default:
      return maker.mirror();
  }
}

void layDecals(SceneMaker& maker, int count) {
  for (int i = 0; i < count; ++i) {
    const Transform on = block(maker);
    Transform decal;
    decal.scale = {on.scale.x * 2, 1, on.scale.z * 2};
    decal.translate = {on.translate.x, 0, on.translate.z};
    maker.add(pane(), anyOpaque(maker), decal);
  }
}

void opaqueBlocks(SceneMaker& maker) {
  gridRoom(maker);
  layDecals(maker, 3);
  for (int i = 0; i < 7; ++i) maker.add(box(), anyOpaque(maker), block(maker));
  layDecals(maker, 1);
}

// One medium for each priority: which of two that are entered at once is entered last, nothing
// says.
void glassBlocks(SceneMaker& maker) {
  gridRoom(maker);
  std::vector<Material> glasses;
  for (int i = 0; i < 3; ++i) {
    glasses.push_back(maker.anyGlass(maker.random.below(3) * 3 + i));
  }

  layDecals(maker, 2);
  for (int i = 0; i < 7; ++i) {
    Material material =
        i % 2 == 0 ? glasses[static_cast<std::size_t>(i / 2) % 3] : anyOpaque(maker);
    if (i == 6) material.mirror = maker.random.color(0.05, 0.2);  // the same medium, coated
    maker.add(box(), material, block(maker));
  }
}

TEST_F(Coplanar, OpaqueBlocksAndDecals) { expectAgreement({"coplanar blocks", opaqueBlocks}); }

TEST_F(Coplanar, BlocksOfGlass) {
  expectAgreement({"coplanar blocks of glass", glassBlocks, {.depth = 10}});
}

// Nothing but glass on a floor.
TEST_F(Coplanar, GlassAgainstGlass) {
  expectAgreement({"glass against glass",
                   [](SceneMaker& maker) {
                     gridRoom(maker);
                     for (int i = 0; i < 4; ++i) {
                       maker.add(box(), maker.anyGlass(i), block(maker));
                     }
                   },
                   {.depth = 10}});
}

// Every object is there twice, so that all are instances.
void instancedBlocks(SceneMaker& maker) {
  gridRoom(maker);
  std::vector<int> objects;
  for (int i = 0; i < 4; ++i) {
    const bool glass = i == 3;
    objects.push_back(maker.addObject(box(), glass ? maker.anyGlass() : anyOpaque(maker)));
  }

  for (int i = 0; i < 8; ++i) maker.place(objects[static_cast<std::size_t>(i % 4)], block(maker));
}

int addHoles(SceneMaker& maker) {
  Texture mask{4, 4, {}, true};
  for (int i = 0; i < mask.width * mask.height; ++i) {
    mask.texels.push_back({maker.random.chance(0.4) ? 0 : 255, 0, 0});
  }
  return maker.addTexture(mask);
}

// Of every class by which whit sorts what it stores.
Material ofAnyClass(SceneMaker& maker, bool mapped) {
  Material material = anyOpaque(maker);
  if (maker.random.chance(0.4)) material.castsShadow = false;
  if (mapped && maker.random.chance(0.4)) material.alphaMap = addHoles(maker);
  return material;
}

// A block with panes on its top, which the same panes of other blocks may cover.
int addDecorated(SceneMaker& maker, int paneObject) {
  const int block = maker.addObject(box(), ofAnyClass(maker, false));
  Object& object = maker.scene.objects[static_cast<std::size_t>(block)];
  for (std::vector<Body>* list : {&object.before, &object.after}) {
    Transform onTop;
    onTop.scale = {0.5, 1, 0.5};
    onTop.translate = {0.25 * maker.random.below(3) - 0.25, 0.5, 0.25};
    list->push_back({paneObject, onTop, maker.random.chance(0.3)});
  }
  return block;
}

// Objects that are used never, once or several times, some with others within, and what is written
// in place, all of any class.
void blocksInAnyOrder(SceneMaker& maker) {
  gridRoom(maker);
  const int panes[] = {maker.addObject(pane(), ofAnyClass(maker, true)),
                       maker.addObject(pane(), ofAnyClass(maker, true)),
                       maker.addObject(pane(), ofAnyClass(maker, true))};
  const int blocks[] = {maker.addObject(box(), ofAnyClass(maker, false)),
                        maker.addObject(box(), maker.anyGlass(1)), addDecorated(maker, panes[0]),
                        addDecorated(maker, panes[1])};

  for (int i = 0; i < 14; ++i) {
    Transform transform = block(maker);
    if (i % 2 == 0) {
      maker.place(blocks[maker.random.below(4)], transform, maker.random.chance(0.3));
      continue;
    }

    transform.scale = {transform.scale.x * 2, 1, transform.scale.z * 2};
    transform.translate.y = 0.5 * maker.random.below(2);
    maker.place(panes[maker.random.below(3)], transform, maker.random.chance(0.3));
  }
}

TEST_F(Coplanar, OrderOfTheFile) {
  expectAgreement({"coplanar in any order", blocksInAnyOrder, {.depth = 10}});
}

TEST_F(Coplanar, Instances) {
  expectAgreement({"coplanar instances", instancedBlocks, {.depth = 10}});
}

}  // namespace
}  // namespace oracle
