// Masks and sides where Embree's barycentric coordinates and normals are too rough to decide
// whether there is a hit: the ray and the triangle decide in double, so that all processors agree.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "accel/accel.h"
#include "render/data_map.h"
#include "unit/scene_builder.h"

namespace whit::test {
namespace {

constexpr int kCloseRays = 200000;

// Alpha is 0 and 1 in turn from column to column, so that it crosses 0.5 once in a texel.
constexpr int kStripes = 64;

SceneDescription stripedSquare() {
  SceneDescription d = sceneOf(square());
  d.objects[0].meshes[0].uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

  std::vector<float> stripes;
  for (int i = 0; i < kStripes; ++i) stripes.push_back(i % 2 == 0 ? 1.0f : 0.0f);
  d.textures = {dataMap(kStripes, stripes)};
  d.textures[0].wrapU = d.textures[0].wrapV = Wrap::clamp;
  d.materials[0].alphaMap = 0;
  d.materials[0].alphaCutoff = 0.5f;
  return d;
}

double alphaOfStripes(double x) {
  const double column = x * kStripes - 0.5, left = std::floor(column);
  const double fraction = column - left;
  return static_cast<int>(left) % 2 == 0 ? 1 - fraction : fraction;
}

// The square is seen from 200 times its size away: Embree's barycentric coordinates are off by some
// 1e-5 there, and alpha changes 64 times as fast.
void expectStripesAreExact(float size) {
  // Alpha is rounded in float: a coordinate's last bit times the number of columns, a few times
  // over.
  constexpr double kOpen = 8 * kStripes * 0x1p-24;
  constexpr float kFar = std::numeric_limits<float>::infinity();

  SceneDescription d = stripedSquare();
  for (Vec3f& p : d.objects[0].meshes[0].positions) p *= size;
  const Scene scene = finalized(std::move(d));
  const Accel accel(scene, RenderOptions());
  std::mt19937 random(3);
  std::uniform_int_distribution<int> edge(1, kStripes - 2);
  std::uniform_real_distribution<float> beside(-1e-4f, 1e-4f), height(0.1f, 0.9f), off(-30, 30);
  int decided = 0, wrong = 0, wrongShadows = 0;

  for (int i = 0; i < kCloseRays; ++i) {
    const float x = static_cast<float>(edge(random)) / kStripes + beside(random);
    const Vec3f origin{off(random), off(random), 200};
    const Vec3f direction = Vec3f{x, height(random), 0} - origin;
    const double t = -double{origin.z} / double{direction.z};
    const double margin = alphaOfStripes(double{origin.x} + t * double{direction.x}) - 0.5;
    if (std::abs(margin) < kOpen) continue;
    ++decided;
    wrong += accel.closest(origin * size, direction).found() != (margin > 0);
    wrongShadows += accel.occluded(origin * size, direction, kFar) != (margin > 0);
  }

  EXPECT_EQ(wrong, 0) << "of " << decided;
  EXPECT_EQ(wrongShadows, 0) << "of " << decided;
  EXPECT_GT(decided, kCloseRays / 2);
}

// Embree does not say where rays hit the smallest of these triangles.
TEST(CloseCalls, OfMasksAreDecidedByTheRay) {
  for (const float size : {1.0f, 0x1p-17f, 0x1p-36f, 0x1p-50f}) {
    SCOPED_TRACE(size);
    expectStripesAreExact(size);
  }
}

// The square is single-sided, seen nearly edge-on, and tilted so that no product of its slope is
// exact.
TEST(CloseCalls, OfSidesAreDecidedByTheRay) {
  // Double rounds the sum of three products by so much.
  constexpr double kOpen = 0x1p-48;

  SceneDescription d = sceneOf(square());
  d.materials[0].doubleSided = false;
  const Vec3d right = normalized(Vec3d{0.8, 0.31, -0.47}), up = normalized(Vec3d{-0.2, 0.9, 0.37});
  for (Vec3f& p : d.objects[0].meshes[0].positions) {
    p = Vec3f(right * double{p.x} + up * double{p.y});
  }
  const Scene scene = finalized(std::move(d));

  const Accel accel(scene, RenderOptions());
  std::mt19937 random(4);
  std::uniform_real_distribution<double> inside(0.2, 0.8), tilt(-3e-7, 3e-7), turn(0, 6.28);
  int found = 0, wrong = 0;

  for (int i = 0; i < kCloseRays; ++i) {
    const double angle = turn(random);
    const Vec3d target = right * inside(random) + up * inside(random);
    const Vec3d along = right * std::cos(angle) + up * std::sin(angle);
    const Vec3d normal = normalized(cross(right, up));
    const Vec3f origin(target - (along + normal * tilt(random)) * 4.0);
    const Vec3f direction = Vec3f(target) - origin;
    const Hit hit = accel.closest(origin, direction);
    if (!hit.found()) continue;
    ++found;

    const Vec3d n = faceOf(scene.triangles[hit.triangle]);
    const Vec3d terms{n.x * double{direction.x}, n.y * double{direction.y},
                      n.z * double{direction.z}};

    const double size = std::abs(terms.x) + std::abs(terms.y) + std::abs(terms.z);
    wrong += terms.x + terms.y + terms.z > kOpen * size;
  }

  EXPECT_EQ(wrong, 0) << "of " << found << " were met from behind";
  EXPECT_GT(found, kCloseRays / 10);
}

}  // namespace
}  // namespace whit::test
