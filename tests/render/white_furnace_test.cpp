// A white furnace: bodies in uniform light of radiance 1, of materials of all kinds. Each surface
// sends out at most what it gets, so nothing looks brighter than 1, and nothing darker where
// nothing absorbs.
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/add_impulses.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// Roundings of floats along a path. It is no statistical tolerance: what the lobe
// takes from the others is the weight of the very samples that it gives.
constexpr float kRoundingsOfAPath = 1e-4f;

constexpr int kBallsAcross = 25, kBallsDown = 20, kPixelsASide = 3;

// A ball of each material in a grid of them, seen in parallel from afar. Each is farther away than
// the one before, so that they hardly reflect one another.
Scene balls(const std::vector<Material>& materials) {
  SceneBuilder builder;
  builder.sky(1);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto column = static_cast<double>(i % kBallsAcross),
               row = static_cast<double>(i / kBallsAcross);
    Mesh ball;
    const Vec3d center{column - (kBallsAcross - 1) / 2.0, row - (kBallsDown - 1) / 2.0,
                       -8 * static_cast<double>(i)};
    ball.spheres = {Affine::translation(center) * Affine::scaling(Vec3d(0.49))};
    ball.materials = {builder.add(materials[i])};
    builder.add(std::move(ball));
  }
  Camera camera;
  camera.eye = {0, 0, 50};
  camera.at = {0, 0, 0};
  camera.orthographicHeight = kBallsDown;
  builder.description.cameras = {camera};
  return builder.build();
}

RenderOptions furnace() {
  RenderOptions o = smallOptions();
  o.size = ImageSize{kBallsAcross * kPixelsASide, kBallsDown * kPixelsASide};
  o.depth = 4;
  o.cutoff = 0;
  o.glossy = 3;
  o.indirect = 1;
  return o;
}

// The least and the largest channel of the picture.
std::pair<float, float> rangeOf(const Scene& scene, const RenderOptions& o, bool packets) {
  Renderer renderer(scene, o);
  Film film = makeFilm(scene, o);
  if (packets) {
    renderer.render(chooseCamera(scene, o), film);
  } else {
    renderer.renderReference(chooseCamera(scene, o), film);
  }
  float least = 2, largest = 0;
  for (const Rgb& pixel : film.image.pixels) {
    least = std::min({least, pixel.x, pixel.y, pixel.z});
    largest = std::max(largest, maxComponent(pixel));
  }
  return {least, largest};
}

Rgb color(Numbers& numbers) {
  const auto channel = [&] { return static_cast<float>(numbers.in(0, 1)); };
  const float r = channel(), g = channel(), b = channel();
  return {r, g, b};
}

TEST(WhiteFurnace, NoneOf500RandomMaterialsIsBrighterThanTheRoom) {
  Numbers numbers(500);
  std::vector<Material> materials;
  for (int i = 0; i < kBallsAcross * kBallsDown; ++i) {
    const auto chance = [&](double share) { return numbers.in(0, 1) < share; };
    Material m = diffuseMaterial(1);
    if (chance(0.5)) m.diffuse = color(numbers);
    m.specular = chance(0.5) ? Rgb(static_cast<float>(numbers.in(0, 0.1))) : color(numbers);
    m.roughness = static_cast<float>(numbers.in(0, 1));
    if (chance(0.5)) m.mirror = color(numbers);
    if (chance(0.5)) m.mirrorGrazing = color(numbers);
    if (chance(0.4)) m.transmission = chance(0.5) ? Rgb(1.0f) : color(numbers);
    m.thin = chance(0.3);
    m.ior = static_cast<float>(numbers.in(1, 2.5));
    if (chance(0.3)) m.coverage = static_cast<float>(numbers.in(0, 1));
    materials.push_back(m);
  }
  const Scene scene = balls(materials);
  for (const bool packets : {false, true}) {
    EXPECT_LE(rangeOf(scene, furnace(), packets).second, 1 + kRoundingsOfAPath) << packets;
  }
}

