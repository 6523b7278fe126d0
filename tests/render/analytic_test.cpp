// The vector pipeline against closed forms: pictures whose every pixel is known.
#include <gtest/gtest.h>

#include <cmath>

#include "inspect/reference_frame.h"
#include "inspect/stage_comparison.h"
#include "pi.h"
#include "reference/generate_rays.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// A float is rounded twenty times in a formula of about that many operations.
constexpr double kFloatFormula = 20 * 0x1p-24;

Camera lookingDown() {
  Camera camera;
  camera.eye = {0, 3, 0};
  camera.at = {0, 0, 0};
  camera.up = {0, 0, -1};
  camera.fov = 50;
  return camera;
}

Image pictureOf(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  renderer.render(camera, film);
  return film.image;
}

// The point of the floor that a pixel's center sees reflects I kd / pi cos / d^2.
TEST(Analytic, LightFallsOffOverAPlane) {
  SceneBuilder builder;
  builder.add(floorAt(0, 8, builder.add(diffuseMaterial(0.5f))));
  const Light light = lightAt({0.5f, 2, -0.25f}, 10);
  builder.description.lights.push_back(light);
  const Scene scene = builder.build();
  const RenderOptions o = smallOptions();
  const Image image = pictureOf(scene, lookingDown(), o);
  const CameraFrame frame = makeCameraFrame(lookingDown(), image.width, image.height);

  double worst = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Ray ray = reference::generateRay(frame, x + 0.5, y + 0.5);
      const Vec3d point = ray.origin + ray.direction * (-ray.origin.y / ray.direction.y);
      const Vec3d l = Vec3d(light.position) - point;
      const double wanted = 10 * 0.5 / kPi * (l.y / length(l)) / dot(l, l);
      const double got = static_cast<double>(image.at(x, y).x);
      worst = std::max(worst, std::fabs(got / wanted - 1));
    }
  }

  // The point where the ray hits the floor carries the rounding of the ray's direction, times
  // distance over height.
  constexpr double kBound = 4 * kFloatFormula;
  std::printf("light falloff: worst relative error %.3g, bound %.3g\n", worst, kBound);
  EXPECT_LE(worst, kBound);
}

// The camera looks straight down on a floor that emits in the square [0, 1] x [-1, 0] only, so the
// picture is a map, whatever the eye's distance, in packets and in the reference.
TEST(Analytic, AnOrthographicCameraDrawsAMap) {
  SceneBuilder builder;
  Material glowing = blackMaterial();
  glowing.emission = Rgb(1.0f);
  builder.add(quad({0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, builder.add(glowing)));
  const Scene scene = builder.build();

  for (const float distance : {1.0f, 1000.0f}) {
    Camera camera = lookingDown();
    camera.eye.y = distance;
    camera.orthographicHeight = 4;
    RenderOptions o = smallOptions();
    o.size = ImageSize{60, 40};  // ten pixels a unit
    Renderer renderer(scene, o);
    Film packets = makeFilm(scene, o), reference = makeFilm(scene, o);
    renderer.render(camera, packets);
    renderReference(renderer, camera, reference);

    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 60; ++x) {
        const bool inside = x >= 30 && x < 40 && y >= 10 && y < 20;
        ASSERT_EQ(packets.image.at(x, y), Rgb(inside ? 1.0f : 0.0f)) << x << "," << y;
        ASSERT_EQ(reference.image.at(x, y), packets.image.at(x, y)) << x << "," << y;
      }
    }

    for (const StageDifference& row : compareStages(renderer, camera, packets)) {
      EXPECT_LE(row.worstUlp, row.limitUlp) << row.column;
    }
  }
}

// A scene without any material: the tables of the kernels must not be empty because of that.
TEST(Analytic, NothingShowsTheSky) {
  SceneBuilder builder;
  builder.sky(0.25f);
  SceneDescription description = builder.description;
  description.materials.clear();
  const Scene scene = repaired(std::move(description));
  ASSERT_TRUE(scene.materials.empty());

  const Image image = pictureOf(scene, lookingDown(), smallOptions());
  for (const Rgb& pixel : image.pixels) EXPECT_EQ(pixel, Rgb(0.25f));
}

// A mirror of reflectance R reflects a sky of radiance 1, and there is nothing else.
TEST(Analytic, MirrorShowsTheSky) {
  SceneBuilder builder;
  builder.add(floorAt(0, 8, builder.add(mirrorMaterial(0.75f))));
  builder.sky(1);
  const Image image = pictureOf(builder.build(), lookingDown(), smallOptions());
  for (const Rgb& pixel : image.pixels) EXPECT_EQ(pixel, Rgb(0.75f));
}

// H43: white light falls on both sides of a slab of glass. The loss is the light that is still
// inside at the deepest impulse; at normal incidence R^d (1 - R).
TEST(Analytic, H43_whiteFurnaceThroughAGlassSlab) {
  SceneBuilder builder;
  addSlab(builder, 0, -1, builder.add(glassMaterial(1.5f)), 50);
  builder.sky(1);
  const Scene scene = builder.build();

  for (const int inside : {1, 2, 3, 4}) {
    RenderOptions o = smallOptions();
    o.size = ImageSize{1, 1};
    o.depth = inside + 1;
    o.cutoff = 0;
    const double got = static_cast<double>(pictureOf(scene, lookingDown(), o).pixels[0].x);
    const double wanted = 1 - std::pow(0.04, inside) * 0.96;
    std::printf("furnace, %d inside: %.9f, exactly %.9f\n", inside, got, wanted);
    EXPECT_NEAR(got, wanted, 1e-6) << inside;
  }

  // At all angles of the view the loss is below the bound after 12 impulses.
  RenderOptions deep = smallOptions();
  deep.depth = 12;
  deep.cutoff = 0;
  for (const Rgb& pixel : pictureOf(scene, lookingDown(), deep).pixels) {
    EXPECT_NEAR(static_cast<double>(pixel.x), 1.0, 1e-6);
  }
}

