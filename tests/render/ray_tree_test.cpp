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

void expectSumsOfPixels(const Scene& scene) {
  RenderOptions options;
  options.size = ImageSize{60, 40};
  options.depth = 10;
  Renderer renderer(scene, options);
  const Camera camera = chooseCamera(scene, options);

  Film film = makeFilm(scene, options), reference = film;
  renderer.render(camera, film);
  renderReference(renderer, camera, reference);
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    const int x = static_cast<int>(random() % 60), y = static_cast<int>(random() % 40);
    const RayTree tree = traceRayTree(renderer, camera, film, x, y);

    EXPECT_EQ(tree.pixel, film.image.at(x, y)) << x << "," << y;
    EXPECT_EQ(pixelOf(tree), film.image.at(x, y)) << x << "," << y;
    EXPECT_EQ(traceReferenceTree(renderer, camera, film, x, y, tree.samples).pixel,
              reference.image.at(x, y))
        << x << "," << y;
  }
}

class ShippedRayTree : public testing::TestWithParam<const char*> {};

TEST_P(ShippedRayTree, SumsUpToThePixel) { expectSumsOfPixels(load(GetParam())); }

// Fog dims rays after they were traced.
TEST(RayTreeInFog, SumsUpToThePixel) {
  Scene scene = load("whitted");
  scene.fog = {Rgb(0.05f), Rgb(0.5f)};
  scene.effects = scene.effects.with(Effect::fog);
  expectSumsOfPixels(scene);
}

class AdaptiveRayTree : public testing::TestWithParam<const char*> {};

// Some pixels have one sample, some those of the probes, and some all.
TEST_P(AdaptiveRayTree, TracesTheSamplesOfThePixel) {
  const Scene scene = load(GetParam());
  RenderOptions options;
  options.size = kSanitized ? ImageSize{30, 20} : ImageSize{60, 40};
  options.spp = 9;
  options.adaptive = true;

  Renderer renderer(scene, options);
  const Camera camera = chooseCamera(scene, options);
  Film film = makeFilm(scene, options), reference = film;
  renderer.render(camera, film);
  renderReference(renderer, camera, reference);

  std::map<std::size_t, int> pixels;
  int otherReference = 0;
  const int step = kSanitized ? 5 : 3;
  for (int y = 0; y < options.size->height; y += step) {
    for (int x = 0; x < options.size->width; x += step + 1) {
      const RayTree tree = traceRayTree(renderer, camera, film, x, y);
      ASSERT_EQ(tree.pixel, film.image.at(x, y)) << x << "," << y;
      ASSERT_EQ(tree.primaries.size(), tree.samples.size());
      ++pixels[tree.samples.size()];
      otherReference += traceReferenceTree(renderer, camera, film, x, y, tree.samples).pixel !=
                        reference.image.at(x, y);
    }
  }

  for (const auto& [samples, count] : pixels) {
    EXPECT_TRUE(samples == 1 || samples == 4 || samples == 9) << samples;
  }
  EXPECT_EQ(pixels.size(), 3u);
  // The probes of the reference may decide otherwise.
  EXPECT_LE(otherReference, 2);
}

std::string nameOfScene(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, ShippedRayTree,
                         testing::Values("matte", "whitted", "mirrors", "glass", "effects",
                                         "glossy"),
                         nameOfScene);

// The samples of one scene differ at edges only, and the other scene samples lobes.
INSTANTIATE_TEST_SUITE_P(All, AdaptiveRayTree, testing::Values("whitted", "glossy"), nameOfScene);

// A surface stands before a wall, which emits light by default.
Scene surfaceAndWall(const Material& surface, const Material& behind = emittingMaterial(0.8f)) {
  SceneBuilder builder;
  const auto wallAt = [&](float z, const Material& material) {
    Mesh wall;
    wall.positions = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    wall.materials = {builder.add(material)};
    builder.add(std::move(wall));
  };

  wallAt(0, surface);
  wallAt(4, behind);
  builder.description.cameras = {{.eye = {0.1f, 0.2f, 2}, .at = {0.1f, 0.2f, 0}}};
  return builder.build();
}

