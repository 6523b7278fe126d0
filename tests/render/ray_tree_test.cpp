// The tree of a pixel's rays against the pixel: the sum of the tree is the radiance of the picture,
// to the last bit, and so is that of the reference's tree.
#include "inspect/ray_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "inspect/reference_frame.h"
#include "render/row_of_tiles.h"
#include "render/shipped_scene.h"
#include "sanitized.h"

namespace whit::test {
namespace {

// Sums as the frame does: in floats, with rounded products.
Rgb sumOf(const RayTree& tree, std::size_t node) {
  Rgb sum(tree.nodes[node].local);
  for (const std::size_t child : tree.nodes[node].children) {
    sum += Rgb(tree.nodes[child].weight) * sumOf(tree, child);
  }
  return sum;
}

Rgb pixelOf(const RayTree& tree) {
  RgbD sum;
  for (const std::size_t primary : tree.primaries) {
    sum += RgbD(Rgb(tree.nodes[primary].weight) * sumOf(tree, primary));
  }
  return Rgb(sum / static_cast<double>(tree.primaries.size()));
}

RenderOptions sizedOptions(int width, int height) {
  RenderOptions options;
  options.size = ImageSize{width, height};
  return options;
}

// The trees of a scene's pixels, in either mode.
struct RayTrees {
  RayTrees(const Scene& scene, const RenderOptions& options)
      : renderer(scene, options),
        camera(chooseCamera(scene, options)),
        film(makeFilm(scene, options)) {}

  RayTree at(int x, int y) { return traceRayTree(renderer, camera, film, x, y); }
  RayTree referenceAt(int x, int y, const RayTree& tree) {
    return traceReferenceTree(renderer, camera, film, x, y, tree.samples);
  }

  Renderer renderer;
  Camera camera;
  Film film;
};

void expectSumsOfPixels(const Scene& scene) {
  RenderOptions options = sizedOptions(60, 40);
  options.depth = 10;
  RayTrees trees(scene, options);
  trees.film = render(trees.renderer);
  const Image reference = render(trees.renderer, false).image;

  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    const int x = static_cast<int>(random() % 60), y = static_cast<int>(random() % 40);
    const RayTree tree = trees.at(x, y);
    EXPECT_EQ(tree.pixel, trees.film.image.at(x, y)) << x << "," << y;
    EXPECT_EQ(pixelOf(tree), tree.pixel) << x << "," << y;
    EXPECT_EQ(trees.referenceAt(x, y, tree).pixel, reference.at(x, y)) << x << "," << y;
  }
}

class ShippedRayTree : public testing::TestWithParam<std::string> {};

TEST_P(ShippedRayTree, SumsUpToThePixel) { expectSumsOfPixels(load(GetParam())); }

// Fog dims rays after they were traced.
TEST(RayTreeInFog, SumsUpToThePixel) {
  Scene scene = load("whitted");
  scene.fog = {Rgb(0.05f), Rgb(0.5f)};
  scene.effects = scene.effects.with(Effect::fog);
  expectSumsOfPixels(scene);
}

class AdaptiveRayTree : public testing::TestWithParam<std::string> {};

// Some pixels have one sample, some those of the probes, and some all.
TEST_P(AdaptiveRayTree, TracesTheSamplesOfThePixel) {
  const Scene scene = load(GetParam());
  RenderOptions options = kSanitized ? sizedOptions(30, 20) : sizedOptions(60, 40);
  options.spp = 9;
  options.adaptive = true;
  RayTrees trees(scene, options);
  trees.film = render(trees.renderer);
  const Image reference = render(trees.renderer, false).image;

  std::map<std::size_t, int> pixels;
  int otherReference = 0;
  const int step = kSanitized ? 5 : 3;
  for (int y = 0; y < options.size->height; y += step) {
    for (int x = 0; x < options.size->width; x += step + 1) {
      const RayTree tree = trees.at(x, y);
      ASSERT_EQ(tree.pixel, trees.film.image.at(x, y)) << x << "," << y;
      ASSERT_EQ(tree.primaries.size(), tree.samples.size());
      ++pixels[tree.samples.size()];
      otherReference += trees.referenceAt(x, y, tree).pixel != reference.at(x, y);
    }
  }

  EXPECT_EQ(pixels.size(), 3u);
  for (const std::size_t samples : {1, 4, 9}) EXPECT_TRUE(pixels.contains(samples)) << samples;
  // The probes of the reference may decide otherwise.
  EXPECT_LE(otherReference, 2);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedRayTree,
                         testing::Values("matte", "whitted", "mirrors", "glass", "effects",
                                         "glossy"),
                         sceneName);

// The samples of one scene differ at edges only, and the other scene samples lobes.
INSTANTIATE_TEST_SUITE_P(All, AdaptiveRayTree, testing::Values("whitted", "glossy"), sceneName);

// A surface stands before a wall, which emits light by default.
Scene surfaceAndWall(const Material& surface, const Material& behind = emittingMaterial(0.8f)) {
  SceneBuilder builder;
  builder.add(quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}), surface);
  builder.add(quad({-1, -1, 4}, {1, -1, 4}, {1, 1, 4}, {-1, 1, 4}), behind);
  builder.lookFrom({0.1f, 0.2f, 2}, {0.1f, 0.2f, 0});
  return builder.build();
}

