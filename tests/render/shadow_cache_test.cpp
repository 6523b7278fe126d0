// The shadow cache (shadow_cache/shadow_tables.h) says what the rays would have found: every ray
// that it decides is traced as well (--shadow-cache audit), and pictures keep their bits.
#include "shadow_cache/shadow_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "bake/edit_scene.h"
#include "core/error.h"
#include "render/caster_reference.h"
#include "render/random_scenes.h"
#include "render/renderer.h"
#include "render/shipped_scene.h"
#include "sanitized.h"
#include "simd/kernels.h"
#include "verify/scene_builder.h"

namespace whit::test {
namespace {

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 30;

// Two frames with the tables filled in between, of which the second is returned.
Picture renderWarm(const Scene& scene, const RenderOptions& options) {
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);
  renderer.expectFrames(kPlenty);
  renderer.render(camera, film);
  renderer.fillShadowCache();
  Picture picture;
  picture.stats = renderer.render(camera, film);
  picture.image = film.image;
  return picture;
}

std::uint64_t decided(const FrameStats& stats) {
  return stats.meter.shadows.lit + stats.meter.shadows.dark;
}
double decidedShare(const FrameStats& stats) {
  const auto all = static_cast<double>(decided(stats) + stats.of(RayKind::shadow).rays);
  return all > 0 ? static_cast<double>(decided(stats)) / all : 0;
}

// Fails unless every decided ray is right and the bits are those without the cache. Returns the
// share of rays that were decided.
double expectRight(const Scene& scene, RenderOptions options) {
  options.shadowCache = ShadowCacheMode::off;
  const Picture plain = render(scene, options);
  options.shadowCache = ShadowCacheMode::audit;
  const Picture warm = renderWarm(scene, options);
  EXPECT_EQ(firstDifference(plain.image, warm.image), "");
  EXPECT_EQ(plain.stats.of(RayKind::shadow).rays,
            decided(warm.stats) + warm.stats.of(RayKind::shadow).rays);
  return decidedShare(warm.stats);
}

// ---- shipped scenes

class ShippedShadowCache : public testing::TestWithParam<std::string> {};

TEST_P(ShippedShadowCache, AreRight) {
  RenderOptions options = smallOptions();
  if (kSanitized) options.depth = 3;  // depths beyond are more of the same rays
  expectRight(load(GetParam()), options);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedShadowCache,
                         testing::Values("whitted", "glass", "mirrors", "matte", "effects",
                                         "glossy", "landscape?triangles=20000", "atrium"),
                         [](const auto& of) { return of.param.substr(0, of.param.find('?')); });

TEST(ShadowCache, DecideMostRaysOfPlainScenes) {
  EXPECT_GT(expectRight(load("matte"), smallOptions()), 0.9);
}

TEST(ShadowCache, KeepTheBitsOnEveryTargetAndWidth) {
  const Scene& scene = load("matte");
  RenderOptions options = smallOptions();
  options.size = ImageSize{53, 37};
  for (const std::string& target : simd::availableTargets()) {
    options.simd = target;
    const Picture plain = render(scene, options);
    const Picture warm = renderWarm(scene, options);
    EXPECT_EQ(firstDifference(plain.image, warm.image), "") << target;
    EXPECT_GT(decidedShare(warm.stats), 0.8) << target;
  }
  options.simd = "auto";
  for (const int packet : {1, 4, 8, 16}) {
    options.packet = packet;
    const Picture plain = render(scene, options);
    EXPECT_EQ(firstDifference(plain.image, renderWarm(scene, options).image), "") << packet;
  }
  simd::chooseTarget("auto");
}

// ---- hard cases: triangles of the worst kinds

RenderOptions soupOptions() {
  RenderOptions options;
  options.size = ImageSize{96, 72};
  options.threads = 2;
  return options;
}

// Under sanitizers one random scene takes as long as many do without.
constexpr unsigned kSeeds = kSanitized ? 4 : 12, kEffectSeeds = kSanitized ? 2 : 8,
                   kInstanceSeeds = kSanitized ? 3 : 14;

TEST(ShadowCache, H84_lightInAPlaneOrAtAnEdge) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    Soup soup(seed);
    soup.addFloor(0, 3);
    // A wall in whose plane the light lies, and one with an edge that goes through it.
    soup.addSquare({0.5f, 0, -2}, {0, 2, 0}, {0, 0, 3});
    soup.addSquare({-2, 1.25f, 0.25f}, {2.5f, 0, 0}, {0, 1, 0});
    for (int i = 0; i < 20; ++i) {
      const Vec3f p = soup.inside(1.5f);
      soup.add({0.5f, std::fabs(p.x) + 0.1f, p.y}, {0.5f, std::fabs(p.y) + 0.1f, p.z},
               p + Vec3f{0, 1.6f, 0});
    }
    soup.light({0.5f, 1.25f, 0.25f});
    soup.light({0.5f, 2.5f, soup.uniform(-1, 1)});
    soup.light({0, 1, 0}, true);
    soup.light({1, 0.5f, 0}, true);
    expectRight(soup.finish({3, 3, 4}, {0, 0.5f, 0}), soupOptions());
  }
}

