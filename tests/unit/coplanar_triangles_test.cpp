// Triangles that overlap another one in its plane, and the neighbors of such triangles.
#include "bake/coplanar_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pi.h"
#include "render/facetted_sphere.h"
#include "unit/scene_builder.h"

namespace whit {
namespace {

using Meshes = std::vector<Mesh>;

using test::finalized;

constexpr int kThreads = 2;

CoplanarTriangles foundAmong(const Scene& scene, int threads = kThreads) {
  bool complete = false;
  CoplanarTriangles found = findCoplanarTriangles(scene, threads, complete);
  EXPECT_TRUE(complete);
  return found;
}

// Returns two triangles, divided by the diagonal from `corner`.
Mesh rectangle(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
  Mesh mesh;
  mesh.positions = {Vec3f(corner), Vec3f(corner + u), Vec3f(corner + u + v), Vec3f(corner + v)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Returns a rectangle of the floor z = height.
Mesh tile(double x, double y, double width, double depth, double height = 0) {
  return rectangle({x, y, height}, {width, 0, 0}, {0, depth, 0});
}

Meshes box(const Vec3d& corner, const Vec3d& size) {
  const Vec3d x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  return {rectangle(corner, x, y),     rectangle(corner, y, z),     rectangle(corner, z, x),
          rectangle(corner + z, x, y), rectangle(corner + x, y, z), rectangle(corner + y, z, x)};
}

// Describes meshes that may be used several times. Each has a material of its own, since a
// duplicate of the same material would be dropped.
class Builder {
 public:
  void add(const Meshes& meshes, const std::vector<Affine>& places = {Affine{}}) {
    const auto object = size32(description_.objects);
    description_.objects.push_back({"object", meshes});
    for (Mesh& mesh : description_.objects.back().meshes) {
      mesh.materials = {size32(description_.materials)};
      description_.materials.emplace_back().name = std::to_string(description_.materials.size());
    }

    for (const Affine& place : places) description_.instances.push_back({object, place});
  }

  // Transforms everything.
  void move(const Affine& map) {
    for (Instance& instance : description_.instances) instance.toWorld = map * instance.toWorld;
  }
  Scene scene() const { return finalized(description_); }

 private:
  SceneDescription description_;
};

Affine farAndTurned() {
  return Affine::translation({1e3, 2e3, -5e2}) * Affine::rotation({3, -1, 2}, 37.3);
}

std::vector<PlacedTriangleId> allOf(const Scene& scene) {
  std::vector<PlacedTriangleId> all;
  const auto add = [&](std::uint32_t geometry, std::uint32_t instance) {
    const Geometry& g = scene.geometries[geometry];
    for (std::uint32_t i = 0; i < g.index.size(); ++i) {
      all.push_back({g.firstTriangle + i, instance});
    }
  };

  add(0, kNoInstance);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) add(scene.instances[i].geometry, i);
  return all;
}

// The definition of coplanar_triangles.h, word by word, without its acceleration.
struct Placed {
  PlacedTriangleId id;
  Vec3d corners[3];
  double error = 0;
  Vec3d normal;
};

Placed placed(const Scene& scene, PlacedTriangleId id) {
  Placed p;
  p.id = id;
  for (int i = 0; i < 3; ++i) {
    const Affine map = id.instance == kNoInstance ? Affine() : scene.instances[id.instance].toWorld;
    const Vec3d own = test::corner(scene.triangles[id.triangle], i), far = abs(own);
    const Vec3d size = abs(map.x) * far.x + abs(map.y) * far.y + abs(map.z) * far.z + abs(map.p);
    p.corners[i] = map.point(own);
    p.error = std::max(p.error, 32 * std::ldexp(size.x + size.y + size.z, -24));
  }

  p.normal = normalized(cross(p.corners[1] - p.corners[0], p.corners[2] - p.corners[0]));
  return p;
}

bool inOnePlane(const Placed& a, const Placed& b) {
  for (int i = 0; i < 3; ++i) {
    const double tolerance = a.error + b.error;
    if (std::abs(dot(b.corners[i] - a.corners[0], a.normal)) > tolerance) return false;
    if (std::abs(dot(a.corners[i] - b.corners[0], b.normal)) > tolerance) return false;
  }
  return true;
}

// Returns the width of the common part, across the edge that leaves the least of it.
double commonWidth(const Placed& a, const Placed& b) {
  double least = INFINITY;
  for (const Placed* owner : {&a, &b}) {
    for (int i = 0; i < 3; ++i) {
      const Vec3d edge = owner->corners[(i + 1) % 3] - owner->corners[i];
      const Vec3d axis = normalized(cross(owner->normal, edge));
      const auto rangeOf = [&](const Placed& p) {
        const double x[] = {dot(p.corners[0], axis), dot(p.corners[1], axis),
                            dot(p.corners[2], axis)};
        return std::ranges::minmax(x);
      };

      const auto [lowerA, upperA] = rangeOf(a);
      const auto [lowerB, upperB] = rangeOf(b);
      least = std::min(least, std::min(upperA, upperB) - std::max(lowerA, lowerB));
    }
  }

  return least;
}

using Partners = std::vector<std::vector<PlacedTriangleId>>;  // one list for each of allOf()

Partners byDefinition(const Scene& scene) {
  std::vector<Placed> all;
  for (const PlacedTriangleId id : allOf(scene)) all.push_back(placed(scene, id));
  std::vector<std::vector<std::size_t>> touching(all.size());
  std::vector<bool> overlaps(all.size()), coplanar(all.size());

  // A triangle overlaps if the common part is wider than the rounding, and touches if there is no
  // gap wider than the rounding.
  for (const auto i : indices(all)) {
    for (const auto k : indices(all)) {
      if (i == k || !inOnePlane(all[i], all[k])) continue;
      const double width = commonWidth(all[i], all[k]), tolerance = all[i].error + all[k].error;
      if (width > tolerance) overlaps[i] = true;
      if (width > -tolerance) touching[i].push_back(k);
    }
  }

  // Triangles that touch an overlapping one are coplanar as well.
  for (const auto i : indices(all)) {
    if (!overlaps[i]) continue;
    coplanar[i] = true;
    for (const std::size_t k : touching[i]) coplanar[k] = true;
  }

  Partners partners(all.size());
  for (const auto i : indices(all)) {
    for (const std::size_t k : touching[i]) {
      if (coplanar[i] && coplanar[k]) partners[i].push_back(all[k].id);
    }
  }
  return partners;
}

Partners partnersIn(const CoplanarTriangles& found, const Scene& scene) {
  Partners partners;
  for (const PlacedTriangleId id : allOf(scene)) {
    const auto own = found.partnersOf(id);
    partners.emplace_back(own.begin(), own.end());
  }
  return partners;
}

std::string textOf(const Partners& partners) {
  std::string text;
  for (const auto i : indices(partners)) {
    if (partners[i].empty()) continue;
    text += std::to_string(i) + ":";
    for (const PlacedTriangleId p : partners[i]) {
      text += " " + std::to_string(p.triangle);
      if (p.instance != kNoInstance) text += "@" + std::to_string(p.instance);
    }
    text += "\n";
  }
  return text;
}

// Returns how many placed triangles are coplanar with others.
std::size_t expectAsDefined(const Scene& scene) {
  const CoplanarTriangles found = foundAmong(scene);
  const Partners wanted = byDefinition(scene);
  EXPECT_EQ(textOf(partnersIn(found, scene)), textOf(wanted));

  std::vector<bool> any(scene.triangles.size());
  std::size_t coplanar = 0;
  const std::vector<PlacedTriangleId> all = allOf(scene);
  for (const auto i : indices(all)) {
    coplanar += !wanted[i].empty();
    if (!wanted[i].empty()) any[all[i].triangle] = true;
  }
  for (std::uint32_t i = 0; i < any.size(); ++i) EXPECT_EQ(found.any(i), any[i]) << i;
  EXPECT_EQ(found.empty(), coplanar == 0);
  return coplanar;
}

// Checks the scene as built, and transformed so that planes agree up to rounding only. Returns how
// many placed triangles are coplanar in both.
std::size_t expectAsDefinedAnywhere(Builder builder) {
  const std::size_t coplanar = expectAsDefined(builder.scene());
  builder.move(farAndTurned());
  return coplanar + expectAsDefined(builder.scene());
}

void expectCoplanar(const Builder& builder, std::size_t coplanar) {
  EXPECT_EQ(expectAsDefinedAnywhere(builder), 2 * coplanar);
}

// Returns the scene of objects without instances.
Builder world(const std::vector<Meshes>& objects) {
  Builder builder;
  for (const Meshes& meshes : objects) builder.add(meshes);
  return builder;
}

const Builder kDecalInAFloor = world({{tile(0, 0, 10, 10), tile(6, 1, 1, 1)}});

TEST(CoplanarTriangles, ADecalInAFloor) {
  const Scene scene = kDecalInAFloor.scene();
  const CoplanarTriangles found = foundAmong(scene);
  // The decal lies in the floor's first triangle, which touches the second.
  EXPECT_EQ(textOf(partnersIn(found, scene)), "0: 1 2 3\n1: 0\n2: 0 3\n3: 0 2\n");
  EXPECT_GT(found.bytes(), 8 * sizeof(PlacedTriangleId));
  EXPECT_LT(found.bytes(), 2000u);

  EXPECT_TRUE(found.any(3));
  EXPECT_FALSE(found.any(4));
  EXPECT_FALSE(found.any(0xfffffffe));
  EXPECT_TRUE(found.partnersOf({0, 0}).empty());

  EXPECT_EQ(CoplanarTriangles().bytes(), 0u);
  EXPECT_TRUE(CoplanarTriangles().partnersOf({0, kNoInstance}).empty());
}

TEST(CoplanarTriangles, OverlapInOnePlane) {
  Meshes tiles;
  for (int i = 0; i < 36; ++i) tiles.push_back(tile(i % 6, i / 6, 1, 1));
  const Meshes decal{tile(2.25, 2.25, 0.5, 0.5)};

  expectCoplanar(kDecalInAFloor, 4);
  expectCoplanar(world({box({0, 0, 0}, {1, 1, 1}), box({1, 0.25, 0.25}, {1, 0.5, 0.5})}), 4);
  // These are the decal, the tile below it, and the eight tiles around it, whose triangles touch
  // the lower tile's two.
  expectCoplanar(world({tiles, decal}), 2 + 2 + 14);
}

TEST(CoplanarTriangles, AreNoneWhereNothingOverlaps) {
  expectCoplanar({}, 0);
  EXPECT_EQ(expectAsDefined(world({{tile(0, 0, 10, 10), tile(6, 1, 1, 1, 1e-3)}}).scene()), 0u);

  // Crossing planes, and folded sheets.
  expectCoplanar(world({{tile(0, 0, 10, 10), rectangle({2, 3, -4}, {5, 0, 0}, {0, 0, 8}),
                         rectangle({2, 3, -4}, {5, 1, 0}, {1, 0, 8})},
                        {rectangle({20, 0, 0}, {1, 0, 0}, {0, 4, 0}),
                         rectangle({21, 0, 0}, {-0.99, 0, 0.05}, {0, 4, 0}),
                         rectangle({20.01, 0, 0.05}, {0.99, 0, 0.02}, {0, 4, 0})}}),
                 0);

  // Neighbors in a plane; some corners lie on edges of others.
  expectCoplanar(world({{tile(0, 0, 2, 1), tile(2, 0, 1, 3), tile(0, 1, 1, 2), tile(1, 1, 1, 2)}}),
                 0);
}

TEST(CoplanarTriangles, InstancesInOnePlace) {
  Builder builder;
  builder.add(box({0, 0, 0}, {1, 2, 3}), {Affine{}, Affine{}});
  expectCoplanar(builder, 24);
}

TEST(CoplanarTriangles, OfManyInstancesInOnePlaceFourTakePart) {
  Builder builder;
  builder.add(box({0, 0, 0}, {1, 2, 3}), std::vector<Affine>(7));
  const CoplanarTriangles found = foundAmong(builder.scene());
  for (std::uint32_t i = 0; i < 7; ++i) {
    // A face of four instances has eight triangles, each with seven partners.
    EXPECT_EQ(found.partnersOf({0, i}).size(), i < 4 ? 7u : 0u) << i;
  }
}

TEST(CoplanarTriangles, InstancesAgainstTheWorldAndEachOther) {
  Builder builder;
  builder.add({tile(-10, -10, 40, 40)});
  builder.add(box({0, 0, 0}, {1, 1, 1}),
              {Affine{}, Affine::translation({1, 0.5, 0}), Affine::translation({9, 9, 1}),
               Affine::translation({5, 5, -1}) * Affine::rotation({0, 0, 1}, 20)});
  // These are the floor, the bottoms of two boxes, the top of the last, and two faces against each
  // other.
  expectCoplanar(builder, 2 + 2 + 2 + 2 + 4);
}

TEST(CoplanarTriangles, ASphereIsNot) {
  const Mesh sphere = test::facettedSphere(0, 48, 96);
  EXPECT_TRUE(foundAmong(world({{sphere}}).scene()).empty());

  Builder instanced;
  instanced.add({sphere}, {Affine{}, Affine::translation({0.7, 0.1, 0})});
  EXPECT_TRUE(foundAmong(instanced.scene()).empty());
}

// Returns a rectangle in a plane and at a place that many others share.
Mesh randomRectangle(std::mt19937& random) {
  const auto below = [&](int n) { return static_cast<double>(random() % n); };
  const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto u = random() % 3, v = (u + 1 + random() % 2) % 3;
  const Vec3d corner{below(7), below(7), below(7)};
  return rectangle(corner, axes[u] * (1 + below(4)), axes[v] * (1 + below(4)));
}

TEST(CoplanarTriangles, RandomRectanglesAreAsDefined) {
  std::mt19937 random(5);
  std::size_t coplanar = 0;
  for (int round = 0; round < 12; ++round) {
    Builder builder;
    Meshes world;
    for (int i = 0; i < 20 * (1 + round % 4); ++i) world.push_back(randomRectangle(random));

    builder.add(world);
    for (int object = 0; object < round % 3; ++object) {
      const Affine turned = Affine::translation({0, 3, 1}) * Affine::rotation({0, 0, 1}, 90);
      builder.add({randomRectangle(random), randomRectangle(random), randomRectangle(random)},
                  {Affine{}, turned, Affine::translation({2, 0, 1})});
    }

    if (round % 2 == 1) builder.move(farAndTurned());
    coplanar += expectAsDefined(builder.scene());
  }
  EXPECT_GT(coplanar, 500u);
}

auto randomBelow(std::mt19937& random) {
  return [&random](double most) { return most * 0x1p-32 * static_cast<double>(random()); };
}

// Returns a triangle in one of two floors; one in three is a needle.
Mesh randomTriangle(std::mt19937& random) {
  const auto below = randomBelow(random);
  const double x = below(5), y = below(5), width = 0.5 + below(2);
  const double depth = random() % 3 == 0 ? 0.01 : 0.5 + below(2);
  Mesh mesh = tile(x, y, width, depth, static_cast<double>(random() % 2));
  mesh.triangles.pop_back();
  return mesh;
}

TEST(CoplanarTriangles, TurnedAndShearedInstancesAreAsDefined) {
  // These maps keep triangles in their floors.
  const Affine turned = Affine::rotation({0, 0, 1}, 31);
  Affine sheared;
  sheared.y.x = 0.5;

  std::mt19937 random(11);
  std::size_t coplanar = 0;
  // Trees have nodes of eight, so the numbers of triangles are about its powers.
  for (const int count : {1, 3, 7, 8, 9, 63, 65}) {
    Meshes object;
    for (int i = 0; i < count; ++i) object.push_back(randomTriangle(random));

    Builder builder;
    builder.add({randomTriangle(random), tile(1, 1, 2, 3), tile(-2, 0, 2.5, 2, 1)});
    builder.add(object, {Affine{}, turned, sheared, turned * sheared, sheared * turned});
    coplanar += expectAsDefinedAnywhere(std::move(builder));
  }
  EXPECT_GT(coplanar, 500u);
}

// Returns a triangle that is 2 to 4 long and as thin as is told, in any direction of a floor; its
// tip lies anywhere along it.
Mesh needle(std::mt19937& random, double width) {
  const auto below = randomBelow(random);
  const double angle = below(2 * kPi);
  const Vec3d along{std::cos(angle), std::sin(angle), 0}, across{-along.y, along.x, 0};
  const Vec3d tip = along * below(2) + across * width;
  Mesh mesh = rectangle({below(3), below(3), 0}, along * (2 + below(2)), tip);
  mesh.triangles.pop_back();
  return mesh;
}

TEST(CoplanarTriangles, RotatedAndShearedNeedlesAreAsDefined) {
  Affine sheared;
  sheared.y.x = 3;

  std::mt19937 random(19);
  std::size_t coplanar = 0;
  for (const double width : {0.1, 1e-2, 1e-3, 1e-4}) {
    Meshes world{tile(1, 1, 1, 1)}, object;
    for (int i = 0; i < 40; ++i) world.push_back(needle(random, width));
    for (int i = 0; i < 10; ++i) object.push_back(needle(random, width));

    Builder builder;
    builder.add(world);
    builder.add(object, {Affine{}, Affine::rotation({0, 0, 1}, 31), sheared,
                         Affine::rotation({0, 0, 1}, 107) * sheared});
    coplanar += expectAsDefinedAnywhere(std::move(builder));
  }
  EXPECT_GT(coplanar, 300u);
}

TEST(CoplanarTriangles, ManyTilesInOnePlane) {
  constexpr std::uint32_t kTiles = 200, kCorners = kTiles + 1;
  Mesh floor;
  for (std::uint32_t i = 0; i < kCorners * kCorners; ++i) {
    const std::uint32_t x = i % kCorners, y = i / kCorners;
    floor.positions.emplace_back(Vec3d{0.1 * x, 0, 0.1 * y});
    if (x == kTiles || y == kTiles) continue;
    floor.triangles.push_back({i, i + kCorners, i + kCorners + 1});
    floor.triangles.push_back({i, i + kCorners + 1, i + 1});
  }

  Builder builder = world({{floor}});
  EXPECT_TRUE(foundAmong(builder.scene()).empty());

  // One decal lies strictly within a tile. Coplanar are its two triangles, the tile's two, and the
  // 14 around these.
  builder.add({rectangle({10.02, 0, 10.02}, {0.06, 0, 0}, {0, 0, 0.06})});
  const Scene scene = builder.scene();
  const Partners partners = partnersIn(foundAmong(scene), scene);
  EXPECT_EQ(std::ranges::count_if(partners, [](const auto& own) { return !own.empty(); }), 18);
  EXPECT_EQ(textOf(partners), textOf(partnersIn(foundAmong(scene, 1), scene)));
}

}  // namespace
}  // namespace whit
