// Frosted glass: its samples against integrals of Walter's lobes (Walter et al. 2007, "Microfacet
// models for refraction through rough surfaces"), energy, reciprocity, the limits of smooth glass,
// and how many rays there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/add_impulses.h"
#include "reference/fresnel.h"
#include "reference/lobe.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

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

// Fresnel's reflectance by Snell's law and the two amplitudes.
double fresnelOf(double n1, double n2, double c) {
  const double sine = n1 / n2 * std::sqrt(1 - c * c);
  if (sine >= 1) return 1;
  const double behind = std::sqrt(1 - sine * sine);
  const double s = (n1 * c - n2 * behind) / (n1 * c + n2 * behind);
  const double p = (n1 * behind - n2 * c) / (n1 * behind + n2 * c);
  return (s * s + p * p) / 2;
}

// Equation 21 of the paper, in its terms: i and o are the directions of light, m the facet's
// normal, and n1 is the index on the side of i. Zero where no facet refracts i to o.
double btdf(double alpha, double n1, double n2, const Vec3d& i, const Vec3d& o) {
  Vec3d m = normalized(i * -n1 - o * n2);
  if (m.z < 0) m = -m;
  const double im = dot(i, m), om = dot(o, m);
  if (!(im > 0) || !(om < 0) || !(i.z > 0) || !(o.z < 0)) return 0;
  const double g = smithG1(alpha, i.z) * smithG1(alpha, -o.z), root = n1 * im + n2 * om;
  return im * -om / (i.z * -o.z) * n2 * n2 * (1 - fresnelOf(n1, n2, im)) * g *
         facetsOf(alpha, m.z) / (root * root);
}

// The density of frosted directions: of visible normals, times the Jacobian of equation 17.
double densityOf(double alpha, double n1, double n2, const Vec3d& i, const Vec3d& o) {
  Vec3d m = normalized(i * -n1 - o * n2);
  if (m.z < 0) m = -m;
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
        EXPECT_LT(length(found.direction - wanted.direction), kOfLattice)
            << n1 << ' ' << n2 << ' ' << alpha << ' ' << viewCosine;
      }
    }
  }
}