TEST(RayTree, OfAMirror) {
  const Scene scene = surfaceAndWall(mirrorMaterial(0.5f));
  RenderOptions options;
  options.size = ImageSize{9, 9};
  Renderer renderer(scene, options);
  const Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);
  const RayTree tree = traceRayTree(renderer, camera, film, 4, 4);

  // The mirror is 2 before the camera, and the wall 4 behind the mirror in the mirrored direction.
  ASSERT_EQ(tree.nodes.size(), 2u);
  EXPECT_EQ(tree.nodes[0].kind, RayKind::primary);
  EXPECT_NEAR(tree.nodes[0].distance, 2, 1e-6);
  EXPECT_EQ(tree.nodes[1].kind, RayKind::reflection);
  EXPECT_NEAR(tree.nodes[1].distance, 4, 1e-5);
  EXPECT_NEAR(tree.nodes[1].weight.x, 0.5, 1e-6);
  EXPECT_NEAR(tree.nodes[1].radiance.x, 0.8, 1e-6);
  EXPECT_NEAR(double{tree.pixel.x}, 0.4, 1e-6);
  EXPECT_EQ(tree.nodes[0].endOf(RayKind::reflection), PathEnd::none);

  const RayTree reference = traceReferenceTree(renderer, camera, film, 4, 4, tree.samples);
  ASSERT_EQ(reference.nodes.size(), 2u);
  const std::vector<std::size_t> counterpart = counterparts(tree, reference);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(counterpart[i], i);
    EXPECT_TRUE(agree(tree.nodes[i], reference.nodes[i]));
    EXPECT_NEAR(length(tree.nodes[i].position - reference.nodes[i].position), 0, 1e-5);
  }
}

TEST(RayTree, SaysWhyPathsEnd) {
  const Scene scene = surfaceAndWall(mirrorMaterial(0.5f));
  RenderOptions options;
  options.size = ImageSize{9, 9};

  const auto endWith = [&] {
    Renderer renderer(scene, options);
    const Film film = makeFilm(scene, options);
    return traceRayTree(renderer, chooseCamera(scene, options), film, 4, 4)
        .nodes[0]
        .endOf(RayKind::reflection);
  };

  options.depth = 0;
  EXPECT_EQ(endWith(), PathEnd::depth);

  options.depth = 8;
  options.cutoff = 0.6f;
  EXPECT_EQ(endWith(), PathEnd::cutoff);
}

// Counts how paths end at the first surfaces that 81 pixels show.
std::map<PathEnd, int> endsIn(const Scene& scene, const RenderOptions& options, RayKind kind) {
  Renderer renderer(scene, options);

  const Film film = makeFilm(scene, options);
  std::map<PathEnd, int> ends;
  for (int i = 0; i < 81; ++i) {
    const RayTree tree = traceRayTree(renderer, chooseCamera(scene, options), film, i % 9, i / 9);
    const RayNode& first = tree.nodes[0];
    if (first.triangle == kMiss) continue;
    ++ends[first.endOf(kind)];
    const bool goesOn =
        std::any_of(first.children.begin(), first.children.end(),
                    [&](std::size_t child) { return tree.nodes[child].kind == kind; });
    EXPECT_EQ(goesOn, first.endOf(kind) == PathEnd::none);
  }
  return ends;
}

// Roulette lets half of the paths go on: a mirror reflects half, and a wall is half white.
TEST(RayTree, SaysThatRouletteEndsPaths) {
  RenderOptions options;
  options.size = ImageSize{9, 9};
  options.roulette = 1;

  auto mirrored = endsIn(surfaceAndWall(mirrorMaterial(0.5f)), options, RayKind::reflection);
  EXPECT_EQ(mirrored.size(), 2u);
  EXPECT_GT(mirrored[PathEnd::none], 10);
  EXPECT_GT(mirrored[PathEnd::roulette], 10);

  const Scene wall = surfaceAndWall(diffuseMaterial(0.5f));
  options.indirect = 1;
  auto scattered = endsIn(wall, options, RayKind::indirect);
  EXPECT_EQ(scattered.size(), 2u);
  EXPECT_GT(scattered[PathEnd::none], 10);
  EXPECT_GT(scattered[PathEnd::roulette], 10);

  options.roulette = 0;
  EXPECT_EQ(endsIn(wall, options, RayKind::indirect).count(PathEnd::none), 1u);

  options.depth = 0;
  scattered = endsIn(wall, options, RayKind::indirect);
  EXPECT_EQ(scattered.size(), 1u);
  EXPECT_EQ(scattered.count(PathEnd::depth), 1u);
}

TEST(RayTree, TellsOfNoEndOfWhatIsNotAskedFor) {
  const auto endIn = [](const Scene& scene, const RenderOptions& options) {
    Renderer renderer(scene, options);
    const Film film = makeFilm(scene, options);
    const RayTree tree = traceRayTree(renderer, chooseCamera(scene, options), film, 4, 4);
    return tree.nodes[0].endOf(RayKind::indirect);
  };

  RenderOptions options;
  options.size = ImageSize{9, 9};
  options.depth = 0;
  Material wall = diffuseMaterial(0.5f);
  EXPECT_EQ(endIn(surfaceAndWall(wall), options), PathEnd::none);

  options.indirect = 1;
  EXPECT_EQ(endIn(surfaceAndWall(wall), options), PathEnd::depth);

  const Material other = wall;
  wall.diffuseReflection = false;
  EXPECT_EQ(endIn(surfaceAndWall(wall, other), options), PathEnd::none);
}

}  // namespace
}  // namespace whit::test
