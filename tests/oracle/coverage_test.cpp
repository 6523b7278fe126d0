// Surfaces that are there in part, and sheets that light goes straight through.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Coverage : public Agreement {};

// Shadows follow from the share, unless the file says otherwise.
Material inPart(SceneMaker& maker, Material material) {
  material.coverage = maker.random.between(0.1, 0.95);
  const bool asItFollows = maker.random.chance(0.7);
  material.castsShadow = (material.coverage >= 0.5) == asItFollows;
  return material;
}

Material anySheet(SceneMaker& maker) {
  switch (maker.random.below(5)) {
    case 0:
      return inPart(maker, maker.matte());
    case 1:
      return inPart(maker, maker.glossy());
    case 2:
      return inPart(maker, maker.mirror());
    case 3: {
      Material glass = inPart(maker, maker.glass(1.5));
      glass.diffuse = maker.random.color(0, 0.5);
      if (maker.random.chance(0.5)) glass.mirror = maker.random.color(0.1, 0.6);
      return glass;
    }
    default: {
      Material film = maker.anyGlass(maker.random.below(5));
      film.thin = true;
      if (maker.random.chance(0.5)) film.mirror = maker.random.color(0.05, 0.4);
      if (maker.random.chance(0.3)) film.emission = maker.random.color(0, 0.3);
      return film;
    }
  }
}

void litRoomWithSomethingBehind(SceneMaker& maker) {
  maker.room();
  maker.add(box(), maker.glossy(), maker.random.placement({-1.4, 0.8, -2}, 0.9));
  maker.add(tetrahedron(), maker.mirror(), maker.random.placement({1.2, 0.9, -1.8}, 1));
  maker.addLamps(2);
}

// Seen from both sides: what is closed is left through its back faces.
void sheetsInARoom(SceneMaker& maker) {
  litRoomWithSomethingBehind(maker);
  for (int i = 0; i < 4; ++i) maker.add(maker.solid(), anySheet(maker), maker.standing(i, 4));

  const int veil = maker.addObject(pane(), anySheet(maker));
  for (int i = 0; i < 3; ++i) {
    Transform standing = maker.random.placement({0.5 * i - 0.5, 1.2, 1 + 0.4 * i}, 1);
    standing.axis = {1, 0.2, 0.1};
    maker.place(veil, standing);
  }
}

TEST_F(Coverage, SheetsInARoom) { expectAgreement({"sheets", sheetsInARoom, {.depth = 12}}); }

// From nothing to all, over whole texels and between them.
int addShares(SceneMaker& maker) {
  Texture texture{16, 8, {}, true};
  for (int i = 0; i < texture.width * texture.height; ++i) {
    const int share = maker.random.below(256), kind = maker.random.below(4);
    texture.texels.push_back({kind > 1 ? share : 255 * kind, 0, 0});
  }
  return maker.addTexture(texture);
}

Mesh repeatedPane(double repeats) {
  Mesh mesh = pane();
  for (auto& [u, v] : mesh.uvs) {
    const double across = u, up = v;
    u = asFloat(repeats * (0.9 * across + 0.3 * up - 0.4));
    v = asFloat(repeats * (0.8 * up - 0.2 * across + 0.1));
  }
  return mesh;
}

void mappedSheets(SceneMaker& maker) {
  litRoomWithSomethingBehind(maker);

  for (int i = 0; i < 4; ++i) {
    Material material = maker.random.chance(0.5) ? maker.glossy() : maker.mirror();
    material.coverageMap = addShares(maker);
    if (i % 2 == 1) material.coverage = maker.random.between(0.5, 1);
    if (i == 2) {
      material.transmission = maker.random.color(0.2, 0.9);
      material.thin = true;
      material.castsShadow = false;
    }

    if (i == 3) material.alphaMap = addShares(maker);
    maker.add(repeatedPane(i == 0 ? 3 : 0.7), material, maker.standing(i, 4));
  }
}

TEST_F(Coverage, Maps) {
  expectAgreement({"coverage maps", mappedSheets, {.depth = 10}});
  expectAgreement(
      {"coverage maps, nearest texels", mappedSheets, {.depth = 10, .filter = Filter::nearest}});
  expectAgreement(
      {"coverage maps, trilinear", mappedSheets, {.depth = 10, .filter = Filter::trilinear}});
}

// Within glass, across its faces, and around it.
void sheetsInGlass(SceneMaker& maker) {
  litRoomWithSomethingBehind(maker);
  const Vec left{-0.9, 1.2, 0.3}, right{0.9, 1.2, 0.3};
  for (const Vec& center : {left, right}) {
    const int priority = maker.random.below(2);
    maker.add(box(), maker.anyGlass(priority), maker.random.placement(center, 1.4));
    maker.add(
        box(), maker.anyGlass(2),
        maker.random.placement(center + maker.random.inBox({-0.3, -0.3, 0}, {0.3, 0.3, 0.5}), 0.8));
    maker.add(pane(), anySheet(maker), maker.random.placement(center, 1.9));
    maker.add(box(), anySheet(maker), maker.random.placement(center, 0.7));
  }
}

TEST_F(Coverage, InGlass) { expectAgreement({"sheets in glass", sheetsInGlass, {.depth = 12}}); }

// Face in face with opaque blocks, with glass and with each other.
Transform onTheGrid(SceneMaker& maker, bool flat) {
  const auto size = [&] { return 0.5 + 0.5 * maker.random.below(3); };
  Transform transform;
  transform.scale = {size(), flat ? 1 : size(), size()};
  const Vec low{0.5 * maker.random.below(5) - 1.5, 0.5 * maker.random.below(3),
                0.5 * maker.random.below(5) - 1.5};
  transform.translate = low + transform.scale / 2;
  if (flat) transform.translate.y = low.y;
  return transform;
}

Material besideOthers(SceneMaker& maker, int i) {
  if (i % 3 == 0) return maker.anyGlass(i);
  return i % 6 == 4 ? maker.glossy() : anySheet(maker);
}

void coplanarSheets(SceneMaker& maker) {
  maker.room();
  maker.scene.bodies.back().transform.translate.y = 0;
  maker.scene.camera.eye.y = maker.random.between(1.6, 4);
  maker.addLamps(1);

  const int twice = maker.addObject(box(), anySheet(maker));
  for (int i = 0; i < 12; ++i) {
    const bool flat = i % 3 == 2;
    const Transform transform = onTheGrid(maker, flat);
    if (i % 6 == 1) {
      maker.place(twice, transform);
      continue;
    }

    const Mesh mesh = flat ? pane() : box();
    maker.add(mesh, besideOthers(maker, i), transform);
  }
}

TEST_F(Coverage, FaceInFace) {
  expectAgreement({"coplanar sheets", coplanarSheets, {.depth = 12}});
}

// Of the lobe of what is there in part, and of lights upon it.
void sampledSheets(SceneMaker& maker) {
  maker.roomFromNear();
  maker.scene.lights[0].radius = maker.random.between(0.2, 0.6);
  for (int i = 0; i < 3; ++i) {
    Material material = maker.rough();
    if (i < 2) material = inPart(maker, material);
    maker.add(box(), material, maker.standing(i, 3));
  }
}

TEST_F(Coverage, Sampled) {
  expectAgreement({"sampled sheets", sampledSheets, {.depth = 3, .glossy = 16, .lightSamples = 8}});
}

}  // namespace
}  // namespace oracle