// weight = lobe * cosine / density, sample by sample.
TEST(FrostedGlass, SamplesWeighWhatTheLobeSaysOverTheirDensity) {
  test::Numbers numbers(11);
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

// The point of the unit square at which a facet is drawn (visibleNormal() backwards).
UnitPoint pointOfFacet(const Surfel& s, const Vec3d& facet) {
  const double a = s.alpha;
  const Vec3d x = normalized(Vec3d(s.view.x, s.view.y, 0)), y{-x.y, x.x, 0};
  const Vec3d seen = normalized(Vec3d(dot(s.view, x) * a, 0, s.view.z));
  const Vec3d h = normalized(Vec3d(dot(facet, x) / a, dot(facet, y) / a, facet.z));

  const Vec3d cap = h * (2 * dot(seen, h)) - seen;
  const double turn = std::atan2(cap.y, cap.x) / (2 * kPi);
  return {static_cast<float>(turn - std::floor(turn)),
          static_cast<float>(1 - (cap.z + seen.z) / (1 + seen.z))};
}

// f(i, o) / n2^2 = f(o, i) / n1^2, both from the weights of samples.
TEST(FrostedGlass, IsReciprocalUpToTheSquareOfTheIndices) {
  test::Numbers numbers(12);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const double n1 = numbers.in(1, 1.3), n2 = numbers.in(1.4, 2.5), alpha = numbers.in(0.1, 1);
    const Surfel s = interfaceOf(alpha, n1, n2, numbers.in(0.1, 1));
    const UnitPoint point = pointOf(numbers);
    const Impulse there = frostedImpulse(s, 0, point);
    const Vec3d o = there.ray.direction;
    // Along the normal the frame of the facets is any.
    if (there.weight.x == 0 || o.z > -0.1 || o.z < -0.999) continue;

    // The same pair seen from behind: everything is turned upside down.
    Surfel behind = interfaceOf(alpha, n2, n1, 1);
    behind.view = {o.x, o.y, -o.z};
    const Vec3d back{s.view.x, s.view.y, -s.view.z};
    Vec3d facet = normalized(behind.view * -n2 - back * n1);
    if (facet.z < 0) facet = -facet;
    const Impulse again = frostedImpulse(behind, 0, pointOfFacet(behind, facet));
    // 1e-4: the point is one of floats.
    ASSERT_LT(length(again.ray.direction - back), 1e-4);

    const double forwards = there.weight.x * densityOf(alpha, n1, n2, s.view, o) / (-o.z * n2 * n2);
    const double backwards =
        again.weight.x * densityOf(alpha, n2, n1, behind.view, back) / (-back.z * n1 * n1);
    EXPECT_NEAR(forwards, backwards, 1e-3 * forwards) << alpha << ' ' << n1 << ' ' << n2;
    ++compared;
  }
  EXPECT_GT(compared, 1000);
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
            const double both =
                glossyImpulse(s, 0, point).weight.x + frostedImpulse(s, 0, point).weight.x;
            largest = std::max(largest, both);
            sum += both / 1024;
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

// Beyond the critical angle of all facets.
TEST(FrostedGlass, ReflectsTotally) {
  const Surfel s = interfaceOf(0.0025, 1.5, 1, 0.5);
  EXPECT_GT(samplesOf(s, glossyImpulse).all, 0.99);
  EXPECT_LT(samplesOf(s, frostedImpulse).all, 1e-3);

  Surfel smooth = s;
  smooth.alpha = 0;
  EXPECT_EQ(frostedImpulse(smooth, 0, {0.3f, 0.4f}).weight, RgbD());
  EXPECT_EQ(glossyImpulse(smooth, 0, {0.3f, 0.4f}).weight, RgbD(1.0));
}

TEST(FrostedGlass, OfAVanishingRoughnessIsSmoothGlass) {
  for (const auto& [n1, n2] : {std::array{1.0, 1.5}, {1.5, 1.0}}) {
    for (const double viewCosine : {0.78, 1.0}) {
      for (const double alpha : {0.0009, 0.0011, 0.003}) {
        const Surfel s = interfaceOf(alpha, n1, n2, viewCosine);
        const Interface interface = makeInterface(n1, n2, viewCosine);
        const Vec3d straight = refract(interface, -s.view, {0, 0, 1}, viewCosine);
        const bool isSmooth = alpha <= double{kSmoothAlpha};

        const Moments found = samplesOf(s, frostedImpulse);
        EXPECT_NEAR(found.all, 1 - interface.reflectance, isSmooth ? 1e-12 : 10 * alpha);
        // The mean of GGX's long tails.
        EXPECT_LT(length(normalized(found.direction) - straight), isSmooth ? 1e-12 : 10 * alpha);
        EXPECT_EQ(glossyRays(s, {8, 0, 0}), isSmooth ? 1 : 8);
      }
    }
  }

  // Equal indices bend nothing, however rough the surface is.
  const Surfel none = interfaceOf(0.5, 1.5, 1.5, 0.4);
  EXPECT_EQ(frostedImpulse(none, 0, {0.3f, 0.9f}).ray.direction, -none.view);
  EXPECT_EQ(frostedImpulse(none, 0, {0.3f, 0.9f}).weight, RgbD(1.0));
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
        EXPECT_LT(length(through - Vec3d(r.x, r.y, -r.z)), 1e-12);
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
  EXPECT_LT(length(normalized(mean) + directionAt(0.7, 0.3)), 0.05);  // half of alpha

  const Surfel smooth = sheetOf(kSmoothAlpha, 0.04, 0.3);
  const Impulse ray = frostedImpulse(smooth, 0, {0.3f, 0.9f});
  EXPECT_EQ(ray.ray.direction, -smooth.view);
  EXPECT_NEAR(ray.weight.x, 1 - (0.04 + 0.96 * schlickTerm(0.3)), 1e-12);
}

TEST(FrostedGlass, StaysBelowTheSurfaceThatNormalsAreBentOf) {
  test::Numbers numbers(13);
  for (int i = 0; i < 2000; ++i) {
    Surfel s = interfaceOf(numbers.in(0.1, 1), 1, 1.5, numbers.in(0.05, 1));
    if (i % 2 == 0) s = sheetOf(s.alpha, 0.04, s.view.z);
    s.shadingNormal = normalized(Vec3d(numbers.in(-1, 1), numbers.in(-1, 1), 1));
    const UnitPoint point = pointOf(numbers);

    const Impulse ray = frostedImpulse(s, 0, point);
    if (maxComponent(ray.weight) == 0) continue;
    EXPECT_LT(ray.ray.direction.z, 0);
    EXPECT_NEAR(length(ray.ray.direction), 1, 1e-12);
  }
}

Material frostedGlass(float roughness, bool isThin) {
  Material m = test::blackMaterial();
  m.transmission = Rgb(1.0f);
  m.castsShadow = m.glossyReflection = false;
  m.frosted = true;
  m.thin = isThin;
  m.roughness = roughness;
  return m;
}

Settings sampledBy(int glossy, int depth = 8) {
  Settings settings = test::uncut(depth);
  settings.options.glossy = glossy;
  return settings;
}

RgbD throughBlock(const Material& m, const Settings& settings, RayCounts& counts) {
  test::SceneBuilder builder;
  builder.add(test::box({-50, -2, -50}, {50, -1, 50}, builder.add(m)));
  builder.sky(1);
  return test::radianceAlong(builder.build(), {0, 1, 0}, test::steep(30), settings, &counts);
}

// The surface of a solid is seen before a black sky, and what is in the solid has a radiance of 1:
// the mean of the rays is the integral of the lobe, times the color of the glass.
TEST(FrostedGlass, ShowsWhatItsSurfaceTransmits) {
  for (const double degrees : {20.0, 60.0}) {
    Material m = frostedGlass(0.6f, false);
    m.transmission = {1, 0.5f, 0.25f};
    m.ior = 1.5f;
    test::SceneBuilder builder;
    builder.add(test::floorAt(0, 1000, builder.add(m)));
    builder.add(test::floorAt(-1, 1000, builder.add(test::emittingMaterial(1))));

    const Vec3d down = test::steep(degrees);
    const RgbD seen = test::radianceAlong(builder.build(), -down, down, sampledBy(1024));
    const double alpha = double{m.roughness} * double{m.roughness};
    const double wanted =
        transmittedByQuadrature(alpha, 1, double{m.ior}, directionAt(-down.y, 0)).all;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(seen[i], wanted * double{m.transmission[i]}, kOfLattice) << degrees << ' ' << i;
    }
  }
}

