// Fresnel's and Snell's laws (hard cases H37 to H40).
#include "reference/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/lobe.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

double reflectance(double n1, double n2, double c) { return makeInterface(n1, n2, c).reflectance; }

double schlick(double n1, double n2, double c) {
  return makeInterface(n1, n2, c, FresnelModel::schlick).reflectance;
}

TEST(Fresnel, AgreesWithTheTextbookForm) {
  Numbers numbers(3);
  for (const double n2 : {1.33, 1.5, 2.42}) {
    for (int i = 0; i < 20000; ++i) {
      const double c = numbers.in(1e-3, 1);
      const auto truth = static_cast<double>(fresnelOf<long double>(1, n2, c));
      EXPECT_NEAR(reflectance(1, n2, c), truth, 1e-13 * truth) << n2 << " at " << c;
    }
  }
}

// The reflectance is the same from either side along the same path.
TEST(Fresnel, IsReciprocal) {
  Numbers numbers(4);
  for (int i = 0; i < 10000; ++i) {
    const double eta = numbers.in(1.01, 3), c = numbers.in(1e-3, 1);
    const Interface there = makeInterface(1, eta, c);
    EXPECT_NEAR(reflectance(eta, 1, there.g / eta), there.reflectance, 1e-9);
  }
}

// Hard case H38: equal indices neither reflect nor refract.
TEST(Fresnel, EqualIndicesDoNothing) {
  const Vec3d n{0, 1, 0};
  for (const double c : {0.0, 1e-300, 1e-9, 1e-4, 0.5, 1.0}) {
    const Interface none = makeInterface(1.33, 1.33, c);
    EXPECT_EQ(none.reflectance, 0) << c;
    const Vec3d d{std::sqrt(1 - c * c), -c, 0};
    EXPECT_EQ(refract(none, d, n, c), d);
  }
}

// The same for n1 = 1 without differences of nearly equal numbers: with n the index and m the
// cosine behind the surface, c - n m = (1 - n^2) / (c + n m), and
// n c - m = (n^2 - 1) ((n^2 + 1) c^2 - 1) / (n^2 (n c + m)).
long double oracleOfNearlyEqual(long double delta, long double c) {
  const long double n = 1 + delta, square = delta * (2 + delta);  // n^2 - 1
  const long double m = std::sqrt(c * c + square) / n;
  const long double s = square / ((c + n * m) * (c + n * m));
  const long double p = square * ((n * n + 1) * c * c - 1) / (n * n * (n * c + m) * (n * c + m));
  return (s * s + p * p) / 2;
}

// Hard case H39: nearly equal indices keep a relative accuracy of 1e-12.
TEST(Fresnel, NearlyEqualIndices) {
  for (const double nearly : {0.1, 1e-4, 1e-5, 1e-7, 1e-12}) {
    const double n2 = 1 + nearly, delta = n2 - 1;  // without rounding
    for (const double c : {0.01, 0.3, 1.0}) {
      const auto truth = static_cast<double>(oracleOfNearlyEqual(delta, c));
      EXPECT_NEAR(reflectance(1, n2, c), truth, 1e-12 * truth) << delta << " at " << c;
    }
  }
  EXPECT_NEAR(static_cast<double>(oracleOfNearlyEqual(0.5, 0.3)),
              static_cast<double>(fresnelOf<long double>(1, 1.5, 0.3L)), 1e-15);
}

TEST(Fresnel, ExactlyCriticalIsTotal) {
  // The triangle of sides 3, 4 and 5: n1 = 5, n2 = 3 gives k = -16/25 and, at c = 4/5, g2 = 0 but
  // for rounding.
  EXPECT_NEAR(reflectance(5, 3, std::sqrt(16.0 / 25)), 1, 1e-7);
  EXPECT_EQ(reflectance(1, 1.5, 0), 1);
  EXPECT_EQ(reflectance(1.5, 1, 0), 1);
}

TEST(Refraction, ObeysSnell) {
  Numbers numbers(5);
  for (int i = 0; i < 10000; ++i) {
    const double n1 = numbers.in(1, 2.5), n2 = numbers.in(1, 2.5);
    const Vec3d n = numbers.direction();
    Vec3d d = numbers.direction();
    if (dot(d, n) > 0) d = -d;

    const double c = -dot(d, n);
    const Interface interface = makeInterface(n1, n2, c);
    if (interface.reflectance == 1) {
      EXPECT_GE(n1 / n2 * std::sqrt(1 - c * c), 1 - 1e-12);
      continue;
    }

    const Vec3d t = refract(interface, d, n, c);
    EXPECT_NEAR(length(t), 1, 1e-14);
    EXPECT_LT(dot(t, n), 0);
    // n sin is kept, as a vector along the surface.
    expectNear(cross(n, t) * n2, cross(n, d) * n1, 1e-13);
  }
}

TEST(Reflection, TurnsOverTheNormalPart) {
  Numbers numbers(6);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d n = numbers.direction(), d = numbers.direction(), r = reflect(d, n);
    EXPECT_NEAR(dot(r, n), -dot(d, n), 1e-14);
    expectNear(cross(n, r), cross(n, d), 1e-14);
  }
}

// Hard case H52: many reflections keep the length.
TEST(Reflection, KeepsUnitLength) {
  Numbers numbers(7);
  Vec3d d = numbers.direction();
  for (int i = 0; i < 64; ++i) d = reflect(d, numbers.direction());
  EXPECT_NEAR(length(d), 1, 4e-16);
}

// Values of Schlick's polynomial at normal incidence, at an angle worked out by hand, and beyond
// the critical angle.
TEST(Schlick, H40_knownValues) {
  EXPECT_NEAR(schlick(1, 1.5, 1), 0.04, 1e-15);
  EXPECT_NEAR(schlick(1, 1.5, 0.5), 0.04 + 0.96 / 32, 1e-15);
  // The ray leaves the dense side at a cosine whose refracted ray has the cosine 1/2, which gives
  // the same value.
  const double inside = std::sqrt(1 - 0.75 / 2.25);
  EXPECT_NEAR(schlick(1.5, 1, inside), 0.04 + 0.96 / 32, 1e-12);

  const double critical = std::sqrt(1 - 1 / 2.25);
  EXPECT_NEAR(schlick(1.5, 1, critical + 1e-9), 1, 1e-3);
  EXPECT_EQ(schlick(1.5, 1, critical - 1e-9), 1);
  EXPECT_EQ(schlick(1, 1.5, 0), 1);
  for (const double c : {0.0, 0.3, 1.0}) EXPECT_EQ(schlick(1.33, 1.33, c), 0);
}

// Schlick's polynomial is off by at most 0.04 for glass, from either side.
TEST(Schlick, StaysNearFresnel) {
  for (int i = 1; i <= 1000; ++i) {
    const double c = i / 1000.0;
    EXPECT_NEAR(schlick(1, 1.5, c), reflectance(1, 1.5, c), 0.04) << c;
    EXPECT_NEAR(schlick(1.5, 1, c), reflectance(1.5, 1, c), 0.04) << c;
  }
}

}  // namespace
}  // namespace whit::reference
