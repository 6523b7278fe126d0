// The cache may only give a picture back for the very same scene, camera, options and program.
#include "accuracy/reference_cache.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "accuracy/digest.h"
#include "accuracy/knobs.h"
#include "accuracy/reference_cache.h"
#include "cli/run_program.h"
#include "render/renderer.h"
#include "unit/scene_builder.h"

namespace whit::accuracy {
namespace {

SceneDescription room() {
  SceneDescription d = test::sceneOf(test::square());
  d.cameras.resize(1);
  d.cameras[0].eye = {0.5f, 0.5f, 2};
  d.cameras[0].at = {0.5f, 0.5f, 0};
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
  return digestOf(test::finalized(std::move(d)));
}

TEST(SceneDigest, IsTheSameForTheSameScene) {
  EXPECT_EQ(digestAfter([](auto&) {}), digestAfter([](auto&) {}));
  EXPECT_EQ(digestAfter([](auto&) {}).size(), 32u);
}

TEST(SceneDigest, NamesDoNotMatter) {
  EXPECT_EQ(digestAfter([](auto&) {}), digestAfter([](SceneDescription& d) {
              d.name = d.materials[0].name = d.lights[0].name = "other";
            }));
}

TEST(SceneDigest, EveryTableMatters) {
  const std::vector<std::function<void(SceneDescription&)>> changes{
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
      [](auto& d) {
        d.instances.push_back({0, Affine::translation({5, 0, 0})});
      },
  };
  const std::string before = digestAfter([](auto&) {});
  for (std::size_t i = 0; i < changes.size(); ++i) EXPECT_NE(digestAfter(changes[i]), before) << i;
}

// Which of two faces in one place comes first is in no other table.
TEST(SceneDigest, TheOrderOfCoplanarFacesMatters) {
  const auto withRanks = [](std::uint64_t first, std::uint64_t second) {
    return digestAfter([&](SceneDescription& d) {
      d.objects[0].meshes.push_back(d.objects[0].meshes[0]);
      for (Vec3f& p : d.objects[0].meshes[1].positions) p.x += 0.25f;
      d.objects[0].meshes[0].rank = first;
      d.objects[0].meshes[1].rank = second;
    });
  };
  EXPECT_EQ(withRanks(0, 1), withRanks(3, 7));
  EXPECT_NE(withRanks(0, 1), withRanks(1, 0));
}

TEST(OptionsDigest, CoversWhatShapesThePictureAndNothingElse) {
  RenderOptions options;
  const std::string before = digestOf(options);
  options.threads = 7, options.tile = 8, options.batch = Batch::frame, options.queue = 99;
  EXPECT_EQ(digestOf(options), before);
  options.quality = Quality::fine;  // only a name
  EXPECT_EQ(digestOf(options), before);
  options.disable = EffectSet().with(Effect::mirror);
  EXPECT_NE(digestOf(options), before);
  options = {};
  options.shading.fresnel = FresnelModel::schlick;
  EXPECT_NE(digestOf(options), before);
  options = {};
  options.eye = Vec3f(0);
  EXPECT_NE(digestOf(options), before) << "nothing is not zero";
}

class Cache : public ::testing::Test {
 protected:
  Cache() : scene_(test::finalized(room())), camera_(scene_.cameras[0]) {
    options_.size = ImageSize{8, 6};
    options_ = referenceOptions(options_, 2, 0);
    options_.threads = 1;
  }
  bool hits(const Scene& scene, const Camera& camera, const RenderOptions& options,
            const std::string& program = "1") {
    ReferenceCache cache(scene, camera, folder_ / "cache", program);
    return cache.get(options, nullptr).fromFile;
  }