TEST(ShadowCache, H85_touchingAndInterpenetratingTriangles) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    Soup soup(seed);
    soup.addFloor(0, 3);
    for (int i = 0; i < 60; ++i) {
      // On the floor with a corner, an edge, all of it; through it; through each other.
      Vec3f a = soup.inside(2), b = a + soup.inside(0.7f), c = a + soup.inside(0.7f);
      if (i % 5 < 1) a.y = 0;
      if (i % 5 < 2) a.y = b.y = 0;
      if (i % 5 == 2) a.y = b.y = c.y = 0;
      if (i % 5 == 3) c = a + Vec3f{0, 0x1p-20f, 0.5f};
      soup.add(a, b, c);
    }
    soup.light({0.3f, 3, 0.2f});
    soup.light({soup.uniform(-2, 2), 0.1f, soup.uniform(-2, 2)});
    EXPECT_GT(expectRight(soup.finish({2, 4, 3}, {0, 0, 0}), soupOptions()), 0.2) << seed;
  }
}

TEST(ShadowCache, H86_slivers) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    Soup soup(seed);
    soup.addFloor(0, 3);
    for (int i = 0; i < 80; ++i) {
      const Vec3f a = soup.inside(2) + Vec3f{0, 2.2f, 0}, along = soup.inside(1.5f);
      const float thin = std::exp2(soup.uniform(-22, -3));
      soup.add(a, a + along, a + along * soup.uniform(0, 1) + soup.inside(thin));
    }
    soup.light({0.3f, 5, 0.2f});
    soup.light({2, 1, soup.uniform(-2, 2)});
    soup.light(soup.inside(1) + Vec3f{0, 1.5f, 0}, true);
    expectRight(soup.finish({2, 4, 3}, {0, 0.5f, 0}), soupOptions());
  }
}

// Far from the origin coordinates are coarse; a caster may be a thousand units away, or the light
// inside of a mesh.
TEST(ShadowCache, H87_farReceiversFarCastersAndLightsInside) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    Soup soup(seed);
    soup.addFloor(0, 3);
    for (int i = 0; i < 24; ++i) {
      const Vec3f a = soup.inside(2) + Vec3f{0, 1, 0};
      soup.add(a, a + soup.inside(0.8f), a + soup.inside(0.8f));
    }
    soup.addSquare({300, 1000, 300}, {-800, 0, soup.uniform(-9, 9)},
                   {0, soup.uniform(-9, 9), -320});
    // A lantern with open sides about the last light.
    soup.addSquare({-0.2f, 2.4f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f});
    soup.addSquare({-0.2f, 2.0f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f});
    soup.addSquare({-0.2f, 2.0f, -0.2f}, {0.4f, 0, 0}, {0, 0.4f, 0});
    soup.light({100, 1500, 80});
    soup.light({0, 2.2f, 0});
    const Vec3f moved = seed % 3 == 0 ? Vec3f{} : Vec3f{4096, -1000.3f, 70000};
    const float scale = seed % 2 == 0 ? 1 : 0x1p-9f;
    expectRight(soup.finish({3, 2, 4}, {0, 0.5f, 0}, seed % 2 == 0 ? moved : Vec3f{}, scale),
                soupOptions());
  }
}

TEST(ShadowCache, H88_randomScenesOfTenKinds) {
  RenderOptions options = soupOptions();
  options.size = ImageSize{32, 24};
  for (unsigned kind = 0; kind < 10; ++kind) {
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      SCOPED_TRACE(testing::Message() << "kind " << kind << ", seed " << seed);
      expectRight(randomScene(kind, seed), options);
    }
  }
}

