// Queries of rays through the public header: against whole numbers without rounding, against closed
// forms, and against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <vector>

#include "exact_rays.h"
#include "has_text.h"
#include "library/whit.h"
#include "library_scenes.h"
#include "make/shapes/mesh_builder.h"
#include "pi.h"

namespace whit::api {
namespace {

using test::ExactHit;
using test::WholePoint;
using test::WholeRay;
using test::WholeTriangle;

// Number of rays of each kind. $WHIT_RAYS multiplies it; 20 gives some 10 million rays in all.
std::size_t raysOfAKind() {
  const char* const more = std::getenv("WHIT_RAYS");
  return 12000 * static_cast<std::size_t>(more ? std::atoi(more) : 1);
}

// Triangles in whole numbers, and the factor, a power of two, that makes them coordinates.
struct WholeScene {
  std::vector<WholeTriangle> triangles;
  double unit = 1;

  Renderer renderer() const {
    std::vector<float> positions;
    for (const WholeTriangle& triangle : triangles) {
      for (const WholePoint& corner : triangle) {
        for (const std::int64_t x : corner) {
          positions.push_back(static_cast<float>(static_cast<double>(x) * unit));
        }
      }
    }

    SceneBuilder builder;
    builder.addMesh("mesh", {positions});
    builder.addInstance("mesh");
    Renderer made(builder.build());
    made.closest({});  // reads the positions before they are gone
    return made;
  }
};

WholePoint randomPoint(std::mt19937& random, std::int64_t reach, const WholePoint& center = {}) {
  std::uniform_int_distribution<std::int64_t> offset(-reach, reach);
  return {center[0] + offset(random), center[1] + offset(random), center[2] + offset(random)};
}

// Triangles that cross each other.
WholeScene crossing(std::mt19937& random, std::int64_t reach, const WholePoint& center) {
  WholeScene scene;
  for (int i = 0; i < 40; ++i) {
    const WholePoint about = randomPoint(random, reach / 2, center);
    const std::int64_t size = std::max<std::int64_t>(reach / (1 + i % 7), 2);
    scene.triangles.push_back({randomPoint(random, size, about), randomPoint(random, size, about),
                               randomPoint(random, size, about)});
  }
  return scene;
}

// A closed surface: a bumpy ball.
WholeScene closed(std::mt19937& random, std::int64_t reach, const WholePoint& center) {
  std::uniform_real_distribution<double> bump(0.6, 1);
  const auto [points, faces] = procedural::icosphereMesh(1);

  std::vector<WholePoint> corners;
  for (const Vec3d& point : points) {
    const Vec3d at = point * (bump(random) * static_cast<double>(reach));
    corners.push_back({center[0] + std::llround(at.x), center[1] + std::llround(at.y),
                       center[2] + std::llround(at.z)});
  }

  WholeScene scene;
  for (const auto& [a, b, c] : faces) {
    scene.triangles.push_back({corners[a], corners[b], corners[c]});
  }
  return scene;
}

enum class Aim { anywhere, edges, corners };

std::vector<WholeRay> randomRays(std::mt19937& random, const WholeScene& scene, Aim aim,
                                 std::int64_t reach, const WholePoint& center, std::size_t count) {
  std::vector<WholeRay> rays;
  std::uniform_int_distribution<std::size_t> any(0, scene.triangles.size() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const WholePoint origin = randomPoint(random, 4 * reach, center);
    const WholeTriangle& triangle = scene.triangles[any(random)];
    // The mean of two points is aimed at: of the ends of an edge, or of the same point twice.
    const WholePoint anywhere = randomPoint(random, reach, center);
    const WholePoint& a = aim == Aim::anywhere ? anywhere : triangle[i % 3];
    const WholePoint& b = aim == Aim::edges ? triangle[(i + 1) % 3] : a;
    WholeRay ray{origin, {}};
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = a[k] + b[k] - 2 * origin[k];
    if (ray.direction != WholePoint{}) rays.push_back(ray);
  }
  return rays;
}

struct Columns {
  std::vector<double> origins, directions;
  operator Rays() const { return {{{}, origins}, {{}, directions}}; }
};

Columns columnsOf(const std::vector<WholeRay>& rays, double unit) {
  Columns columns;
  for (const WholeRay& ray : rays) {
    for (std::size_t k = 0; k < 3; ++k) {
      columns.origins.push_back(static_cast<double>(ray.origin[k]) * unit);
      columns.directions.push_back(static_cast<double>(ray.direction[k]) * unit);
    }
  }
  return columns;
}

struct Tally {
  std::size_t rays = 0, certain = 0, open = 0, wrong = 0;
};

// Returns true if rounding may leave open which surface this exact hit is on, because it is on an
// edge or at the same distance as another hit.
bool isOpen(const std::vector<ExactHit>& exact, std::size_t i) {
  const auto together = [&](std::size_t a, std::size_t b) {
    return b < exact.size() && !test::isNearer(exact[a], exact[b]);
  };
  return exact[i].onEdge || together(i, i + 1) || (i > 0 && together(i - 1, i));
}

// Returns true if a ray hits the border of a triangle exactly and at a grazing angle. Queries may
// miss such a border.
bool isBeyondPromise(const ExactHit& hit) {
  constexpr double kLeastCosine = 1.0 / 16;
  return hit.onEdge && hit.cosine < kLeastCosine;
}

void compare(const WholeScene& scene, const std::vector<WholeRay>& rays, Tally& tally) {
  Renderer renderer = scene.renderer();
  const Columns columns = columnsOf(rays, scene.unit);
  const RayHits hits = renderer.closest(columns);
  const RayAnswers blocked = renderer.occluded(columns);
  const RayHits all = renderer.allHits(columns);

  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::vector<ExactHit> exact = test::exactHits(scene.triangles, rays[i]);
    if (std::ranges::any_of(exact, isBeyondPromise)) continue;

    ++tally.rays;
    tally.certain += hits.certain[i];
    tally.open += !exact.empty() && isOpen(exact, 0) ? 1 : 0;
    // The closest hit must be the exact one, unless the query says that it is not certain.
    bool right = hits.certain[i] == 0;
    if (!right && exact.empty()) right = hits.sides[i] == 0;
    if (!right && !exact.empty()) {
      right = !isOpen(exact, 0) && hits.triangles[i] == exact[0].triangle &&
              hits.sides[i] == (exact[0].front ? 1 : -1) &&
              std::abs(hits.t[i] - exact[0].t()) <= hits.tError[i] + 0x1p-52 * hits.t[i];
    }

    if (blocked.certain[i] != 0) right = right && (blocked.yes[i] != 0) == !exact.empty();
    right = right && (blocked.yes[i] != 0) == (hits.sides[i] != 0);

    const std::size_t first = all.offsets[i], count = all.offsets[i + 1] - first;
    const auto certain = all.certain.subspan(first, count);
    const bool allCertain = std::ranges::find(certain, 0) == certain.end();
    // A complete list of certain hits must be the exact list.
    if (allCertain && hits.certain[i] != 0) {
      right = right && count == exact.size();
      for (std::size_t k = 0; right && k < count; ++k) {
        right = all.triangles[first + k] == exact[k].triangle && !isOpen(exact, k);
      }
    }

    if (right) continue;
    ++tally.wrong;
    ADD_FAILURE() << "ray " << i << ": t " << hits.t[i] << " of triangle " << hits.triangles[i]
                  << ", " << count << " of " << exact.size() << " hits, exactly "
                  << (exact.empty() ? -1 : exact[0].t()) << " of "
                  << (exact.empty() ? 0 : exact[0].triangle);
    if (tally.wrong > 5) return;
  }
}

constexpr std::int64_t kReaches[] = {12, 1 << 10, 1 << 20};
constexpr int kExponents[] = {-70, -20, 0, 24};

template <typename MakeScene>
Tally compareAll(const MakeScene& make, Aim aim) {
  Tally tally;
  std::mt19937 random(7);
  for (const std::int64_t reach : kReaches) {
    for (const int exponent : kExponents) {
      // The scene lies near the origin, and as far from it as floats hold these whole numbers
      // exactly.
      for (const std::int64_t away : {std::int64_t{0}, (std::int64_t{1} << 24) - 2 * reach}) {
        const WholePoint center{away, -away, away / 2};
        WholeScene scene = make(random, reach, center);
        scene.unit = std::ldexp(1.0, exponent);
        const std::size_t count = raysOfAKind() / 24 + 1;
        compare(scene, randomRays(random, scene, aim, reach, center, count), tally);
      }
    }
  }

  return tally;
}

TEST(RayQueries, AreExactForRandomRays) {
  // In scenes of few coordinates rays hit edges by chance; the others are certain.
  for (const Tally& tally :
       {compareAll(crossing, Aim::anywhere), compareAll(closed, Aim::anywhere)}) {
    EXPECT_EQ(tally.wrong, 0u);
    EXPECT_GE(tally.certain, (tally.rays - tally.open) * 999 / 1000);
  }
}

TEST(RayQueries, FlagWhatPassesAnEdgeOrACorner) {
  for (const Aim aim : {Aim::edges, Aim::corners}) {
    EXPECT_EQ(compareAll(closed, aim).wrong, 0u);
    EXPECT_EQ(compareAll(crossing, aim).wrong, 0u);
  }
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = 0xffffffffu;

Renderer rendererOf(const char* json) {
  return Renderer(SceneBuilder("rays", asJson(json)).build({.moves = true}));
}

Renderer unitSphere() { return rendererOf("{'scene': [{'shape': 'sphere', 'radius': 1}]}"); }

using Points = std::vector<std::array<double, 2>>;

// Rays down the z axis through points of the plane z = 0, from z = 4.
Columns downThrough(const Points& points) {
  Columns columns;
  for (const auto& [x, y] : points) {
    columns.origins.insert(columns.origins.end(), {x, y, 4});
    columns.directions.insert(columns.directions.end(), {0, 0, -2});
  }
  return columns;
}

// Has the mesh of a square of side 1 about the origin, in the plane z = 0.
SceneBuilder withSquare(const std::string& json) {
  static constexpr float kPositions[] = {-.5f, -.5f, 0, .5f, -.5f, 0, .5f, .5f, 0, -.5f, .5f, 0};
  static constexpr float kUvs[] = {0, 0, 1, 0, 1, 1, 0, 1};
  static constexpr std::uint32_t kTriangles[] = {0, 1, 2, 0, 2, 3};
  SceneBuilder builder("rays", asJson(json));
  builder.addMesh("square", {kPositions, kTriangles, {}, kUvs});
  return builder;
}

Renderer squaresAt(const std::vector<Matrix>& places, const std::string& json = "{}") {
  SceneBuilder builder = withSquare(json);
  for (const Matrix& place : places) builder.addInstance("square", "", place);
  return Renderer(builder.build());
}

TEST(RayQueries, FindSpheresInClosedForm) {
  Renderer renderer = rendererOf(
      "{'scene': [{'shape': 'sphere', 'radius': 1}, {'shape': 'sphere', 'radius': 1,"
      "'transform': {'translate': [10, 0, 0], 'scale': [2, 1, 0.5]}}]}");

  Points points;
  for (int i = 0; i < 400; ++i) points.push_back({-1.2 + 0.006 * i, 0.3});
  for (int i = 0; i < 400; ++i) points.push_back({7.5 + 0.0125 * i, -0.4});

  const Columns down = downThrough(points);
  const RayHits hits = renderer.closest(down), all = renderer.allHits(down);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y] = points[i];
    const bool first = i < 400;
    const double room = first ? 1 - x * x - y * y : 1 - (x - 10) * (x - 10) / 4 - y * y;
    ASSERT_EQ(hits.certain[i], 1) << i;
    ASSERT_EQ(hits.sides[i], room > 0 ? 1 : 0) << i;
    ASSERT_EQ(all.offsets[i + 1] - all.offsets[i], room > 0 ? 2u : 0u) << i;
    if (room < 0) continue;

    const double z = std::sqrt(room) * (first ? 1 : 0.5);
    EXPECT_NEAR(hits.t[i], (4 - z) / 2, hits.tError[i]);
    EXPECT_LT(hits.tError[i], 1e-11);              // a root of two roundings where it grazes
    EXPECT_NEAR(hits.points[3 * i + 2], z, 1e-6);  // the weights of the point are floats
    EXPECT_NEAR(all.t[all.offsets[i] + 1], (4 + z) / 2, all.tError[all.offsets[i] + 1]);
    EXPECT_EQ(all.sides[all.offsets[i] + 1], -1);
    EXPECT_EQ(hits.objects[i], first ? 0u : 1u);
    // The normal of x^2/a^2 + y^2/b^2 + z^2/c^2 = 1.
    const auto [nx, nz] = first ? std::pair{x, z} : std::pair{(x - 10) / 4, z / 0.25};
    EXPECT_NEAR(hits.shadingNormals[3 * i], nx / std::hypot(nx, y, nz), 1e-5);
  }
}

