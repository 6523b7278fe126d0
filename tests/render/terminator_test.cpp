// --terminator: the border of the light on a smooth surface of flat facets (hard case H35).
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/generate_rays.h"
#include "reference/small_scenes.h"
#include "render/facetted_sphere.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// The light is not along an edge between facets. The irradiance at the origin is 1.
const Vec3f kLight{224, 96, 64};
constexpr float kIntensity = 224 * 224 + 96 * 96 + 64 * 64;

// The sphere is lit from the right and seen from the front. Multiplying lengths by 2^k does not
// change the radiance.
Scene sphereScene(int k = 0, bool occluder = false) {
  SceneBuilder builder;
  Mesh sphere = facettedSphere(builder.add(diffuseMaterial(0.5f)));
  if (occluder) {
    builder.add(quad({1.1f, -0.4f, 0.4f}, {1.1f, -0.4f, -0.4f}, {1.1f, 0.4f, -0.4f},
                     {1.1f, 0.4f, 0.4f}, builder.add(blackMaterial())));
  }

  const float scale = std::ldexp(1.0f, k);
  for (Vec3f& p : sphere.positions) p = p * scale;
  builder.add(std::move(sphere));
  const Vec3f light = occluder ? Vec3f{256, 0, 0} : kLight;
  builder.description.lights.push_back(lightAt(light * scale, kIntensity * scale * scale));

  builder.description.cameras.resize(1);
  const Vec3f eye = occluder ? Vec3f{1.5f, 3, 2} : Vec3f{0, 0, 4};
  builder.description.cameras[0].eye = eye * scale;
  builder.description.cameras[0].at = {0, 0, 0};
  builder.description.cameras[0].fov = 34;
  return builder.build();
}

RenderOptions square(bool terminator) {
  RenderOptions o;
  o.size = ImageSize{120, 120};
  o.threads = 2;
  o.shading.terminator = terminator;
  return o;
}

// Returns the cosine of light and normal on the true sphere along a pixel's ray, or -2 where the
// ray misses the sphere.
double trueCosine(const CameraFrame& frame, int x, int y) {
  const reference::Ray ray = reference::generateRay(frame, x + 0.5, y + 0.5);
  const double b = dot(ray.origin, ray.direction);
  const double discriminant = b * b - dot(ray.origin, ray.origin) + 1;
  if (discriminant < 0) return -2;
  const Vec3d n = ray.origin + ray.direction * (-b - std::sqrt(discriminant));
  return dot(n, normalized(Vec3d(kLight) - n));
}

// Returns the RMSE over the band next to the terminator.
double bandError(const Scene& scene, const Image& image) {
  const CameraFrame frame = makeCameraFrame(scene.cameras[0], image.width, image.height);
  double sum = 0;
  int pixels = 0;

  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double cosine = trueCosine(frame, x, y);
      if (!(cosine > 0 && cosine < 0.3)) continue;
      const double error = static_cast<double>(image.at(x, y).x) - 0.5 / kPi * cosine;
      sum += error * error;
      ++pixels;
    }
  }
  return std::sqrt(sum / pixels);
}

TEST(Terminator, H35_lessErrorWhereTheLightEnds) {
  const Scene scene = sphereScene();
  const double off = bandError(scene, render(scene, square(false)).image);
  const double on = bandError(scene, render(scene, square(true)).image);
  std::printf("error next to the terminator: %.5f without, %.5f with\n", off, on);
  EXPECT_LE(on, 0.85 * off);
}

TEST(Terminator, H35_anOccluderStillCastsItsShadow) {
  const Scene scene = sphereScene(0, true);
  const Image image = render(scene, square(true)).image;
  const CameraFrame frame = makeCameraFrame(scene.cameras[0], image.width, image.height);

  int shaded = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const reference::Ray ray = reference::generateRay(frame, x + 0.5, y + 0.5);
      const double b = dot(ray.origin, ray.direction);
      const double discriminant = b * b - dot(ray.origin, ray.origin) + 1;
      if (discriminant < 0) continue;
      const Vec3d n = ray.origin + ray.direction * (-b - std::sqrt(discriminant));

      // These points are well inside the shadow of the square, and are visible past it.
      if (n.x < 0 || std::fabs(n.y) > 0.35 || std::fabs(n.z) > 0.35) continue;
      EXPECT_EQ(image.at(x, y), Rgb(0.0f)) << x << "," << y;
      ++shaded;
    }
  }

  EXPECT_GT(shaded, 10);
}

// Flat faces keep every bit: at their vertices the normals are those of the faces.
TEST(Terminator, H35_flatFacesAreLeftAlone) {
  SceneBuilder builder;

  // A smooth sphere far behind the camera gives the scene vertex normals.
  Mesh smooth = facettedSphere(builder.add(diffuseMaterial(0.5f)));
  for (Vec3f& p : smooth.positions) p = p + Vec3f{0, 0, 50};
  builder.add(std::move(smooth));

  builder.add(floorAt(-1, 20, builder.add(diffuseMaterial(0.7f))));
  builder.add(box({-1, -1, -1}, {1, 0.3f, 0.7f}, builder.add(diffuseMaterial(0.4f))));
  builder.description.lights.push_back(lightAt({2, 3, 1}, 20));
  builder.lookFrom({3, 2, 4});

  const Scene scene = builder.build();
  ASSERT_TRUE(scene.effects.has(Effect::smoothNormals));
  EXPECT_EQ(firstDifference(render(scene, square(true)).image, render(scene, square(false)).image),
            "");
}

TEST(Terminator, H61_scalingByPowersOfTwoChangesNoBit) {
  const Image expected = render(sphereScene(), square(true)).image;
  for (const int k : {-12, 9}) {
    EXPECT_EQ(firstDifference(render(sphereScene(k), square(true)).image, expected), "") << k;
  }
}

}  // namespace
}  // namespace whit::test
