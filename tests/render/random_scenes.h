// Random scenes of the most difficult triangles, for tests of hits and shadows.
#pragma once

#include <cmath>
#include <random>
#include <utility>

#include "bake/scene.h"
#include "render/data_map.h"

namespace whit::test {

struct Soup {
  verify::SceneBuilder builder;
  Mesh mesh;
  std::mt19937 random;

  explicit Soup(unsigned seed) : random(seed) { mesh.materials = {builder.add(Material())}; }

  float uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  }

  Vec3f inside(float size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }

  void add(const Vec3f& a, const Vec3f& b, const Vec3f& c) { verify::addTriangle(mesh, {a, b, c}); }

  void addSquare(const Vec3f& corner, const Vec3f& x, const Vec3f& y) {
    add(corner, corner + x, corner + x + y);
    add(corner, corner + x + y, corner + y);
  }

  void addFloor(float height, float size) {
    addSquare({-size, height, -size}, {0, 0, 2 * size}, {2 * size, 0, 0});
  }

  void light(const Vec3f& at, bool directional = false) {
    Light light = verify::lightAt(at, 1);
    light.direction = -at;
    if (directional) light.kind = Light::Kind::directional;
    builder.description.lights.push_back(light);
  }

  Scene finish(const Vec3f& eye, const Vec3f& at, const Vec3f& moved = {}) {
    for (Vec3f& p : mesh.positions) p += moved;
    for (Light& l : builder.description.lights) l.position += moved;
    builder.add(std::move(mesh));
    builder.lookFrom(eye + moved, at + moved);
    return verify::repaired(builder.describe());
  }
};

inline constexpr unsigned kRandomKinds = 10;

// Makes a scene of one of ten kinds: clutter, needles that point at the light, dust, masks,
// coplanar sheets, far from the origin, planes through the light, few triangles, stacks of sheets,
// huge triangles with small casters.
inline Scene randomScene(unsigned kind, unsigned seed) {
  Soup soup(1000 * kind + seed);
  const Vec3f light = soup.inside(1.5f) + Vec3f{0, 3, 0};
  const auto triangle = [&](const Vec3f& a, float size) {
    soup.add(a, a + soup.inside(size), a + soup.inside(size));
  };
  const auto above = [&] { return soup.inside(2) + Vec3f{0, 2.1f, 0}; };

  // All kinds but one have a floor.
  if (kind != 7) soup.addFloor(0, 3);

  // Kind 0: clutter.
  for (int i = 0; kind == 0 && i < 40; ++i) triangle(above(), 1);

  // Kind 1: needles point at the light.
  for (int i = 0; kind == 1 && i < 30; ++i) {
    const Vec3f a = above(), thin = soup.inside(std::exp2(soup.uniform(-20, -4)));
    soup.add(a, a + (light - a) * soup.uniform(0.1f, 0.9f), a + thin);
  }

  // Kind 2: dust.
  for (int i = 0; kind == 2 && i < 300; ++i) triangle(above(), std::exp2(soup.uniform(-12, -6)));

  // Kind 3: one half of the triangles has masks with holes.
  if (kind == 3) {
    soup.builder.description.materials[0].alphaMap = soup.builder.add(dataMap(2, {1, 0}));

    for (int i = 0; i < 30; ++i) triangle(above(), 1);
    for (const auto i : indices(soup.mesh.positions)) {
      soup.mesh.uvs.push_back({i < 6 ? 0.25f : soup.uniform(0, 1), 0.5f});
    }
  }

  // Kinds 4 and 8: coplanar sheets, and stacks of sheets.
  for (int i = 0; (kind == 4 || kind == 8) && i < 20; ++i) {
    const float height = kind == 4 ? 1 : 1 + static_cast<float>(i) * 0x1p-20f;
    soup.addSquare({soup.uniform(-2, 1), height, soup.uniform(-2, 1)}, {0, 0, 1}, {1, 0, 0});
  }

  // Kind 5: clutter, which is moved far from the origin below.
  for (int i = 0; kind == 5 && i < 30; ++i) triangle(above(), 1);

  // Kind 6: planes through the light.
  for (int i = 0; kind == 6 && i < 30; ++i) {
    const Vec3f a = above(), b = a + soup.inside(1);
    soup.add(a, b, a + (light - b) * soup.uniform(-0.4f, 0.4f) + (b - a) * soup.uniform(0, 1));
  }

  // Kind 7: few triangles.
  for (unsigned i = 0; kind == 7 && i < 2 + seed % 8; ++i) triangle(soup.inside(2), 4);

  // Kind 9: a huge tilted ground and small casters.
  if (kind == 9) {
    for (int i = 0; i < 3; ++i) {
      const float size = std::pow(10.0f, soup.uniform(1, 4));
      triangle(soup.inside(size / 2), size);
    }
    for (int i = 0; i < 20; ++i) triangle(above(), std::exp2(soup.uniform(-6, 0)));
  }

  soup.light(light);
  if (seed % 3 == 0) soup.light(normalized(soup.inside(1) + Vec3f{0, 1.2f, 0}), true);
  return soup.finish({2, 4, 3}, {0, 0.5f, 0}, kind == 5 ? Vec3f{1e5f, -1e5f, 3e4f} : Vec3f{});
}

}  // namespace whit::test