  cli::TemporaryFolder folder_;
  Scene scene_;
  Camera camera_;
  RenderOptions options_;
};

TEST_F(Cache, TheSecondTimeItComesFromTheFile) {
  ReferenceCache first(scene_, camera_, folder_ / "cache", "1");
  const Image image = first.get(options_, nullptr).image;
  EXPECT_FALSE(first.get(options_, nullptr).fromFile) << "the same run: from memory";
  ReferenceCache second(scene_, camera_, folder_ / "cache", "1");
  const ReferencePicture& again = second.get(options_, nullptr);
  EXPECT_TRUE(again.fromFile);
  EXPECT_EQ(again.image.pixels, image.pixels);
  EXPECT_GT(maxComponent(image.at(4, 3)), 0.0f);
}

TEST_F(Cache, AnotherSceneCameraOptionOrProgramMisses) {
  EXPECT_FALSE(hits(scene_, camera_, options_));
  EXPECT_TRUE(hits(scene_, camera_, options_));
  SceneDescription other = room();
  other.lights[0].intensity.x = 1.5f;
  EXPECT_FALSE(hits(test::finalized(std::move(other)), camera_, options_));
  Camera moved = camera_;
  moved.fov = 46;
  EXPECT_FALSE(hits(scene_, moved, options_));
  RenderOptions more = options_;
  more.spp = 3;
  EXPECT_FALSE(hits(scene_, camera_, more));
  more = options_;
  more.size = ImageSize{8, 7};
  EXPECT_FALSE(hits(scene_, camera_, more));
  more = options_;
  more.crop = Crop{0, 0, 4, 4};
  EXPECT_FALSE(hits(scene_, camera_, more));
  EXPECT_FALSE(hits(scene_, camera_, options_, "2"));
  EXPECT_TRUE(hits(scene_, camera_, options_)) << "still there";
}

TEST_F(Cache, ThreadsHit) {
  hits(scene_, camera_, options_);
  options_.threads = 2;
  EXPECT_TRUE(hits(scene_, camera_, options_));
}

// Neither a damaged file nor another picture under its name is believed.
TEST_F(Cache, ABrokenFileIsRenderedAgain) {
  hits(scene_, camera_, options_);
  std::filesystem::path file;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache"))
    file = entry.path();
  ASSERT_EQ(file.extension(), ".exr");
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_FALSE(hits(scene_, camera_, options_));
  EXPECT_TRUE(hits(scene_, camera_, options_));
  RenderOptions other = options_;
  other.spp = 1;
  ReferenceCache cache(scene_, camera_, folder_ / "cache", "1");
  const std::string name = cache.get(other, nullptr).digest + ".exr";
  std::filesystem::copy_file(std::filesystem::path(folder_ / "cache") / name, file,
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_FALSE(hits(scene_, camera_, options_));
}

TEST_F(Cache, AFolderThatCannotBeMadeIsAnError) {
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THROW(ReferenceCache(scene_, camera_, folder_ / "file/cache", "1"), Error);
}

// By packets, of several seeds; kept with what is known of its error.
class TransportCache : public Cache {
 protected:
  TransportCache() {
    options_ = transportOptions(RenderOptions(), 2);
    options_.size = ImageSize{8, 6};
    options_.threads = 1;
  }
  TransportPicture get(const RenderOptions& options, const std::string& program = "1") {
    ReferenceCache cache(scene_, camera_, folder_ / "cache", program);
    return cache.transport(options, nullptr);
  }
};

TEST_F(TransportCache, GivesTheSameBackWithItsError) {
  const TransportPicture first = get(options_), again = get(options_);
  EXPECT_FALSE(first.fromFile);
  EXPECT_TRUE(again.fromFile);
  EXPECT_EQ(again.image.pixels, first.image.pixels);
  EXPECT_EQ(again.samples, 2 * kTransportPasses);
  EXPECT_EQ(again.passes, kTransportPasses);
  EXPECT_GT(first.standardError, 0) << "the sky lights the square";
  EXPECT_NEAR(again.standardError, first.standardError, 1e-8 * first.standardError);
  EXPECT_NEAR(again.meanRadiance, first.meanRadiance, 1e-8 * first.meanRadiance);
  EXPECT_NEAR(again.noiseFlip, first.noiseFlip, 1e-8);
}

// The mean of frames of seeds 0 to 7, and no other picture.
TEST_F(TransportCache, IsTheMeanOfItsPasses) {
  const TransportPicture picture = get(options_);
  Renderer renderer(scene_, options_);
  Film film = makeFilm(scene_, options_);
  PassMean passes;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    renderer.setSeed(seed);
    renderer.render(camera_, film);
    passes.add(film.image);
  }
  EXPECT_EQ(picture.image.pixels, passes.mean().pixels);
  EXPECT_EQ(picture.standardError, passes.standardError());
}

TEST_F(TransportCache, WhatItDependsOnMisses) {
  get(options_);
  RenderOptions other = options_;
  other.indirect = 1;
  EXPECT_FALSE(get(other).fromFile);
  other = options_;
  other.spp = 3;
  EXPECT_FALSE(get(other).fromFile);
  EXPECT_FALSE(get(options_, "2").fromFile);
  other = options_;
  other.threads = 2;
  EXPECT_TRUE(get(other).fromFile);
}

}  // namespace
}  // namespace whit::accuracy
