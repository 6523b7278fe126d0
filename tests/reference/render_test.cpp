// Whole images: crops, threads, determinism.
#include <gtest/gtest.h>

#include <stdexcept>

#include "reference/small_scenes.h"
#include "verify/scaled_scene.h"

namespace whit::reference {
namespace {

using namespace test;

// Returns a scene with opaque, mirroring and refracting surfaces, a light, a sky and ambient light,
// at a scale of 2^power.
Scene stillLife(int power = 0) {
  SceneBuilder builder = withFloor(diffuseMaterial(0.6f), 6);
  Material coated = diffuseMaterial(0.2f);
  coated.mirror = Rgb(0.3f);
  coated.mirrorGrazing = Rgb(1.0f);

  builder.add(box({-2, 0, -1}, {-1, 1, 0}), coated);
  builder.add(box({0.2f, 0.1f, 0}, {1.2f, 1.1f, 1}), glassMaterial(1.5f));

  builder.sky(0.7f);
  builder.description.ambient = {Rgb(0.2f), Rgb(0.1f)};

  builder.description.lights = {lightAt({2, 4, 3}, 20)};
  builder.lookFrom({0, 2, 5});
  Warnings strict(true);
  return repaired(scaled(builder.describe(), power), &strict);
}

// Counts the reports, which come from one thread.
class CountingProgress : public Progress {
 public:
  void report(const std::string&, double fraction) override {
    ++reports;
    last = std::max(last, fraction);
  }

  int reports = 0;
  double last = 0;
};

// An observer of the progress may end the work by an exception, on any thread.
class FailingProgress : public Progress {
 public:
  void report(const std::string&, double fraction) override {
    if (fraction > 0.4) throw std::runtime_error("enough");
  }
};

TEST(Render, DoesNotDependOnThreads) {
  const Scene scene = stillLife();
  const BruteForce bruteForce(scene);
  Settings settings;
  settings.options.spp = 2;

  Image one(40, 25);
  const RayCounts counts = render(scene, bruteForce, scene.cameras[0], settings, one);
  EXPECT_EQ(counts[RayKind::primary], 2000u);

  for (const int threads : {2, 3, 40}) {
    settings.threads = threads;
    Image image(40, 25);
    const RayCounts again = render(scene, bruteForce, scene.cameras[0], settings, image);
    EXPECT_EQ(image.pixels, one.pixels) << threads;
    for (const RayKind kind : {RayKind::shadow, RayKind::reflection, RayKind::refraction}) {
      EXPECT_EQ(again[kind], counts[kind]);
      EXPECT_GT(again[kind], 0u);
    }
  }
}

TEST(Render, CropIsPartOfTheImage) {
  const Scene scene = stillLife();
  const BruteForce bruteForce(scene);
  const Settings settings;

  Image whole(40, 25), part(40, 25, {13, 7, 30, 20});
  render(scene, bruteForce, scene.cameras[0], settings, whole);
  CountingProgress progress;
  render(scene, bruteForce, scene.cameras[0], settings, part, &progress);

  for (int y = 7; y < 20; ++y) {
    for (int x = 13; x < 30; ++x) EXPECT_EQ(part.at(x, y), whole.at(x, y)) << x << ", " << y;
  }

  EXPECT_EQ(progress.reports, 13);
  EXPECT_EQ(progress.last, 1);
}

TEST(Render, WhatIsThrownForARowReachesTheCaller) {
  const Scene scene = stillLife();
  const BruteForce intersector(scene);
  for (const int threads : {1, 2, 5}) {
    Settings settings;
    settings.threads = threads;
    FailingProgress progress;
    Image image(17, 13);
    EXPECT_THROW(render(scene, intersector, scene.cameras[0], settings, image, &progress),
                 std::runtime_error)
        << threads;
  }
}

// A scale by a power of two changes no bit (hard case H61a).
TEST(Render, PowerOfTwoScaleChangesNothing) {
  const Scene scene = stillLife();
  Image original(20, 12);
  render(scene, BruteForce(scene), scene.cameras[0], Settings{}, original);

  for (const int power : {-10, 10}) {
    const Scene other = stillLife(power);
    Image image(20, 12);
    render(other, BruteForce(other), other.cameras[0], Settings{}, image);
    EXPECT_EQ(image.pixels, original.pixels) << power;
  }
}

// All effects, or only those that the scene needs, give the same image. (This is one of the laws of
// the kernels.)
TEST(Render, EffectsOfTheSceneAreEnough) {
  const Scene scene = stillLife();
  Settings settings;
  Image all(20, 12), few(20, 12);
  render(scene, BruteForce(scene), scene.cameras[0], settings, all);

  settings.effects = scene.effects;
  ASSERT_NE(settings.effects, EffectSet::all());
  render(scene, BruteForce(scene, scene.effects), scene.cameras[0], settings, few);
  EXPECT_EQ(few.pixels, all.pixels);
}

}  // namespace
}  // namespace whit::reference