TEST(RayQueries, FindInstancesWhereTheyStand) {
  // The instances are plain, mirrored, turned and stretched, and very small beside the others.
  // The ball stands once, so that the tracer makes no instance of it; numbers count it as well.
  const std::vector<Matrix> places{kIdentity,
                                   placed({5, 0, 1}, {-3, 1, 1}),
                                   {0, -2, 0, 0, 1, 0, 0, 5, 0, 0, 1, -1},
                                   placed({5, 5, 2}, {1e-4, 1e-4, 1})};
  Renderer renderer = squaresAt(
      places, "{'scene': [{'shape': 'icosphere', 'transform': {'translate': [20, 0, 0]}}]}");

  std::mt19937 random(5);
  std::uniform_real_distribution<double> inside(-0.49, 0.49);
  Points points;
  for (int i = 0; i < 400; ++i) {
    const Matrix& m = places[static_cast<std::size_t>(i % 4)];
    const double x = inside(random), y = inside(random);
    points.push_back({m[0] * x + m[1] * y + m[3], m[4] * x + m[5] * y + m[7]});
  }

  const Columns down = downThrough(points);
  const RayHits hits = renderer.closest(down);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(hits.instances[i], 1 + i % 4);
    EXPECT_EQ(hits.objects[i], 1 + i % 4);
    EXPECT_EQ(hits.certain[i], 1);
    EXPECT_NEAR(hits.t[i], (4 - places[i % 4][11]) / 2, hits.tError[i]);
    EXPECT_EQ(hits.sides[i], 1);  // a mirrored front is a front
    EXPECT_FLOAT_EQ(hits.geometricNormals[3 * i + 2], 1);
  }
}

