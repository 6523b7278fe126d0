// Frosted glass: its samples against integrals of Walter's lobes (Walter et al. 2007, "Microfacet
// models for refraction through rough surfaces"), energy, the limits of smooth glass, and how many
// rays there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/add_impulses.h"
#include "reference/fresnel.h"
#include "reference/lobe.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

// What 4096 points of a lattice leave of a smooth integrand, and the midpoint rule.
constexpr double kOfLattice = 2e-3;

// The level interface of frosted glass, seen at an angle with this cosine.
Surfel interfaceOf(double alpha, double n1, double n2, double viewCosine) {
  Surfel s = levelSurfel(alpha, 0, directionAt(viewCosine, 0.3));
  s.frosting.ofInterface = true;
  s.frosting.n1 = n1;
  s.frosting.n2 = n2;
  s.frosting.transmission = RgbD(1.0);
  return s;
}

Surfel sheetOf(double alpha, double f0, double viewCosine) {
  Surfel s = interfaceOf(alpha, 1, 1, viewCosine);
  s.frosting.ofInterface = false;
  s.frosting.ofSheet = s.frosting.reflects = true;
  s.specular = RgbD(f0);
  return s;
}

// The normal of the facet that refracts i to o, both directions of light.
Vec3d facetOf(double n1, double n2, const Vec3d& i, const Vec3d& o) {
  const Vec3d m = normalized(i * -n1 - o * n2);
  return m.z < 0 ? -m : m;
}

// Equation 21 of the paper, in its terms: i and o are the directions of light, m the facet's
// normal, and n1 is the index on the side of i. Zero where no facet refracts i to o.
double btdf(double alpha, double n1, double n2, const Vec3d& i, const Vec3d& o) {
  const Vec3d m = facetOf(n1, n2, i, o);
  const double im = dot(i, m), om = dot(o, m);
  if (!(im > 0) || !(om < 0) || !(i.z > 0) || !(o.z < 0)) return 0;
  const double g = smithG1(alpha, i.z) * smithG1(alpha, -o.z), root = n1 * im + n2 * om;
  return im * -om / (i.z * -o.z) * n2 * n2 * (1 - fresnelOf(n1, n2, im)) * g *
         facetsOf(alpha, m.z) / (root * root);
}

// The density of frosted directions: of visible normals, times the Jacobian of equation 17.
double densityOf(double alpha, double n1, double n2, const Vec3d& i, const Vec3d& o) {
  const Vec3d m = facetOf(n1, n2, i, o);
  const double im = dot(i, m), om = dot(o, m), root = n1 * im + n2 * om;
  return visibleDensity(alpha, i, m) * n2 * n2 * -om / (root * root);
}

struct Moments {
  double all = 0;
  Vec3d direction;  // mean, weighed
};

// Over directions behind the surface.
Moments transmittedByQuadrature(double alpha, double n1, double n2, const Vec3d& view) {
  constexpr int kRows = 600, kColumns = 300;
  Moments sum;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double c = (row + 0.5) / kRows;
      const Vec3d o = directionAt(-c, 2 * kPi * (column + 0.5) / kColumns);
      const double part = btdf(alpha, n1, n2, view, o) * c * 2 * kPi / (kRows * kColumns);
      sum.all += part;
      sum.direction += o * part;
    }
  }
  return sum;
}

Moments samplesOf(const Surfel& s, Impulse (*impulseOf)(const Surfel&, MediaStack, const UnitPoint&,
                                                        const ShadingChoices&)) {
  constexpr std::uint32_t kPoints = 4096;
  Moments sum;
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    const Impulse ray = impulseOf(s, 0, lobePoint(1, {kPoints, 0, 0}, k), {});
    sum.all += ray.weight.x / kPoints;
    if (ray.weight.x > 0) sum.direction += ray.ray.direction * (ray.weight.x / kPoints);
  }
  return sum;
}