// H43: the slab is coated, and its faces reflect R = m + (1 - m) F.
TEST(Analytic, H43_whiteFurnaceThroughACoatedSlab) {
  for (const float mirror : {0.05f, 0.2f, 0.5f, 1.0f}) {
    Material coated = glassMaterial(1.5f);
    coated.mirror = coated.mirrorGrazing = Rgb(mirror);
    SceneBuilder builder;
    addSlab(builder, 0, -1, builder.add(coated), 50);
    builder.sky(1);
    const Scene scene = builder.build();

    const double r = static_cast<double>(mirror) * 0.96 + 0.04;
    for (const int inside : {1, 4, 31}) {
      RenderOptions o = smallOptions();
      o.size = ImageSize{1, 1};
      o.depth = inside + 1;
      o.cutoff = 0;
      const double got = static_cast<double>(pictureOf(scene, lookingDown(), o).pixels[0].x);
      EXPECT_NEAR(got, 1 - std::pow(r, inside) * (1 - r), 1e-6) << mirror << " " << inside;
    }
  }
}

// H62: between two mirrors of reflectance R that emit 1, each pixel is the sum of R^k for k from 0
// to the depth.
TEST(Analytic, H62_hallOfMirrorsIsAGeometricSeries) {
  for (const float reflectance : {0.5f, 0.9f, 1.0f}) {
    Material mirror = mirrorMaterial(reflectance);
    mirror.emission = Rgb(1.0f);
    SceneBuilder builder;
    const std::uint32_t material = builder.add(mirror);
    builder.add(floorAt(0, 4000, material));
    builder.add(ceilingAt(4, 4000, material));
    const Scene scene = builder.build();

    for (const int depth : {0, 1, 8, 32}) {
      RenderOptions o = smallOptions();
      o.depth = depth;
      o.cutoff = 0;
      // Each reflection adds the emission of another mirror.
      double wanted = 0;
      for (int k = 0; k <= depth; ++k) wanted += std::pow(static_cast<double>(reflectance), k);
      for (const Rgb& pixel : pictureOf(scene, lookingDown(), o).pixels) {
        ASSERT_NEAR(static_cast<double>(pixel.x) / wanted, 1.0, (depth + 1) * 0x1p-23)
            << reflectance << " depth " << depth;
      }
    }
  }
}

// H44, H38: glass whose ior is exactly 1 is invisible at any angle.
TEST(Analytic, H38_glassOfIorOneIsInvisible) {
  const auto picture = [](bool withGlass) {
    SceneBuilder builder;
    builder.add(floorAt(0, 8, builder.add(diffuseMaterial(0.5f))));
    builder.description.lights.push_back(lightAt({0.5f, 2.5f, 0}, 10));

    Material air = glassMaterial(1);
    air.castsShadow = false;
    const std::uint32_t material = builder.add(air);
    if (withGlass) builder.add(box({-0.5f, 0.5f, -0.5f}, {0.5f, 1, 0.5f}, material));
    return pictureOf(builder.build(), lookingDown(), smallOptions());
  };

  const Image with = picture(true), without = picture(false);
  for (std::size_t i = 0; i < with.pixels.size(); ++i) {
    // The ray starts anew at both faces, each time off by the offset of its origin.
    EXPECT_NEAR(static_cast<double>(with.pixels[i].x), static_cast<double>(without.pixels[i].x),
                1e-5 * static_cast<double>(without.pixels[i].x));
  }
}

// H63: light takes both impulses at twenty faces. Memory and bits depend neither on the depth of
// the tree of paths nor on the size of the queues.
TEST(Analytic, H63_aStackOfPlatesNeedsNoMoreThanItsQueues) {
  SceneBuilder builder;
  const std::uint32_t glass = builder.add(glassMaterial(1.5f));
  for (int i = 0; i < 10; ++i) {
    addSlab(builder, 1.0f - 0.2f * static_cast<float>(i), 0.9f - 0.2f * static_cast<float>(i),
            glass, 50);
  }
  builder.sky(1);
  const Scene scene = builder.build();

  RenderOptions o = smallOptions();
  o.size = ImageSize{24, 16};
  o.depth = 20;
  o.cutoff = 1e-4f;
  const Image expected = pictureOf(scene, lookingDown(), o);

  o.queue = 16;
  o.threads = 1;  // a worker takes memory with its first tile
  Renderer renderer(scene, o);
  Film film = makeFilm(scene, o);
  renderer.render(lookingDown(), film);
  EXPECT_EQ(firstDifference(film.image, expected), "");

  const std::uint64_t once = renderer.memoryBytes();
  renderer.render(lookingDown(), film);
  EXPECT_EQ(renderer.memoryBytes(), once);

  o.depth = 64;
  Renderer deeper(scene, o);
  deeper.render(lookingDown(), film);

  // Each further depth takes at most one queue.
  constexpr std::uint64_t kBytesADepth = 16 * 1024;
  EXPECT_LE(deeper.memoryBytes(), once + 44 * kBytesADepth);
}

}  // namespace
}  // namespace whit::test