TEST(RayQueries, HitOneOfCoplanarSurfaces) {
  SceneBuilder builder = withSquare("{'materials': {'a': {}, 'b': {}}}");
  builder.addInstance("square", "a");
  builder.addInstance("square", "b");  // written later, so it is hit
  Renderer renderer(builder.build());

  const Columns down = downThrough({{0.1, 0.2}, {-0.3, 0.05}, {0.7, 0}});
  const RayHits hits = renderer.closest(down), all = renderer.allHits(down);
  EXPECT_EQ(hits.certain[0] + hits.certain[1] + hits.certain[2], 3);
  EXPECT_EQ(hits.objects[0], 1u);
  EXPECT_EQ(hits.objects[1], 1u);
  EXPECT_EQ(hits.objects[2], kNone);
  EXPECT_EQ(all.t.size(), 2u);
}

TEST(RayQueries, CountASharedEdgeOnce) {
  // The point is on the diagonal.
  const RayHits all = squaresAt({kIdentity}).allHits(downThrough({{0.25, 0.25}}));
  ASSERT_EQ(all.t.size(), 1u);
  EXPECT_EQ(all.certain[0], 0);
  EXPECT_DOUBLE_EQ(all.t[0], 2);
}

TEST(RayQueries, CutMasksAndPassBacksAsPicturesDo) {
  SceneBuilder builder =
      withSquare("{'materials': {'holes': {'alphaMap': 'mask'}, 'front': {'doubleSided': false}}}");
  static constexpr float kMask[] = {1, 1, 1, 0};  // gray and alpha: the right half is cut
  builder.addTexture("mask", {2, 1, 2, {}, kMask});
  builder.addInstance("square", "holes", placed({0, 0, 1}));
  builder.addInstance("square", "front", placed({}, {-1, 1, -1}));
  builder.addInstance("square", "", placed({0, 0, -1}));
  Renderer renderer(builder.build());

  const Columns down = downThrough({{-0.3, 0.1}, {0.3, 0.1}});
  const RayHits hits = renderer.closest(down);
  EXPECT_DOUBLE_EQ(hits.t[0], 1.5);
  EXPECT_DOUBLE_EQ(hits.t[1], 2.5);
  EXPECT_EQ(hits.objects[1], 2u);
  EXPECT_EQ(hits.certain[0] + hits.certain[1], 2);
}