TEST(ShadowCache, H91_randomScenesWithEffects) {
  const std::vector<std::string> targets = simd::availableTargets();
  RenderOptions options = soupOptions();
  double decidedShares = 0;
  for (unsigned kind = 0; kind < kEffectKinds; ++kind) {
    // Errors in the space of an instance show in few scenes, and along the borders of shadows.
    options.size = kind == kInstances ? ImageSize{161, 121} : ImageSize{64, 48};
    for (unsigned seed = 0; seed < (kind == kInstances ? kInstanceSeeds : kEffectSeeds); ++seed) {
      SCOPED_TRACE(testing::Message() << "kind " << kind << ", seed " << seed);
      options.simd = targets[seed % targets.size()];
      options.lightSamples = seed % 4 == 1 ? 3 : 1;
      // Embree tests the needles of a leaf for all rays of a packet, so what it finds far beside
      // them depends on the rays that are left to it.
      options.packet = kind == kNeedlesBesideOthers ? 1 : 0;
      decidedShares += expectRight(randomSceneWithEffects(kind, seed), options);
    }
  }
  EXPECT_GT(decidedShares, kEffectSeeds);
  simd::chooseTarget("auto");
}

// A floor and a needle, almost edge-on to their light. Embree tests a triangle for every ray that
// meets the box of its leaf, which here is the whole scene's. Rounding lets it find the first
// needle by rays that pass 4 units beside it, and the second one by rays that start on it.
TEST(ShadowCache, H89_needlesInScenesOfThreeTriangles) {
  struct Case {
    float floor;
    std::array<Vec3f, 3> needle;
    Vec3f light, eye;
  };
  const Case cases[] = {{14.028239f,
                         {Vec3f{-5.37400494f, 7.47210031f, 6.03172519f},
                          {-3.61076613f, 5.3170083f, -0.208840215f},
                          {-4.0588264f, 5.86460821f, 1.37681513f}},
                         {-2.4535348947f, 3.9025999089f, -4.3045855774f},
                         {12.625415f, 18.236711f, 15.431063f}},
                        {9.68172845f,
                         {Vec3f{-1.90015353f, 5.71769683f, -4.11312747f},
                          {0.80964481f, 4.72943939f, 4.59507258f},
                          {-0.792609496f, 5.32087824f, -0.528518661f}},
                         {1.56804267f, 4.45285337f, 7.03225773f},
                         {8.71355561f, 12.586247f, 10.6499013f}}};
  RenderOptions options = soupOptions();
  options.size = ImageSize{161, 121};
  for (const Case& c : cases) {
    Soup soup(0);
    soup.addFloor(0, c.floor);
    soup.add(c.needle[0], c.needle[1], c.needle[2]);
    soup.light(c.light);
    Scene scene = soup.finish(c.eye, {0, 0.3f, 0});
    scene.cameras[0].fov = 50;
    expectRight(scene, options);
  }
}

// ---- what they must not outlive

TEST(ShadowCache, FollowALightThatMoves) {
  const RenderOptions options = smallOptions();
  Scene scene = load("matte");
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);
  renderer.expectFrames(kPlenty);
  renderer.render(camera, film);
  renderer.fillShadowCache();
  ASSERT_GT(decided(renderer.render(camera, film)), 0u);

  std::vector<Light> lights = scene.lights;
  for (Light& light : lights) light.position = light.position + Vec3f{0.7f, 0.2f, -0.4f};
  editShading(scene, scene.materials, lights);
  renderer.shadingChanged();
  EXPECT_EQ(decided(renderer.render(camera, film)), 0u);
  EXPECT_EQ(firstDifference(film.image, render(scene, options).image), "");
  renderer.fillShadowCache();
  EXPECT_GT(decided(renderer.render(camera, film)), 0u);
  EXPECT_EQ(firstDifference(film.image, render(scene, options).image), "");
}

TEST(ShadowCache, ThereAreNoneForOneFrameNorWhereProofsDoNotReach) {
  const Scene& scene = load("matte");
  const auto decides = [&](const std::function<void(RenderOptions&)>& change, bool expected) {
    RenderOptions options = smallOptions();
    change(options);
    Renderer renderer(scene, options);
    if (expected) renderer.expectFrames(kPlenty);
    return renderer.decidesShadows();
  };
  EXPECT_TRUE(decides([](RenderOptions&) {}, true));
  EXPECT_FALSE(decides([](RenderOptions&) {}, false));
  EXPECT_FALSE(decides([](RenderOptions& o) { o.shadowCache = ShadowCacheMode::off; }, true));
  EXPECT_FALSE(decides([](RenderOptions& o) { o.robust = false; }, true));
  EXPECT_FALSE(decides([](RenderOptions& o) { o.shading.offset = OffsetMethod::fixed; }, true));
  EXPECT_FALSE(
      decides([](RenderOptions& o) { o.disable = EffectSet().with(Effect::shadows); }, true));
}

