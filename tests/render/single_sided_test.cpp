// Surfaces that are visible from one side only: the reference against what lies behind them, and
// the vector pipeline against the reference.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"
#include "rounding.h"

namespace whit::test {
namespace {

Material singleSided(Material m) {
  m.doubleSided = false;
  return m;
}

// Exchanges front and back.
void turn(Mesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

// Counts the triangles of all geometries whose hits are filtered.
std::uint32_t filtered(const Scene& scene) {
  std::uint32_t count = 0;
  for (const Geometry& g : scene.geometries) {
    for (const auto c : indices(kTriangleClasses)) {
      if ((c & kMaskedBit) != 0) count += g.classBegin[c + 1] - g.classBegin[c];
    }
  }
  return count;
}

// Returns what a vertical ray sees at x.
double seenVertically(const Scene& scene, double x, bool fromAbove = true) {
  const double y = fromAbove ? 1 : -1;
  return radianceAlong(scene, {x, y, -0.25}, {0, -y, 0}).x;
}

// The front is the one that was modelled, whatever the transform: the mirrored instance is seen
// from below.
TEST(SingleSided, KeepTheirFrontInInstancesThatMirror) {
  SceneBuilder builder;
  Object object;
  object.meshes = {tile(builder.add(singleSided(emittingMaterial(2))))};

  Affine mirrored = Affine::translation({3, 0, 0});
  mirrored.y = {0, -1, 0};
  Affine sideways = Affine::translation({6, 0, 0});
  sideways.x = {-1, 0, 0};
  builder.place(std::move(object), {Affine(), mirrored, sideways});
  const Scene scene = builder.build();

  for (const auto& [x, isAbove] : {std::pair{0.5, true}, {3.5, false}, {5.5, true}}) {
    EXPECT_NEAR(seenVertically(scene, x, isAbove), 2, kRounding) << x;
    EXPECT_EQ(seenVertically(scene, x, !isAbove), 0) << x;
  }
}

TEST(SingleSided, CastShadowsFromBothSides) {
  for (const bool turned : {false, true}) {
    SceneBuilder builder;
    Mesh roof = quad({-2, 1, 2}, {2, 1, 2}, {2, 1, -2}, {-2, 1, -2},
                     builder.add(singleSided(diffuseMaterial(0.5f))));
    if (turned) turn(roof);

    builder.add(roof);
    builder.add(floorAt(0, 1), diffuseMaterial(0.5f));
    builder.description.lights = {lightAt({0, 5, 0}, 10)};
    EXPECT_EQ(radianceBelow(builder.build(), {0.5, 0.5, 0}).x, 0) << turned;
  }
}

TEST(SingleSided, CallForNoFilterWhereNoBackIsToBeSeen) {
  const Material matt = diffuseMaterial(0.5f);
  struct Row {
    bool inwards, open;
    Material material;
    std::uint32_t filtered;
  };
  for (const auto& [inwards, open, material, wanted] :
       {Row{false, false, singleSided(matt), 0},
        {false, true, singleSided(matt), 11},
        {true, false, singleSided(matt), 12},
        {true, true, matt, 0},
        {true, true, singleSided(glassMaterial(1.5f)), 0}}) {
    SceneBuilder builder;
    Mesh mesh = box({0, 0, 0}, {1, 2, 3}, builder.add(material));
    if (inwards) turn(mesh);
    if (open) mesh.triangles.pop_back();
    builder.add(mesh);
    EXPECT_EQ(filtered(builder.build()), wanted) << inwards << open;
  }

  // Backs are visible through holes, so a closed box with holes stays single-sided.
  SceneBuilder pierced;
  Material net = singleSided(matt);
  net.alphaMap = pierced.add(dataMap(1, {0}));
  pierced.add(box({0, 0, 0}, {1, 2, 3}), net);
  EXPECT_FALSE(pierced.build().materials[0].doubleSided);
}

// Two coincident triangles back to back are two surfaces.
TEST(SingleSided, AreKeptBackToBack) {
  SceneBuilder builder;
  Mesh back = tile(builder.add(singleSided(emittingMaterial(3))));
  turn(back);

  builder.add(tile(builder.add(singleSided(emittingMaterial(2)))));
  builder.add(back);
  const Scene scene = builder.build();
  EXPECT_EQ(scene.triangles.size(), 4u);
  EXPECT_NEAR(seenVertically(scene, 0.5), 2, kRounding);
  EXPECT_NEAR(seenVertically(scene, 0.5, false), 3, kRounding);
}

// Some tiles face away and some have masks, over a mirror that shows their backs.
Scene turnedTiles() {
  SceneBuilder builder;
  Material ground = diffuseMaterial(0.3f);
  ground.mirror = ground.mirrorGrazing = Rgb(0.5f);
  builder.add(floorAt(-1, 8), ground);
  const std::int32_t holes = builder.add(dataMap(2, {0, 1}));

  return rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.2f + 0.1f * static_cast<float>(i));
    m.doubleSided = i == 4;
    if (i % 3 == 2) m.alphaMap = holes;
    Mesh mesh = tile(builder.add(m));
    if (i % 2 == 1) turn(mesh);
    return mesh;
  });
}

TEST(SingleSided, KeepTheLawsOfMaps) { expectTheLawsOfMaps(turnedTiles()); }

}  // namespace
}  // namespace whit::test