TEST(RayQueries, AnswerAtThePresentTime) {
  Renderer renderer = rendererOf(
      "{'scene': [{'shape': 'sphere', 'radius': 1, 'motion':"
      "{'keys': [{'time': 0}, {'time': 2, 'translate': [0, 0, 2]}]}}]}");
  const Columns down = downThrough({{0, 0}});
  EXPECT_DOUBLE_EQ(renderer.closest(down).t[0], 1.5);
  renderer.setTime(1);
  EXPECT_DOUBLE_EQ(renderer.closest(down).t[0], 1);
}

TEST(RayQueries, CountHitsBetweenTheLimits) {
  Renderer renderer = unitSphere();
  const Columns down = downThrough({{0.1, 0.1}});

  const double near = renderer.closest(down).t[0];
  const auto tOf = [&](double from, double to) {
    Rays rays = down;
    rays.near.doubles = {&from, 1};
    rays.far.doubles = {&to, 1};
    return renderer.closest(rays).t[0];
  };

  EXPECT_EQ(tOf(near - 0.01, near + 0.01), near);
  EXPECT_GT(tOf(near + 0.01, 9), near + 0.1);
  EXPECT_EQ(tOf(0, near - 0.01), kInfinity);
  EXPECT_EQ(tOf(3, 2), kInfinity);
}