TEST(FrostedGlass, SamplesHaveTheMeanOfWaltersLobe) {
  for (const auto& [n1, n2] : {std::array{1.0, 1.5}, {1.5, 1.0}, {1.0, 2.5}, {1.33, 1.1}}) {
    for (const double alpha : {0.15, 0.4, 1.0}) {
      for (const double viewCosine : {0.2, 0.6, 0.97}) {
        const Surfel s = interfaceOf(alpha, n1, n2, viewCosine);
        const Moments wanted = transmittedByQuadrature(alpha, n1, n2, s.view);
        const Moments found = samplesOf(s, frostedImpulse);
        EXPECT_NEAR(found.all, wanted.all, kOfLattice) << n1 << n2 << alpha << viewCosine;
        expectNear(found.direction, wanted.direction, kOfLattice);
      }
    }
  }
}

// weight = lobe * cosine / density, sample by sample.
TEST(FrostedGlass, SamplesWeighWhatTheLobeSaysOverTheirDensity) {
  Numbers numbers(11);
  int compared = 0;
  for (int i = 0; i < 4000; ++i) {
    const double n1 = numbers.in(1, 2.5), n2 = numbers.in(1, 2.5);
    if (std::fabs(n1 - n2) < 0.05) continue;  // rounding decides about the facet
    const Surfel s = interfaceOf(numbers.in(0.05, 1), n1, n2, numbers.in(0.02, 1));
    const UnitPoint point = pointOf(numbers);

    const Impulse ray = frostedImpulse(s, 0, point);
    const Vec3d& o = ray.ray.direction;
    if (ray.weight.x == 0 || o.z > -0.01) continue;

    const double wanted =
        btdf(s.alpha, n1, n2, s.view, o) * -o.z / densityOf(s.alpha, n1, n2, s.view, o);
    EXPECT_NEAR(ray.weight.x, wanted, 1e-7 * wanted) << s.alpha << ' ' << n1 << ' ' << n2;
    ++compared;
  }
  EXPECT_GT(compared, 2000);
}

// Reflected and transmitted, of even light from all around.
TEST(FrostedGlass, NeverSendsOutMoreThanItGets) {
  for (const double ior : {1.1, 1.5, 2.5}) {
    for (const auto& [n1, n2] : {std::array{1.0, ior}, {ior, 1.0}}) {
      for (const double viewCosine : {0.05, 0.4, 0.75, 1.0}) {
        for (const double roughness : {0.0, 0.04, 0.1, 0.3, 0.6, 1.0}) {
          const Surfel s = interfaceOf(roughness * roughness, n1, n2, viewCosine);
          double largest = 0, sum = 0;
          for (std::uint32_t k = 0; k < 1024; ++k) {
            const UnitPoint point = lobePoint(2, {1024, 0, 0}, k);
            const RgbD both =
                glossyImpulse(s, 0, point).weight + frostedImpulse(s, 0, point).weight;
            largest = std::max(largest, both.x);
            sum += both.x / 1024;
          }

          // Roundings, of each facet.
          EXPECT_LE(largest, 1 + 1e-12);

          // What facets mask is lost, as of every lobe: nothing if the surface is smooth, and along
          // the normal at most what the roughest metal loses, which keeps 1 - log 2.
          if (roughness == 0) {
            EXPECT_NEAR(sum, 1, 1e-12);
          } else if (roughness <= 0.1 && viewCosine > 0.3) {
            EXPECT_GT(sum, 0.99) << n1 << ' ' << n2 << ' ' << viewCosine << ' ' << roughness;
          } else if (viewCosine == 1) {
            EXPECT_GT(sum, 1 - std::log(2.0)) << n1 << ' ' << n2 << ' ' << roughness;
          }
        }
      }
    }
  }
}

