// The lines of a pixel's rays: each kind of ray has a style, and each style a color.
#include "inspect/ray_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "render/shipped_scene.h"

namespace whit::test {
namespace {

TEST(RayLines, EveryLookHasAColorOfItsOwn) {
  std::vector<RayLine> lines;
  for (const RayKindRow& row : kRayKinds) {
    if (row.testsOcclusion()) lines.push_back({{}, {}, {row.kind, true}});
    lines.push_back({{}, {}, {row.kind, false}});
    lines.push_back(lines.back());
  }

  const std::vector<RayLook> looks = looksOf(lines);
  EXPECT_TRUE(std::ranges::is_sorted(looks, {}, isDashed));

  std::set<std::array<std::uint8_t, 3>> colors;
  std::set<std::string_view> names;
  std::set<RayKind> kinds;
  for (const RayLook look : looks) {
    colors.insert(styleOf(look).color);
    names.insert(styleOf(look).name);
    kinds.insert(look.kind);
  }

  EXPECT_EQ(colors.size(), looks.size());
  EXPECT_EQ(names.size(), looks.size());
  EXPECT_EQ(kinds.size(), kRayKindCount);
}

// Collects the styles of the rays in one row of the room's picture.
std::set<RayLook> looksIn(const RenderOptions& options) {
  const Scene scene = load("cornell");
  Renderer renderer(scene, options);
  const Camera camera = chooseCamera(scene, options);
  const Film film = makeFilm(scene, options);
  std::set<RayLook> looks;

  for (int x = 0; x < options.size->width; ++x) {
    const RayTree tree = traceRayTree(renderer, camera, film, x, options.size->height / 2);
    std::size_t shadows = 0;
    for (const RayLine& line : linesOf(tree, camera)) {
      looks.insert(line.look);
      shadows += isDashed(line.look);
      if (isDashed(line.look)) continue;
      EXPECT_EQ(line.look, RayLook{tree.nodes[line.node].kind});
    }

    EXPECT_EQ(shadows, tree.shadowRays());
  }
  return looks;
}

TEST(RayLines, ShowIndirectLightAndOcclusionAsSuch) {
  RenderOptions options;
  options.size = ImageSize{24, 24};
  options.depth = 2;
  const std::set<RayLook> plain = looksIn(options);
  const RayLook scattered{RayKind::indirect}, open{RayKind::occlusion, false},
      blocked{RayKind::occlusion, true};
  for (const RayLook look : {scattered, open, blocked}) EXPECT_FALSE(plain.contains(look));
  options.indirect = 1;
  EXPECT_TRUE(looksIn(options).contains(scattered));

  options.indirect = 0;
  options.ambientSamples = 2;
  const std::set<RayLook> occluded = looksIn(options);
  EXPECT_TRUE(occluded.contains(open) && occluded.contains(blocked));
}

}  // namespace
}  // namespace whit::test
