// The lines of a pixel's rays: each kind of ray has a look, and each look a color.
#include "render/ray_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "render/shipped_scene.h"

namespace whit::test {
namespace {

TEST(RayLines, EveryLookHasAColorOfItsOwn) {
  const std::set<std::array<std::uint8_t, 3>> colors(kRayColors.begin(), kRayColors.end());
  EXPECT_EQ(colors.size(), kRayLookCount);
  std::set<RayLook> looks;
  for (std::size_t kind = 0; kind < kRayKindCount; ++kind)
    looks.insert(lookOf(static_cast<RayKind>(kind)));
  EXPECT_EQ(looks.size(), kRayKindCount);
}

// Of a part of the room's picture.
std::set<RayLook> looksIn(const RenderOptions& options) {
  const Scene scene = load("cornell");
  Renderer renderer(scene, options);
  const Film film = makeFilm(scene, options);
  std::set<RayLook> looks;
  for (int x = 0; x < options.size->width; ++x) {
    const RayTree tree =
        traceRayTree(renderer, chooseCamera(scene, options), film, x, options.size->height / 2);
    std::size_t shadows = 0;
    for (const RayLine& line : linesOf(tree)) {
      looks.insert(line.look);
      shadows += isShadowLook(line.look);
      if (isShadowLook(line.look)) continue;
      EXPECT_EQ(line.look, lookOf(tree.nodes[line.node].kind));
    }
    std::size_t traced = 0;
    for (const RayNode& n : tree.nodes) {
      traced += static_cast<std::size_t>(
          std::count_if(n.lights.begin(), n.lights.end(),
                        [](const LightContribution& light) { return light.traced; }));
    }
    EXPECT_EQ(shadows, traced);
  }
  return looks;
}

TEST(RayLines, ShowIndirectLightAndOcclusionAsSuch) {
  RenderOptions options;
  options.size = ImageSize{24, 24};
  options.depth = 2;
  const std::set<RayLook> plain = looksIn(options);
  for (const RayLook look : {RayLook::indirect, RayLook::open, RayLook::occluded})
    EXPECT_FALSE(plain.contains(look));
  options.indirect = 1;
  EXPECT_TRUE(looksIn(options).contains(RayLook::indirect));
  options.indirect = 0;
  options.ambientSamples = 2;
  const std::set<RayLook> occluded = looksIn(options);
  EXPECT_TRUE(occluded.contains(RayLook::open));
  EXPECT_TRUE(occluded.contains(RayLook::occluded));
}

}  // namespace
}  // namespace whit::test