TEST(FrostedGlass, OfAVanishingRoughnessIsSmoothGlass) {
  for (const auto& [n1, n2] : {std::array{1.0, 1.5}, {1.5, 1.0}}) {
    for (const double viewCosine : {0.78, 1.0}) {
      for (const double alpha : {0.0009, 0.0011, 0.003}) {
        const Surfel s = interfaceOf(alpha, n1, n2, viewCosine);
        const Interface interface = makeInterface(n1, n2, viewCosine);
        const Vec3d straight = refract(interface, -s.view, {0, 0, 1}, viewCosine);
        const bool isSmooth = alpha <= double{kSmoothAlpha};
        const double tolerance = isSmooth ? kRounding : 10 * alpha;  // the mean of GGX's long tails

        const Moments found = samplesOf(s, frostedImpulse);
        EXPECT_NEAR(found.all, 1 - interface.reflectance, tolerance);
        expectNear(normalized(found.direction), straight, tolerance);
        EXPECT_EQ(glossyRays(s, {8, 0, 0}), isSmooth ? 1 : 8);
      }
    }
  }

  // Equal indices bend nothing, however rough the surface is.
  const Surfel none = interfaceOf(0.5, 1.5, 1.5, 0.4);
  const Impulse ray = frostedImpulse(none, 0, {0.3f, 0.9f});
  EXPECT_EQ(ray.ray.direction, -none.view);
  EXPECT_EQ(ray.weight, RgbD(1.0));
  EXPECT_EQ(glossyRays(none, {8, 0, 0}), 1);
}

// A sheet transmits on one side what it would reflect on the other with a reflectance of 1, but for
// what it reflects. Nothing is lost: what a facet sends into the sheet leaves it at its far side.
TEST(FrostedGlass, SheetsGoStraightOnInTheMean) {
  for (const double alpha : {0.1, 0.4, 1.0}) {
    for (const double viewCosine : {0.3, 0.7, 1.0}) {
      const Surfel clear = sheetOf(alpha, 0, viewCosine), white = sheetOf(alpha, 1, viewCosine);
      EXPECT_NEAR(samplesOf(clear, frostedImpulse).all, 1, 1e-12);
      EXPECT_NEAR(samplesOf(white, frostedImpulse).all, 0, 1e-12);

      for (std::uint32_t k = 0; k < 256; ++k) {
        const UnitPoint point = lobePoint(4, {256, 0, 0}, k);
        const Vec3d through = frostedImpulse(clear, 0, point).ray.direction;
        const Impulse back = glossyImpulse(white, 0, point);
        EXPECT_LT(through.z, 0);

        if (back.weight.x == 0) continue;
        const Vec3d& r = back.ray.direction;
        expectNear(through, {r.x, r.y, -r.z});
      }

      // Of the reflected share, what facets mask is lost.
      const Surfel glass = sheetOf(alpha, 0.04, viewCosine);
      const double reflected = samplesOf(glass, glossyImpulse).all;
      const double both = reflected + samplesOf(glass, frostedImpulse).all;
      EXPECT_LE(both, 1);
      EXPECT_GE(both, 1 - reflected * (1 / samplesOf(white, glossyImpulse).all - 1) * 4);
    }
  }

  const Vec3d mean = samplesOf(sheetOf(0.1, 0, 0.7), frostedImpulse).direction;
  expectNear(normalized(mean), -directionAt(0.7, 0.3), 0.05);  // half of alpha

  const Surfel smooth = sheetOf(kSmoothAlpha, 0.04, 0.3);
  const Impulse ray = frostedImpulse(smooth, 0, {0.3f, 0.9f});
  EXPECT_EQ(ray.ray.direction, -smooth.view);
  EXPECT_NEAR(ray.weight.x, 1 - (0.04 + 0.96 * schlickTerm(0.3)), 1e-12);
}

TEST(FrostedGlass, StaysBelowTheSurfaceThatNormalsAreBentOf) {
  Numbers numbers(13);
  for (int i = 0; i < 2000; ++i) {
    Surfel s = interfaceOf(numbers.in(0.1, 1), 1, 1.5, numbers.in(0.05, 1));
    if (i % 2 == 0) s = sheetOf(s.alpha, 0.04, s.view.z);
    s.shadingNormal = bentNormal(numbers);
    const UnitPoint point = pointOf(numbers);

    const Impulse ray = frostedImpulse(s, 0, point);
    if (maxComponent(ray.weight) == 0) continue;
    EXPECT_LT(ray.ray.direction.z, 0);
    EXPECT_NEAR(length(ray.ray.direction), 1, 1e-12);
  }
}