// Half of a picture's parts wait for another time; what does not fit is traced.
TEST(ShadowCache, TablesMayBeFilledInPartsAndBeTooSmall) {
  const Scene& scene = load("matte");
  const RenderOptions options = smallOptions();
  const Image plain = render(scene, options).image;
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);
  RenderOptions upper = options;
  upper.crop = Crop{0, 0, options.size->width, options.size->height / 2};
  Film half = makeFilm(scene, upper);
  renderer.expectFrames(kPlenty);
  renderer.render(camera, half);
  EXPECT_GT(renderer.fillShadowCache().parts, 0u);
  const FrameStats some = renderer.render(camera, film);
  EXPECT_GT(decided(some), 0u);
  EXPECT_EQ(firstDifference(film.image, plain), "");
  EXPECT_GT(renderer.fillShadowCache().parts, 0u);
  EXPECT_EQ(renderer.fillShadowCache().parts, 0u);
  EXPECT_GT(decided(renderer.render(camera, film)), decided(some));
  EXPECT_EQ(firstDifference(film.image, plain), "");

  renderer.expectFrames(1);
  EXPECT_EQ(renderer.shadowCacheBytes() > kPlenty, false);
  renderer.render(camera, film);
  EXPECT_EQ(firstDifference(film.image, plain), "");
}

// ---- when to look for them

// Returns how many rays a frame with the bits of a plain one did not trace.
std::uint64_t decidedWhenItPays(const Scene& scene, const RenderOptions& options) {
  const Image plain = render(scene, options).image;
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);
  const bool used = prepareShadowCache(renderer, kPlenty, camera, film).has_value();
  const FrameStats stats = renderer.render(camera, film);
  EXPECT_EQ(firstDifference(film.image, plain), "");
  EXPECT_EQ(used, decided(stats) > 0);
  return decided(stats);
}

TEST(ShadowCacheSchedule, LooksForThemWhereManySamplesFollow) {
  const Scene& scene = load("matte");
  RenderOptions options = smallOptions();
  EXPECT_EQ(decidedWhenItPays(scene, options), 0u);
  const double pixels = static_cast<double>(makeFilm(scene, options).image.pixels.size());
  options.spp = static_cast<int>(samplesThatPay(scene) / pixels) + 32;
  EXPECT_GT(decidedWhenItPays(scene, options), 0u);
  RenderOptions off = options;
  off.shadowCache = ShadowCacheMode::off;
  EXPECT_EQ(decidedWhenItPays(scene, off), 0u);
  options.adaptive = true;
  EXPECT_EQ(decidedWhenItPays(scene, options), 0u);
}

TEST(ShadowTables, LookAtWhatManyAskForAndAtSomeAtATime) {
  const Scene& scene = load("matte");
  const RenderOptions options = smallOptions();
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);
  renderer.expectFrames(kPlenty);
  renderer.render(camera, film);
  const std::uint64_t many = renderer.fillShadowCache({.leastRays = 3}).parts;
  EXPECT_GT(many, 0u);
  EXPECT_LE(renderer.fillShadowCache({.mostParts = 5}).parts, 5 * scene.lights.size());
  EXPECT_GT(renderer.fillShadowCache({.mostParts = 5}).parts, 0u);
  renderer.forgetShadowRequests();
  EXPECT_EQ(renderer.fillShadowCache().parts, 0u);
  EXPECT_EQ(firstDifference(film.image, render(scene, options).image), "");
}

// ---- the audit itself

TEST(ShadowCache, AuditNamesLightAndTriangle) {
  FrameStats stats;
  Scene scene = load("matte");
  EXPECT_NO_THROW(requireRightShadows(stats, scene));
  stats.meter.wrongShadow = {true, true, 0, 17, {1, 2, 3}, {0, 1, 0}};
  try {
    requireRightShadows(stats, scene);
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::checkFailed);
    for (const char* part : {"light 0", "triangle 17", "(1, 2, 3)", "blocked"}) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

// ---- one triangle's proofs, by exact rays

double side(const Vec3d& o, const Vec3d& d, const Vec3d& p, const Vec3d& q) {
  return dot(d, cross(p - o, q - o));
}

// Whether the ray meets the triangle before the light, in double.
bool meets(const TriangleRecord& t, const Vec3d& o, const LightPoint& light) {
  const auto corner = [&](int i) {
    return Vec3d(Vec3f{t.position[3 * i], t.position[3 * i + 1], t.position[3 * i + 2]});
  };
  const Vec3d a = corner(0), b = corner(1), c = corner(2), d = light.towards(o);
  const double u = side(o, d, a, b), v = side(o, d, b, c), w = side(o, d, c, a);
  if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) return false;
  const Vec3d n = cross(b - a, c - a);
  const double distance = dot(a - o, n) / dot(d, n);
  return distance > 0 && (light.directional || distance < 1);
}

