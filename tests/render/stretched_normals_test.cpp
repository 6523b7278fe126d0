// A stretched object looks the same whether it is used once, and baked into the world, or more
// often.
#include <gtest/gtest.h>

#include "reference/small_scenes.h"
#include "render/facetted_sphere.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

const Affine kStretched = Affine::rotation({1, 2, 3}, 40) * Affine::scaling({1, 3, 0.3});

// An ellipsoid of few facets is in sunlight. With `twice`, a second one is far behind the camera.
Scene ellipsoid(bool twice, bool terminator = false) {
  SceneBuilder builder;
  const Mesh sphere = facettedSphere(builder.add(diffuseMaterial(0.5f)), 8, 12);
  std::vector<Affine> placements{kStretched};
  if (twice) placements.push_back(Affine::translation({0, 0, 1000}) * kStretched);
  builder.place({"sphere", {sphere}}, placements);

  builder.description.lights = {whit::test::sun({-2, -1, -2}, 2)};
  if (terminator) builder.description.lights = {lightAt({224, 96, 224}, 1e5f)};
  builder.description.ambient = {Rgb(0.5f), Rgb(0.1f)};
  builder.lookFrom({0, 0, 8});
  return builder.build();
}

// Baked corners are rounded to float. At the edges of facets a ray may hit another facet, and the
// other pixels differ by so much.
constexpr std::size_t kPixelsAtFacetEdges = 36;  // 0.5 % of the picture
constexpr float kCornersRounded = 1e-4f;

void expectAlike(const Picture& a, const Picture& b, const char* what) {
  EXPECT_LE(pixelsApart(a.image, b.image, kCornersRounded), kPixelsAtFacetEdges) << what;
}

// The single ellipsoid is baked, and the two are instances.
TEST(StretchedNormals, AreThoseOfAnInstanceOnEveryTarget) {
  for (const bool terminator : {false, true}) {
    const Scene once = ellipsoid(false, terminator), twice = ellipsoid(true, terminator);
    ASSERT_TRUE(once.instances.empty());
    ASSERT_EQ(twice.instances.size(), 2u);

    RenderOptions o = smallOptions();
    o.shading.terminator = terminator;
    const BothModes baked = renderBoth(once, o), placed = renderBoth(twice, o);
    expectAlike(baked.packets, placed.packets, "packets");
    expectAlike(baked.reference, placed.reference, "reference");
    expectAlike(baked.packets, baked.reference, "packets against reference");

    for (const Scene& scene : {once, twice}) expectStagesAgreeOnEveryTarget(scene, o);
  }
}

}  // namespace
}  // namespace whit::test
