// --terminator: the border of the light on a smooth surface of flat facets (hard case H35).
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/sample_mean.h"
#include "reference/small_scenes.h"
#include "render/facetted_sphere.h"
#include "render/scaled_scene.h"

namespace whit::test {
namespace {

// The light is not along an edge between facets. The irradiance at the origin is 1.
const Vec3f kLight{224, 96, 64};
constexpr float kIntensity = 224 * 224 + 96 * 96 + 64 * 64;

// The sphere is lit from the right and seen from the front.
SceneBuilder sphereSeenFrom(const Vec3f& eye, const Vec3f& light) {
  SceneBuilder builder;
  builder.add(facettedSphere(builder.add(diffuseMaterial(0.5f))));
  builder.description.lights = {lightAt(light, kIntensity)};
  builder.lookFrom(eye).fov = 34;
  return builder;
}
SceneBuilder litSphere() { return sphereSeenFrom({0, 0, 4}, kLight); }

RenderOptions square(bool terminator) {
  RenderOptions o;
  o.size = ImageSize{120, 120};
  o.threads = 2;
  o.shading.terminator = terminator;
  return o;
}

// Calls visit(normal, pixel) for the pixels that show the true sphere.
template <typename Visit>
void forEachPixelOfTheSphere(const Scene& scene, const Image& image, const Visit& visit) {
  forEachRay(scene, image, [&](const Ray& ray, const Rgb& seen) {
    const double b = dot(ray.origin, ray.direction);
    const double discriminant = b * b - dot(ray.origin, ray.origin) + 1;
    if (discriminant < 0) return;
    visit(ray.origin + ray.direction * (-b - std::sqrt(discriminant)), seen);
  });
}

// Returns the RMSE over the band next to the terminator.
double bandError(const Scene& scene, bool terminator) {
  SampleMean squares;
  const Image image = render(scene, square(terminator)).image;
  forEachPixelOfTheSphere(scene, image, [&](const Vec3d& n, const Rgb& seen) {
    const double cosine = dot(n, normalized(Vec3d(kLight) - n));
    if (!(cosine > 0 && cosine < 0.3)) return;
    const double error = seen.x - 0.5 / kPi * cosine;
    squares.add(error * error);
  });
  return std::sqrt(squares.value());
}

TEST(Terminator, H35_lessErrorWhereTheLightEnds) {
  const Scene scene = litSphere().build();
  EXPECT_LE(bandError(scene, true), 0.85 * bandError(scene, false));
}

TEST(Terminator, H35_anOccluderStillCastsItsShadow) {
  SceneBuilder builder = sphereSeenFrom({1.5f, 3, 2}, {256, 0, 0});
  builder.add(
      quad({1.1f, -0.4f, 0.4f}, {1.1f, -0.4f, -0.4f}, {1.1f, 0.4f, -0.4f}, {1.1f, 0.4f, 0.4f}),
      blackMaterial());
  const Scene scene = builder.build();

  int shaded = 0;
  const Image image = render(scene, square(true)).image;
  forEachPixelOfTheSphere(scene, image, [&](const Vec3d& n, const Rgb& seen) {
    // These points are well inside the shadow of the square, and are visible past it.
    if (n.x < 0 || std::fabs(n.y) > 0.35 || std::fabs(n.z) > 0.35) return;
    EXPECT_EQ(seen, Rgb(0.0f)) << n.y << "," << n.z;
    ++shaded;
  });
  EXPECT_GT(shaded, 10);
}

// Flat faces keep every bit: at their vertices the normals are those of the faces.
TEST(Terminator, H35_flatFacesAreLeftAlone) {
  SceneBuilder builder;

  // A smooth sphere far behind the camera gives the scene vertex normals.
  Mesh smooth = facettedSphere(builder.add(diffuseMaterial(0.5f)));
  for (Vec3f& p : smooth.positions) p = p + Vec3f{0, 0, 50};
  builder.add(std::move(smooth));

  builder.add(floorAt(-1, 20), diffuseMaterial(0.7f));
  builder.add(box({-1, -1, -1}, {1, 0.3f, 0.7f}), diffuseMaterial(0.4f));
  builder.description.lights.push_back(lightAt({2, 3, 1}, 20));
  builder.lookFrom({3, 2, 4});

  const Scene scene = builder.build();
  ASSERT_TRUE(scene.effects.has(Effect::smoothNormals));
  EXPECT_EQ(firstDifference(render(scene, square(true)), render(scene, square(false))), "");
}

TEST(Terminator, H61_scalingByPowersOfTwoChangesNoBit) {
  expectBitsAtAnyScale(litSphere().describe(), {-12, 9}, square(true));
}

}  // namespace
}  // namespace whit::test