// A half plane of shadow whose edge is at x = 1 on the floor, seen from receivers at its very edge.
TEST(Caster, NothingIsProvedWithinRoundingOfAnEdge) {
  const TriangleRecord triangle{{0.5f, 2, 40, 0.5f, 2, -40, -40, 2, 0}, {}, 0};
  const Caster caster(triangle, {{0, 4, 0}, false});
  const auto meetAt = [&](double x0, double x1, double reach) {
    Receiver receiver;
    for (const Vec3d& corner : {Vec3d{x0, 0, 0}, Vec3d{x1, 0, 0}, Vec3d{x1, 0, 0.01}}) {
      receiver.add(corner);
      receiver.center += corner / 3.0;
    }
    receiver.radius = 0.02;
    receiver.reach = reach;
    return caster.meet(receiver);
  };
  EXPECT_EQ(meetAt(1.01, 1.02, 0), Meeting::never);
  EXPECT_EQ(meetAt(0.98, 0.99, 0), Meeting::always);
  EXPECT_EQ(meetAt(0.99, 1.01, 0), Meeting::unsure);
  // By less than half a unit in the last place of a coordinate in single precision.
  EXPECT_EQ(meetAt(1 + 1e-8, 1.01, 0), Meeting::unsure);
  EXPECT_EQ(meetAt(0.99, 1 - 1e-8, 0), Meeting::unsure);
  // Rays that start so far beside.
  EXPECT_EQ(meetAt(1.005, 1.01, 0.01), Meeting::unsure);
  EXPECT_EQ(meetAt(0.99, 0.995, 0.01), Meeting::unsure);
}

TEST(Receiver, IsWithoutTheRimAndReachesAsFarAsTheKernelLets) {
  const TriangleRecord triangle{{-8, 0, 0, 8, 0, 0, 0, 0, 16}, {}, 0};
  const ReceivingTriangle receiving(triangle, 4);
  EXPECT_FALSE(receiving.isSliver());
  // The part at the first edge's middle.
  const Receiver part = receiving.piece({0.25, 0, 0.25});
  ASSERT_GT(part.count, 2u);
  const double rim = double{kShadowRim} / 4 * 16;  // of the height over that edge
  double least = 16;
  for (std::size_t i = 0; i < part.count; ++i) least = std::min(least, part.corners[i].z);
  EXPECT_LT(least, rim);  // kernels look up everything from there on
  EXPECT_GT(least, rim / 2);
  EXPECT_GT(part.reach, double{kCachedShadowReach} * 8 * 1.7320508);
  EXPECT_EQ(receiving.piece({0.75, 0.75, 0.25}).count, 0u);
  const TriangleRecord sliver{{0, 0, 0, 1, 0, 0, 0.5f, 0, 1e-4f}, {}, 0};
  EXPECT_TRUE(ReceivingTriangle(sliver, 1).isSliver());
}

TEST(Caster, ProofsHoldForRaysFromAllOfTheReceiver) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto point = [&] { return Vec3f{unit(random), unit(random), unit(random)}; };
  const auto record = [](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    return TriangleRecord{{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}, {}, 0};
  };
  std::size_t never = 0, always = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f base = point() * 2.0f;
    const float size = std::exp2(unit(random) * 5 - 3);
    const ReceivingTriangle receiving(record(base, base + point() * size, base + point() * size),
                                      1);
    if (receiving.isSliver()) continue;
    const Receiver receiver = receiving.piece({0.25, 0.25, 0.25});
    if (receiver.count == 0) continue;
    const LightPoint light{Vec3d(point()) * 3.0, i % 4 == 0};
    const Vec3f at = point() * 1.5f;
    const float extent = std::exp2(unit(random) * 3 + 1);
    const TriangleRecord triangle = record(at + point() * extent, at + point() * extent, at);
    const Meeting meeting = Caster(triangle, light).meet(receiver);
    never += meeting == Meeting::never;
    always += meeting == Meeting::always;
    for (std::size_t k = 0; k < receiver.count; ++k) {
      for (const double t : {0.0, 0.3, 0.9}) {
        const Vec3d o = receiver.corners[k] * (1 - t) + receiver.center * t;
        const bool met = meets(triangle, o, light);
        EXPECT_FALSE(meeting == Meeting::never && met) << i;
        EXPECT_FALSE(meeting == Meeting::always && !met) << i;
      }
    }
  }
  EXPECT_GT(never, 5000u);
  EXPECT_GT(always, 300u);
}

}  // namespace
}  // namespace whit::test