// White throughout, with any lobe and any coat.
TEST(WhiteFurnace, WhatDoesNotAbsorbVanishes) {
  Numbers numbers(1);
  std::vector<Material> materials;
  for (int i = 0; i < kBallsAcross * kBallsDown; ++i) {
    Material m = diffuseMaterial(1);
    m.specular = i % 2 == 0 ? Rgb(0.04f) : color(numbers);
    m.roughness = static_cast<float>(numbers.in(0, 1));
    if (i % 3 == 0) m.mirror = color(numbers);
    if (i % 3 != 1) m.mirrorGrazing = i % 3 == 0 ? color(numbers) : Rgb(1.0f);
    materials.push_back(m);
  }
  const Scene scene = balls(materials);
  for (const bool packets : {false, true}) {
    const auto [least, largest] = rangeOf(scene, furnace(), packets);
    EXPECT_LE(largest, 1 + kRoundingsOfAPath) << packets;
    EXPECT_GE(least, 1 - kRoundingsOfAPath) << packets;
  }
}

// A lobe that no ray samples shows lights only: the diffuse color is as without it.
TEST(WhiteFurnace, LobesThatAreNotSampledTakeNothing) {
  Material m = diffuseMaterial(0.9f);
  Material plastic = m;
  plastic.specular = Rgb(0.3f);
  RenderOptions o = furnace();
  o.glossy = 0;
  for (const bool packets : {false, true}) {
    EXPECT_EQ(rangeOf(balls({plastic}), o, packets), rangeOf(balls({m}), o, packets));
  }
}

// The mean of what the samples leave is 1 less the lobe's albedo, here by the midpoint rule over
// the half vectors of the formulas: Walter et al. 2007 for the facets, Heitz 2014 for the masking.
TEST(WhiteFurnace, DiffuseColorsGetWhatTheLobesAlbedoLeaves) {
  for (const double roughness : {0.3, 0.6, 1.0}) {
    for (const double nv : {0.15, 0.5, 0.95}) {
      constexpr int kSteps = 400;
      const double a2 = std::pow(roughness, 4), sine = std::sqrt(1 - nv * nv);
      double albedo = 0;
      for (int i = 0; i < kSteps; ++i) {
        for (int k = 0; k < kSteps; ++k) {
          const double nl = (i + 0.5) / kSteps, turn = 2 * kPi * (k + 0.5) / kSteps;
          const double across = std::sqrt(1 - nl * nl);
          const double x = sine + across * std::cos(turn), y = across * std::sin(turn), z = nv + nl;
          const double size = std::sqrt(x * x + y * y + z * z), nh = z / size;
          const double vh = (sine * x + nv * z) / size, spread = nh * nh * (a2 - 1) + 1;
          const auto lambda = [&](double c) {
            return (std::sqrt(1 + a2 * (1 / (c * c) - 1)) - 1) / 2;
          };
          const double lobe = a2 / (kPi * spread * spread) / (1 + lambda(nl) + lambda(nv)) /
                              (4 * nl * nv) * (0.04 + 0.96 * std::pow(1 - vh, 5));
          albedo += lobe * nl * 2 * kPi / (kSteps * kSteps);
        }
      }
      SceneBuilder builder;
      Material plastic = diffuseMaterial(1);
      plastic.specular = Rgb(0.04f);
      builder.add(floorAt(0, 1, builder.add(plastic)));
      const Scene scene = builder.build();
      reference::Surfel s;
      s.geometricNormal = s.shadingNormal = {0, 0, 1};
      s.view = {sine, 0, nv};
      s.alpha = roughness * roughness;
      s.specular = RgbD(double{plastic.specular.x});
      s.diffuse = RgbD(1.0);
      const EffectSet effects = EffectSet().with(Effect::glossyReflection);
      reference::limitDiffuse(scene, effects, {}, {}, {1, {4096, 0, 0}}, s);
      // 2e-3: what 4096 points of a lattice and the midpoint rule leave.
      EXPECT_NEAR(s.diffuse.x, 1 - albedo, 2e-3) << roughness << ' ' << nv;
    }
  }
}

}  // namespace
}  // namespace whit::test