TEST(RayTree, OfAMirror) {
  const Scene scene = surfaceAndWall(mirrorMaterial(0.5f));
  RayTrees trees(scene, sizedOptions(9, 9));
  const RayTree tree = trees.at(4, 4);

  // The mirror is 2 before the camera, and the wall 4 behind the mirror in the mirrored direction.
  ASSERT_EQ(tree.nodes.size(), 2u);
  EXPECT_EQ(tree.nodes[0].kind, RayKind::primary);
  EXPECT_NEAR(tree.nodes[0].distance, 2, 1e-6);
  EXPECT_EQ(tree.nodes[1].kind, RayKind::reflection);
  EXPECT_NEAR(tree.nodes[1].distance, 4, 1e-5);
  EXPECT_NEAR(tree.nodes[1].weight.x, 0.5, 1e-6);
  EXPECT_NEAR(tree.nodes[1].radiance.x, 0.8, 1e-6);
  EXPECT_NEAR(tree.pixel.x, 0.4, 1e-6);
  EXPECT_EQ(tree.nodes[0].endOf(RayKind::reflection), PathEnd::none);

  const RayTree reference = trees.referenceAt(4, 4, tree);
  ASSERT_EQ(reference.nodes.size(), 2u);
  const std::vector<std::size_t> counterpart = counterparts(tree, reference);
  for (const auto i : indices(2)) {
    ASSERT_EQ(counterpart[i], i);
    EXPECT_TRUE(agree(tree.nodes[i], reference.nodes[i]));
    EXPECT_NEAR(length(tree.nodes[i].position - reference.nodes[i].position), 0, 1e-5);
  }
}

// Returns how the path of the middle pixel ends at the first surface.
PathEnd endOf(const Scene& scene, const RenderOptions& options, RayKind kind) {
  return RayTrees(scene, options).at(4, 4).nodes[0].endOf(kind);
}

TEST(RayTree, SaysWhyPathsEnd) {
  const Scene mirror = surfaceAndWall(mirrorMaterial(0.5f));
  RenderOptions options = sizedOptions(9, 9);
  options.cutoff = 0.6f;
  EXPECT_EQ(endOf(mirror, options, RayKind::reflection), PathEnd::cutoff);
  options.cutoff = 0;
  options.depth = 0;
  EXPECT_EQ(endOf(mirror, options, RayKind::reflection), PathEnd::depth);

  // What is not asked for has no end.
  Material wall = diffuseMaterial(0.5f);
  EXPECT_EQ(endOf(surfaceAndWall(wall), options, RayKind::indirect), PathEnd::none);
  options.indirect = 1;
  EXPECT_EQ(endOf(surfaceAndWall(wall), options, RayKind::indirect), PathEnd::depth);
  const Material behind = wall;
  wall.diffuseReflection = false;
  EXPECT_EQ(endOf(surfaceAndWall(wall, behind), options, RayKind::indirect), PathEnd::none);
}

// Counts how paths end at the first surfaces that 81 pixels show.
std::map<PathEnd, int> endsIn(const Scene& scene, const RenderOptions& options, RayKind kind) {
  RayTrees trees(scene, options);
  std::map<PathEnd, int> ends;
  for (int i = 0; i < 81; ++i) {
    const RayTree tree = trees.at(i % 9, i / 9);
    const RayNode& first = tree.nodes[0];
    if (first.triangle == kMiss) continue;
    ++ends[first.endOf(kind)];
    const bool goesOn = std::ranges::any_of(
        first.children, [&](std::size_t child) { return tree.nodes[child].kind == kind; });
    EXPECT_EQ(goesOn, first.endOf(kind) == PathEnd::none);
  }
  return ends;
}

// Roulette lets half of the paths go on: a mirror reflects half, and a wall is half white.
TEST(RayTree, SaysThatRouletteEndsPaths) {
  RenderOptions options = sizedOptions(9, 9);
  options.indirect = 1;
  options.roulette = 1;
  const Scene mirror = surfaceAndWall(mirrorMaterial(0.5f)),
              wall = surfaceAndWall(diffuseMaterial(0.5f));
  for (auto ends :
       {endsIn(mirror, options, RayKind::reflection), endsIn(wall, options, RayKind::indirect)}) {
    EXPECT_EQ(ends.size(), 2u);
    EXPECT_GT(ends[PathEnd::none], 10);
    EXPECT_GT(ends[PathEnd::roulette], 10);
  }

  options.roulette = 0;
  EXPECT_TRUE(endsIn(wall, options, RayKind::indirect).contains(PathEnd::none));

  options.depth = 0;
  const auto ends = endsIn(wall, options, RayKind::indirect);
  EXPECT_EQ(ends.size(), 1u);
  EXPECT_TRUE(ends.contains(PathEnd::depth));
}

}  // namespace
}  // namespace whit::test
