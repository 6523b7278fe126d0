// The soft shadow on the ground below a model.
#include "make/ground_shadow.h"

#include <cmath>

#include "make/model_view.h"
#include "make/shape.h"
#include "scene_builder.h"

namespace whit {
namespace {

using namespace test;

// A sphere of radius r that touches a plane holds off r^3 / (r^2 + d^2)^1.5 of its light at the
// distance d from the point that it touches: r^2 / D^2 times the cosine r / D, with
// D^2 = r^2 + d^2, because it is whole above the horizon.
void expectTheClosedForm(bool exact, double bound) {
  constexpr double kRadius = 2;
  const Vec3d center{3, 5, -4};
  Mesh mesh;
  mesh.materials = {0};
  mesh.spheres = {Affine::scaling(Vec3d(kRadius))};
  if (!exact) procedural::tessellateSpheres(mesh, 64);
  SceneDescription scene = placedAs(mesh, Affine::translation(center));
  addGroundShadow(scene);

  // The sheet lies just below the sphere, and casts no shadow.
  const Mesh& sheet = scene.objects.back().meshes.at(0);
  const Material& material = scene.materials.at(sheet.materials.at(0));
  ASSERT_GE(material.coverageMap, 0);
  EXPECT_FALSE(material.castsShadow);
  EXPECT_FALSE(material.doubleSided);
  EXPECT_NEAR(sheet.positions[0].y, center.y - kRadius, 0.01 * kRadius);
  const double half = sheet.positions[1].x - center.x;

  const Texture& shadow = scene.textures.at(material.coverageMap);
  for (int column = 0; column < shadow.width; ++column) {
    for (const int row : {shadow.height / 2, shadow.height / 3, column}) {
      const double x = (2 * (column + 0.5) / shadow.width - 1) * half;
      const double z = (2 * (row + 0.5) / shadow.height - 1) * half;
      const double distance = std::hypot(x, z);
      const double coverage = (shadow.texel(column, row) & 255u) / 255.0;
      if (distance > 0.95 * half) {
        EXPECT_LE(coverage, 0.05) << "it fades out before the edge";
      } else if (distance < 0.7 * half) {
        const double expected = std::pow(1 + distance * distance / (kRadius * kRadius), -1.5);
        ASSERT_NEAR(coverage, expected, bound) << column << " " << row;
      }
    }
  }
}

TEST(GroundShadow, OfASphereHasItsClosedForm) {
  // 256 directions and 256 texels sample the hemisphere and the sheet.
  constexpr double kBound = 0.02;
  expectTheClosedForm(false, kBound);

  // The facets by which exact spheres are looked at are up to half a percent of a radius inside.
  constexpr double kBoundOfFacets = 0.01;
  expectTheClosedForm(true, kBound + kBoundOfFacets);
}

TEST(GroundShadow, IsNoPartOfTheModel) {
  SceneDescription scene = sceneOf(square());
  const Camera before = viewOf(scene).camera;
  addGroundShadow(scene);
  EXPECT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(viewOf(scene).camera.eye, before.eye);
  EXPECT_EQ(viewOf(scene).radius, viewOf(sceneOf(square())).radius);
}

}  // namespace
}  // namespace whit