TEST(RayQueries, DoNotDependOnTheOtherRays) {
  std::mt19937 random(11);
  const WholeScene scene = crossing(random, 1 << 10, {});
  std::vector<WholeRay> rays = randomRays(random, scene, Aim::anywhere, 1 << 10, {}, 3000);
  for (int i = 0; i < 3000; ++i) rays[static_cast<std::size_t>(i)].origin[0] += i % 2;

  // Rays like a camera's are traced in packets.
  for (int i = 0; i < 4096; ++i) {
    rays.push_back({{100, 200, 4000}, {i % 64 * 40 - 1280, i / 64 * 40 - 1280, -4000}});
  }

  Renderer renderer = scene.renderer();
  const Columns columns = columnsOf(rays, 1);
  const RayHits together = renderer.set("threads", "3").closest(columns);
  for (std::size_t i = 0; i < rays.size(); i += 7) {
    const Columns one = columnsOf({rays[i]}, 1);
    const RayHits alone = renderer.closest(one);
    ASSERT_EQ(alone.t[0], together.t[i]) << i;
    ASSERT_EQ(alone.triangles[0], together.triangles[i]) << i;
    ASSERT_EQ(alone.certain[0], together.certain[i]) << i;
  }
}

TEST(RayQueries, TakeFloatsAsDoubles) {
  Renderer renderer = unitSphere();
  const float origin[] = {0.1f, 0.2f, 4}, direction[] = {0, 0.1f, -1};
  const double origin2[] = {double{0.1f}, double{0.2f}, 4}, direction2[] = {0, double{0.1f}, -1};
  const double t = renderer.closest({{origin, {}}, {direction, {}}}).t[0];
  EXPECT_EQ(t, renderer.closest({{{}, origin2}, {{}, direction2}}).t[0]);
  EXPECT_TRUE(std::isfinite(t));
}

TEST(RayQueries, SayWhatTheyCannotTake) {
  Renderer renderer = unitSphere();
  const std::vector<double> three{0, 0, 4}, six{0, 0, -1, 0, 0, -1}, four{0, 0, -1, 0};

  for (const Rays& rays : {Rays{{{}, three}, {{}, six}}, Rays{{{}, four}, {{}, four}},
                           Rays{{{}, six}, {{}, six}, {{}, three}}}) {
    EXPECT_EQ(statusOf([&] { renderer.closest(rays); }), 2);
  }
  EXPECT_EQ(statusOf([&] { renderer.ambientOcclusion({{}, three}, {{}, three}, 0, 4); }), 2);

  // Rays without a direction, or with numbers that are not finite, hit nothing and are not certain.
  const double nan = std::nan("");
  const std::vector<double> origins{0, 0, 4, nan, 0, 4, 0, 0, kInfinity, 1e60, 0, 0};
  const std::vector<double> directions{0, 0, 0, 0, 0, -1, 0, 0, -1, -1, 0, 0};
  const RayHits hits = renderer.closest({{{}, origins}, {{}, directions}});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(hits.t[i], kInfinity);
    EXPECT_EQ(hits.certain[i], 0);
  }
  EXPECT_EQ(hits.certain[3], 0);

  EXPECT_TRUE(renderer.closest({}).t.empty());
}

// A square above the point, of half-side a in the height h, hides this share of the light of an
// even sky: its form factor (Siegel and Howell, "Thermal Radiation Heat Transfer", a corner of a
// parallel rectangle, four times).
double coveredBySquare(double a, double h) {
  const double x = a / h, root = std::sqrt(1 + x * x);
  return 4 * 2 * (x / root * std::atan(x / root)) / (2 * kPi);
}