// N rays each of reflection and refraction leave the first surface, and one each those that follow.
TEST(FrostedGlass, OnlyTheFirstSurfaceSendsOutSeveralRays) {
  RayCounts counts;
  EXPECT_GT(throughBlock(frostedGlass(0.3f, false), sampledBy(16, 2), counts).x, 0.9);
  EXPECT_LE(counts[RayKind::reflection], 16u + 16u);
  EXPECT_LE(counts[RayKind::refraction], 16u + 16u);
  EXPECT_GT(counts[RayKind::refraction], 28u);

  RayCounts smooth;
  throughBlock(frostedGlass(0.03f, false), sampledBy(16, 2), smooth);
  EXPECT_EQ(smooth[RayKind::refraction], 2u);

  // A sheet that reflects nothing has no reflected rays; it is crossed twice.
  RayCounts thin;
  EXPECT_NEAR(throughBlock(frostedGlass(0.3f, true), sampledBy(16, 2), thin).x, 1, 1e-12);
  EXPECT_EQ(thin[RayKind::reflection], 0u);
  EXPECT_EQ(thin[RayKind::refraction], 32u);
}

TEST(FrostedGlass, IsClearWithoutSamplesOrWithoutTheEffect) {
  for (const bool isThin : {false, true}) {
    Material clear = frostedGlass(0.5f, isThin);
    clear.frosted = false;
    Settings disabled = sampledBy(8);
    disabled.effects = disabled.effects.without(Effect::glossyReflection);

    RayCounts counts, expected;
    for (const Settings& settings : {sampledBy(0), disabled}) {
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
  test::SceneBuilder builder;
  builder.add(test::floorAt(0, 50, builder.add(m)));
  builder.sky(1);
  const Scene scene = builder.build();

  RayCounts counts;
  const double seen =
      test::radianceAlong(scene, {0, 1, 0}, test::steep(0), sampledBy(64), &counts).x;
  EXPECT_NEAR(seen, 0.75 + 0.25 * 0.5, 1e-12);
  EXPECT_EQ(counts[RayKind::refraction], 65u);
}

}  // namespace
}  // namespace whit::reference
