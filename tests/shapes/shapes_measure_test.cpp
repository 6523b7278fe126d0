// Areas, volumes and triangle counts against formulas. Inscribed polygons with n sides miss a
// circle by a relative 2 pi^2 / (3 n^2) in area, which bounds the tolerances below.
#include <gtest/gtest.h>

#include "pi.h"
#include "shapes/generated.h"
#include "shapes/mesh_measures.h"

namespace whit::test {
namespace {

// Corners are rounded to float by 2^-24 relative each, in sums of up to six products of three.
constexpr double kFloat = 2e-6;

// Returns the area of the regular n-gon over that of its circumscribed circle.
double polygonShare(int n) { return n / (2 * kPi) * std::sin(2 * kPi / n); }

TEST(Measures, SpheresApproachTheirVolumeAndArea) {
  const Mesh shape = meshOf("sphere", "'radius': 2, 'segments': 128");
  const double miss = 3 * 2 * kPi * kPi / (3 * 128.0 * 128.0);  // three directions of curvature

  EXPECT_NEAR(volume(shape) / (4.0 / 3 * kPi * 8), 1, miss);
  EXPECT_LT(volume(shape), 4.0 / 3 * kPi * 8);
  EXPECT_NEAR(area(shape) / (4 * kPi * 4), 1, miss);

  // There are two fans at the poles, and two triangles a cell between them.
  EXPECT_EQ(shape.triangles.size(), 128u * (2 * 62 + 2));
}

TEST(Measures, IcospheresQuadrupleTheirTriangles) {
  for (int level = 0; level < 5; ++level) {
    const Mesh shape = meshOf("icosphere", joined("'level': ", level));
    EXPECT_EQ(shape.triangles.size(), 20u << (2 * level));
  }

  // The icosahedron in the unit sphere has the volume (5/12)(3 + sqrt 5) a^3, where
  // a = 1 / sin(2 pi / 5).
  const double edge = 1 / std::sin(2 * kPi / 5);
  EXPECT_NEAR(volume(meshOf("icosphere", "'level': 0")),
              5.0 / 12 * (3 + std::sqrt(5.0)) * edge * edge * edge, 10 * kFloat);
}

struct Measured {
  const char* name;
  const char* members;  // of a scene file
  double volume;
  std::optional<double> area{};
};

// Sheets lie in a plane through the origin, where the volume is 0.
TEST(Measures, FlatFacesAreExact) {
  const double share = polygonShare(24), opening = 2 * 2.0 + kPi / 2 * polygonShare(128);
  const Measured shapes[] = {
      {"cylinder", "'radius': 1.5, 'height': 3, 'segments': 24", kPi * 2.25 * 3 * share},
      {"cone", "'radius': 1.5, 'height': 3, 'segments': 24", kPi * 2.25 * share},
      {"disc", "'radius': 2, 'segments': 24", 0, kPi * 4 * share},
      {"box", "'size': [1, 2, 3]", 6, 22},
      {"quad", "'width': 3, 'depth': 2", 0, 6},
      {"stairs", "'steps': 4, 'rise': 0.2, 'run': 0.3, 'width': 2",
       2 * 0.2 * 0.3 * (1 + 2 + 3 + 4)},
      // A box less the openings.
      {"wall",
       "'spacing': 3, 'bays': 4, 'height': 5, 'depth': 0.5, 'openingWidth': 2, 'spring': 2.5, "
       "'sill': 0.5, 'segments': 64",
       0.5 * (12 * 5 - 4 * opening)},
      // Half a ring.
      {"arch", "'width': 2, 'thickness': 0.5, 'depth': 0.4, 'segments': 50",
       0.4 * kPi / 2 * (2.25 - 1) * polygonShare(100)},
  };

  for (const Measured& shape : shapes) {
    const Mesh mesh = meshOf(shape.name, shape.members);
    EXPECT_NEAR(volume(mesh), shape.volume, kFloat * shape.volume) << shape.name;
    if (shape.area) {
      EXPECT_NEAR(area(mesh), *shape.area, kFloat * *shape.area) << shape.name;
    }
  }

  EXPECT_EQ(meshOf("box").triangles.size(), 12u);
  EXPECT_GT(areaVector(meshOf("quad"), 0).y, 0) << "faces up";
}

TEST(Measures, TorusFollowsPappus) {
  const Mesh shape =
      meshOf("torus", "'radius': 2, 'tubeRadius': 0.5, 'segments': 200, 'rings': 100");
  const double miss = 2 * kPi * kPi / 3 * (1 / 1e4 + 3 / 4e4);
  EXPECT_NEAR(volume(shape) / (2 * kPi * kPi * 2 * 0.25), 1, miss);
  EXPECT_NEAR(area(shape) / (4 * kPi * kPi * 2 * 0.5), 1, miss);
}

TEST(Measures, RoundedBoxFollowsSteiner) {
  const double r = 0.2;
  const Vec3d core = Vec3d{1, 2, 3} - Vec3d(2 * r);
  const Mesh shape = meshOf("roundedBox", "'size': [1, 2, 3], 'radius': 0.2, 'steps': 12");

  // Steiner's formula gives the volume of a box grown by r.
  const double faces = core.x * core.y + core.y * core.z + core.z * core.x;
  const double edges = core.x + core.y + core.z;
  const double exact =
      core.x * core.y * core.z + 2 * faces * r + kPi * edges * r * r + 4.0 / 3 * kPi * r * r * r;

  EXPECT_NEAR(volume(shape), exact, 0.003 * exact);
  EXPECT_LT(volume(shape), exact);
}

TEST(Measures, GroinVaultMeetsItsBarrels) {
  const Mesh shape = meshOf("vault", "'width': 4, 'depth': 4, 'segments': 64");

  // A quarter of the square shows the strip |x| < z of a half cylinder of radius a, whose area is
  // the integral of 2 a asin(z / a) over [0, a], 2 a^2 (pi / 2 - 1).
  const double a = 2;
  EXPECT_NEAR(area(shape) / (8 * a * a * (kPi / 2 - 1)), 1, 0.01);

  for (const std::size_t t : indices(shape.triangles)) {
    ASSERT_LE(areaVector(shape, t).y, 1e-9) << "seen from below";
  }
}

TEST(Measures, SphereNormalsPointAwayFromTheCenter) {
  const Mesh shape = meshOf("sphere", "'radius': 3, 'segments': 64");
  for (const std::size_t k : indices(shape.positions)) {
    const Vec3d out = normalized(Vec3d(shape.positions[k]));
    EXPECT_NEAR(dot(out, Vec3d(shape.normals[k])), 1, kFloat);
  }
}

TEST(Measures, ColumnsStandBetweenFloorAndHeight) {
  const Shape shape = generate("column", "'height': 5, 'radius': 0.4, 'flutes': 16");
  ASSERT_EQ(shape.parts.size(), 2u);

  Box bounds;
  for (const ShapePart& part : shape.parts) {
    for (const Vec3f& p : part.mesh.positions) bounds.add(p);
  }
  EXPECT_EQ(bounds.lower.y, 0);
  EXPECT_EQ(bounds.upper.y, 5);
}

}  // namespace
}  // namespace whit::test