TEST(RayQueries, FindAmbientOcclusionInClosedForm) {
  Renderer renderer = squaresAt({placed({}, {100, 100, 1}), placed({0, 0, 1}, {2, 2, 1})});
  constexpr int kSamples = 4096;
  const auto openWithin = [&](double radius) {
    const double point[] = {0, 0, 0}, normal[] = {0, 0, 1};
    return renderer.ambientOcclusion({{}, point}, {{}, normal}, radius, kSamples)[0];
  };

  // An even lattice of N points is off by less than the half of 1/sqrt(N) of random ones.
  EXPECT_NEAR(openWithin(10), 1 - coveredBySquare(1, 1), 0.5 / std::sqrt(kSamples));
  EXPECT_EQ(openWithin(0.5), 1);
}

TEST(RayQueries, SeeFromSurfaceToSurface) {
  // A floor, a ceiling and a screen between, far from the origin.
  Renderer renderer = squaresAt({placed({3000, 1000, 0}, {8, 8, 1}),
                                 placed({3000, 1000, 2}, {8, 8, 1}), placed({3000, 1000, 1})});

  std::vector<double> floor, ceiling, normals;
  std::vector<std::uint8_t> expected;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-3.9, 3.9);
  for (int i = 0; i < 2000; ++i) {
    const double a[] = {place(random), place(random)}, b[] = {place(random), place(random)};
    const double x = (a[0] + b[0]) / 2, y = (a[1] + b[1]) / 2;
    floor.insert(floor.end(), {3000 + a[0], 1000 + a[1], 0});
    ceiling.insert(ceiling.end(), {3000 + b[0], 1000 + b[1], 2});
    normals.insert(normals.end(), {0, 0, 1});
    expected.push_back(std::max(std::abs(x), std::abs(y)) > 0.5 ? 1 : 0);
  }

  const Numbers from{{}, floor}, to{{}, ceiling}, about{{}, normals};
  EXPECT_EQ(renderer.visible(from, to).yes, expected);
  EXPECT_EQ(renderer.visible(from, to, about, about).yes, expected);
}

// A model that was moved to the origin is asked, and answers, in coordinates of its file.
TEST(RayQueries, AreInCoordinatesOfAFarFile) {
  const TemporaryFolder folder;
  const std::string model = folder / "far.obj";
  std::ofstream(model) << "v 4000000.1 500000.2 10\nv 4000001.1 500000.2 10\n"
                          "v 4000000.1 500001.2 10\nf 1 2 3\n";
  Renderer renderer = smallRenderer(model, {.settings = {"/up=\"y\""}});
  constexpr double kRounding = 1.2e-7;  // of coordinates below 2

  // Beside the hypotenuse, on either side of it.
  const double inside = 0.499, outside = 0.501;
  const std::vector<double> from{4000000.1 + inside,  500000.2 + 0.5, 12,
                                 4000000.1 + outside, 500000.2 + 0.5, 12};
  const std::vector<double> down{0, 0, -1, 0, 0, -1};
  const Columns rays{from, down};
  const RayHits hits = renderer.closest(rays);
  EXPECT_NEAR(hits.t[0], 2, kRounding);
  EXPECT_EQ(hits.triangles[1], kNone);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(hits.points[i], from[i], kRounding);
  EXPECT_NEAR(hits.points[2], 10, kRounding);
  EXPECT_EQ(renderer.occluded(rays).yes, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_EQ(renderer.allHits(rays).offsets, (std::vector<std::uint64_t>{0, 1, 1}));

  std::vector<double> below = from;
  below[2] = below[5] = 8;
  EXPECT_EQ(renderer.visible({{}, from}, {{}, below}).yes, (std::vector<std::uint8_t>{0, 1}));
  const std::vector<double> up{0, 0, 1, 0, 0, 1};
  EXPECT_EQ(renderer.ambientOcclusion({{}, from}, {{}, up}, 10, 16), (std::vector<float>{1, 1}));

  // The camera of such a scene comes back.
  const Image first = renderer.render();
  EXPECT_TRUE(samePictures(renderer.lookThrough(renderer.scene().camera()), first));
  EXPECT_TRUE(hasText(renderer.scene().camera(), "\"at\":[400000"));
}

}  // namespace
}  // namespace whit::api
