// Digests, and the pictures that points are measured against.
#include "accuracy/reference_pictures.h"

#include <gtest/gtest.h>

#include <functional>

#include "accuracy/measurement.h"
#include "output/digest.h"
#include "render/renderer.h"
#include "unit/scene_builder.h"

namespace whit::accuracy {
namespace {

SceneDescription room() {
  SceneDescription d = test::sceneOf(test::square());
  d.cameras = {{.eye = {0.5f, 0.5f, 2}, .at = {0.5f, 0.5f, 0}}};
  d.lights.push_back({"lamp", {0.5f, 0.5f, 1}, {1, 1, 1}, 0.01f});
  d.textures.push_back(test::whiteTexture(TexelFormat::color));
  d.materials[0].diffuseMap = 0;
  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = {0.1f, 0.2f, 0.3f};
  return d;
}

std::string digestAfter(const std::function<void(SceneDescription&)>& change) {
  SceneDescription d = room();
  change(d);
  return digestOf(test::finalized(d));
}

// Expects that of the two ranks that are added to the scene, the order matters and not the values.
void expectOnlyTheOrderMatters(
    const std::function<void(SceneDescription&, std::uint64_t, std::uint64_t)>& addRanked) {
  const auto withRanks = [&](std::uint64_t first, std::uint64_t second) {
    return digestAfter([&](SceneDescription& d) { addRanked(d, first, second); });
  };
  EXPECT_EQ(withRanks(0, 1), withRanks(3, 7));
  EXPECT_NE(withRanks(0, 1), withRanks(1, 0));
}

TEST(SceneDigest, NamesDoNotMatter) {
  const std::string before = digestAfter([](auto&) {});
  EXPECT_EQ(before.size(), 32u);
  EXPECT_EQ(before, digestAfter([](SceneDescription& d) {
              d.name = d.materials[0].name = d.lights[0].name = "other";
            }));
}

TEST(SceneDigest, EveryTableMatters) {
  void (*const changes[])(SceneDescription&) = {
      [](auto& d) { d.objects[0].meshes[0].positions[2].x = 1.0000001f; },
      [](auto& d) {
        d.objects[0].meshes[0].uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      },
      [](auto& d) { d.objects[0].meshes[0].normals.assign(4, normalized(Vec3f(0.1f, 0, 1))); },
      [](auto& d) { d.materials[0].diffuse.y = 0.80000001f + 1e-6f; },
      [](auto& d) { d.materials[0].castsShadow = false; },
      [](auto& d) { d.materials[0].mirror = Rgb(0.5f); },
      [](auto& d) { d.lights[0].intensity.z = 2; },
      [](auto& d) { d.lights[0].position.x = 0.25f; },
      [](auto& d) { d.lights.push_back(d.lights[0]); },
      [](auto& d) { d.textures[0].texels[0] ^= 1; },
      [](auto& d) { d.textures[0].wrapV = Wrap::clamp; },
      [](auto& d) { d.sky.zenith.x = 0.2f; },
      [](auto& d) { d.ambient.up = Rgb(0.1f); },
      [](auto& d) { d.fog.density.y = 0.1f; },
      [](auto& d) {
        d.instances.push_back({0, Affine::translation({5, 0, 0})});
      },
  };

  const std::string before = digestAfter([](auto&) {});
  for (const auto i : indices(changes)) {
    EXPECT_NE(digestAfter(changes[i]), before) << i;
  }
}

// Which of two faces in one place comes first is in no other table.
TEST(SceneDigest, TheOrderOfCoplanarFacesMatters) {
  expectOnlyTheOrderMatters([](SceneDescription& d, auto first, auto second) {
    std::vector<Mesh>& meshes = d.objects[0].meshes;
    meshes.push_back(meshes[0]);
    for (Vec3f& p : meshes[1].positions) p.x += 0.25f;
    meshes[0].rank = first;
    meshes[1].rank = second;
  });
}

// One object is used twice and has a geometry of its own, whatever its place in the order.
TEST(SceneDigest, TheOrderOfCoincidentSpheresMatters) {
  expectOnlyTheOrderMatters([](SceneDescription& d, auto first, auto second) {
    Mesh ball;
    ball.spheres = {Affine()};
    ball.materials = {0};
    d.objects.push_back({"twice", {ball}});
    d.objects.push_back({"once", {ball}});
    d.instances.push_back({1, Affine(), first});
    d.instances.push_back({1, Affine::translation({9, 0, 0}), first});
    d.instances.push_back({2, Affine(), second});
  });
}

TEST(OptionsDigest, CoversWhatShapesThePictureAndNothingElse) {
  RenderOptions options;
  const std::string before = digestOf(options);

  options.threads = 7;
  options.tile = 8;
  options.batch = Batch::frame;
  options.queue = 99;
  EXPECT_EQ(digestOf(options), before);

  options.quality = Quality::good;  // only a name
  EXPECT_EQ(digestOf(options), before);

  options.disable = {Effect::mirror};
  EXPECT_NE(digestOf(options), before);

  options = {};
  options.eye = Vec3d();
  EXPECT_NE(digestOf(options), before) << "nothing is not zero";
}

class Cache : public ::testing::Test {
 protected:
  static RenderOptions small(RenderOptions options) {
    options.size = ImageSize{8, 6};
    options.threads = 1;
    return options;
  }

  const Scene scene_ = test::finalized(room());
  const Camera camera_ = scene_.cameras[0];
};

TEST_F(Cache, RendersEachPictureOnce) {
  ReferenceCache cache(scene_, camera_);
  const RenderOptions options = small(referenceOptions(RenderOptions(), 2, 0));
  const ReferencePicture& first = cache.get(options, nullptr);
  EXPECT_GT(maxComponent(first.image.at(4, 3)), 0.0f);
  EXPECT_GT(first.rays, 2 * 8 * 6);

  RenderOptions others = options;
  others.threads = 2;
  EXPECT_EQ(&cache.get(others, nullptr), &first) << "threads do not matter";
  others.spp = 1;
  EXPECT_LT(cache.get(others, nullptr).rays, first.rays);
  EXPECT_EQ(&cache.get(options, nullptr), &first) << "still there";
}

// The mean of frames by packets, of seeds 0 to 7, and no other picture.
TEST_F(Cache, TransportIsTheMeanOfItsPasses) {
  const RenderOptions options = small(transportOptions(RenderOptions(), 2));
  const TransportPicture picture = renderTransport(scene_, camera_, options, nullptr);

  Renderer renderer(scene_, options);
  Film film = makeFilm(scene_, options);
  PassMean passes;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    renderer.setSeed(seed);
    renderer.render(camera_, film);
    passes.add(film.image);
  }

  EXPECT_EQ(picture.image.pixels, passes.mean().pixels);
  EXPECT_EQ(picture.standardError, passes.standardError());
  EXPECT_GT(picture.standardError, 0) << "the sky lights the square";
  EXPECT_EQ(picture.samples, 2 * kTransportPasses);
}

}  // namespace
}  // namespace whit::accuracy