Material frostedGlass(float roughness, bool isThin) {
  Material m = glassMaterial(1.5f);
  m.castsShadow = m.glossyReflection = false;
  m.frosted = true;
  m.thin = isThin;
  m.roughness = roughness;
  return m;
}

RgbD throughBlock(const Material& m, const Settings& settings, RayCounts& counts) {
  const Scene scene = sceneOf(box({-50, -2, -50}, {50, -1, 50}), m, 1);
  return radianceAlong(scene, {0, 1, 0}, steep(30), settings, &counts);
}

// The surface of a solid is seen before a black sky, and what is in the solid has a radiance of 1:
// the mean of the rays is the integral of the lobe, times the color of the glass.
TEST(FrostedGlass, ShowsWhatItsSurfaceTransmits) {
  for (const double degrees : {20.0, 60.0}) {
    Material m = frostedGlass(0.6f, false);
    m.transmission = {0.9f, 0.5f, 0.25f};
    SceneBuilder builder = withFloor(m, 1000);
    builder.add(floorAt(-1, 1000), emittingMaterial(1));

    const Vec3d down = steep(degrees);
    const RgbD seen = radianceAlong(builder.build(), -down, down, sampled(1024));
    const double alpha = double{m.roughness} * double{m.roughness};
    const double wanted = transmittedByQuadrature(alpha, 1, 1.5, directionAt(-down.y, 0)).all;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(seen[i], wanted * double{m.transmission[i]}, kOfLattice) << degrees << ' ' << i;
    }
  }
}

// N rays each of reflection and refraction leave the first surface, and one each those that follow.
TEST(FrostedGlass, OnlyTheFirstSurfaceSendsOutSeveralRays) {
  RayCounts counts;
  EXPECT_GT(throughBlock(frostedGlass(0.3f, false), sampled(16, 2), counts).x, 0.9);
  EXPECT_LE(counts[RayKind::reflection], 32u);
  EXPECT_LE(counts[RayKind::refraction], 32u);
  EXPECT_GT(counts[RayKind::refraction], 28u);

  RayCounts smooth;
  throughBlock(frostedGlass(0.03f, false), sampled(16, 2), smooth);
  EXPECT_EQ(smooth[RayKind::refraction], 2u);

  // A sheet that reflects nothing has no reflected rays; it is crossed twice.
  RayCounts thin;
  EXPECT_NEAR(throughBlock(frostedGlass(0.3f, true), sampled(16, 2), thin).x, 1, 1e-12);
  EXPECT_EQ(thin[RayKind::reflection], 0u);
  EXPECT_EQ(thin[RayKind::refraction], 32u);
}

TEST(FrostedGlass, IsClearWithoutSamplesOrWithoutTheEffect) {
  for (const bool isThin : {false, true}) {
    Material clear = frostedGlass(0.5f, isThin);
    clear.frosted = false;
    RayCounts counts, expected;
    for (const Settings& settings : {sampled(0), without(Effect::glossyReflection, sampled(8))}) {
      const RgbD seen = throughBlock(frostedGlass(0.5f, isThin), settings, counts);
      EXPECT_EQ(seen, throughBlock(clear, settings, expected));
      EXPECT_EQ(counts.all(), expected.all());
    }
  }
}

// What is not there of a sheet lets light straight through.
TEST(FrostedGlass, SheetsMayBeThereInPart) {
  Material m = frostedGlass(1, true);
  m.transmission = Rgb(0.5f);
  m.coverage = 0.25f;
  RayCounts counts;
  const double seen = radianceBelow(floorUnderSky(m), {0, 1, 0}, sampled(64), &counts).x;
  EXPECT_NEAR(seen, 0.75 + 0.25 * 0.5, 1e-12);
  EXPECT_EQ(counts[RayKind::refraction], 65u);
}

}  // namespace
}  // namespace whit::reference
