// Builds scenes of a few polygons for the hard cases and for tests.
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "bake/scene.h"
#include "core/index.h"
#include "core/vec3.h"
#include "pi.h"

namespace whit::verify {

// Materials without any effect but the named one.
inline Material blackMaterial() {
  Material m;
  m.diffuse = Rgb(0.0f);
  return m;
}
inline Material diffuseMaterial(float albedo) {
  Material m = blackMaterial();
  m.diffuse = Rgb(albedo);
  return m;
}
inline Material mirrorMaterial(float reflectance) {
  Material m = blackMaterial();
  m.mirror = m.mirrorGrazing = Rgb(reflectance);
  return m;
}
inline Material shinyMaterial() {
  Material m = mirrorMaterial(1);
  m.diffuse = Rgb(1.0f);
  return m;
}
inline Material emittingMaterial(float radiance) {
  Material m = blackMaterial();
  m.emission = Rgb(radiance);
  return m;
}
inline Material glassMaterial(float ior, int priority = 0) {
  Material m = blackMaterial();
  m.transmission = Rgb(1.0f);
  m.ior = ior;
  m.priority = priority;
  return m;
}

inline Texture makeTexture(TexelFormat format, int width, int height,
                           std::vector<std::uint32_t> texels) {
  Texture t;
  t.format = format;
  t.width = width;
  t.height = height;
  t.texels = std::move(texels);
  return t;
}

inline Light lightAt(const Vec3f& position, float intensity) {
  Light light;
  light.position = position;
  light.intensity = Rgb(intensity);
  return light;
}

class SceneBuilder {
 public:
  SceneDescription description;

  std::uint32_t add(const Material& material) {
    description.materials.push_back(material);
    return size32(description.materials) - 1;
  }
  std::int32_t add(Texture texture) {
    description.textures.push_back(std::move(texture));
    return static_cast<std::int32_t>(description.textures.size() - 1);
  }
  // Adds a mesh to the world, without a transform.
  void add(Mesh mesh) { world_.meshes.push_back(std::move(mesh)); }
  // The same, all of a new material.
  void add(Mesh mesh, const Material& material) {
    mesh.materials = {add(material)};
    add(std::move(mesh));
  }
  void sky(float radiance) {
    description.sky.kind = Sky::Kind::color;
    description.sky.zenith = Rgb(radiance);
  }
  // Sets the only camera. The reference ends with the next call.
  Camera& lookFrom(const Vec3f& eye, const Vec3f& at = {}) {
    description.cameras.resize(1);
    description.cameras[0].eye = eye;
    description.cameras[0].at = at;
    return description.cameras[0];
  }
  // Two or more placements make instances.
  void place(Object object, const std::vector<Affine>& placements) {
    const std::uint32_t number = size32(description.objects);
    description.objects.push_back(std::move(object));
    for (const Affine& placement : placements) description.instances.push_back({number, placement});
  }

  // Returns the description and leaves the builder empty.
  SceneDescription describe() {
    if (description.materials.empty()) add(blackMaterial());
    place(std::move(world_), {Affine{}});
    return std::move(description);
  }
  Scene build() {
    Warnings strict(true);
    return Scene::finalize(describe(), strict);
  }

 private:
  Object world_;
};

// Makes the scene like a loaded one: repairs and counts bad data.
inline Scene repaired(SceneDescription description, Warnings* warnings = nullptr) {
  Warnings own;
  return Scene::finalize(std::move(description), warnings ? *warnings : own);
}

// The corners are counter-clockwise from outside; uv covers the unit square from the first corner.
inline Mesh quad(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d,
                 std::uint32_t material = 0) {
  Mesh mesh;
  mesh.positions = {a, b, c, d};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {material};
  return mesh;
}
// A horizontal square at height y, 2 * half wide; its outside is up.
inline Mesh floorAt(float y, float half, std::uint32_t material = 0) {
  return quad({-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half}, material);
}
// The same square with its outside down.
inline Mesh ceilingAt(float y, float half, std::uint32_t material = 0) {
  return quad({-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}, material);
}
// Appends a triangle that shares no corner with others.
inline void addTriangle(Mesh& mesh, const Vec3f (&corners)[3]) {
  const std::uint32_t first = size32(mesh.positions);
  mesh.positions.insert(mesh.positions.end(), std::begin(corners), std::end(corners));
  mesh.triangles.push_back({first, first + 1, first + 2});
}
// A sheet of columns times rows corners, of which at(x, y) is one, with two triangles in each cell.
template <typename At>
Mesh sheetOf(std::uint32_t columns, std::uint32_t rows, const At& at) {
  Mesh mesh;
  mesh.materials = {0};
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    const std::uint32_t x = i % columns, y = i / columns, below = i + columns;
    mesh.positions.push_back(at(x, y));
    if (x + 1 == columns || y + 1 == rows) continue;
    mesh.triangles.push_back({i, below, below + 1});
    mesh.triangles.push_back({i, below + 1, i + 1});
  }
  return mesh;
}
// Two faces with the medium in between. Large faces are as good as infinite, but the coordinates of
// their corners make offsets large.
inline void addSlab(SceneBuilder& builder, float top, float bottom, std::uint32_t material,
                    float half = 1000) {
  builder.add(floorAt(top, half, material));
  builder.add(ceilingAt(bottom, half, material));
}
inline void addSlab(SceneBuilder& builder, float top, float bottom, const Material& material,
                    float half = 1000) {
  addSlab(builder, top, bottom, builder.add(material), half);
}
// An axis-aligned box with eight shared corners and no texture coordinates; its outside is
// outwards.
inline Mesh box(const Vec3f& low, const Vec3f& high, std::uint32_t material = 0) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back(Box{low, high}.corner(i));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.materials = {material};
  return mesh;
}

// The sphere of radius 1 about the origin, or the ellipsoid that `map` makes of it.
inline Mesh exactSphere(std::uint32_t material = 0, const Affine& map = {}) {
  Mesh mesh;
  mesh.spheres = {map};
  mesh.materials = {material};
  return mesh;
}

// The mesh of one material, under a sky of this radiance if it is not black.
inline Scene sceneOf(Mesh mesh, const Material& material, float radiance = 0) {
  SceneBuilder builder;
  builder.add(std::move(mesh), material);
  if (radiance > 0) builder.sky(radiance);
  return builder.build();
}

// Camera that looks down from 3 above the origin.
inline Camera lookingDown() { return {.eye = {0, 3, 0}, .up = {0, 0, -1}, .fov = 50}; }

// A fixed sequence of numbers, the same on every machine.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : engine_(seed) {}
  // A number in [low, high).
  double in(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) / 9007199254740992.0);
  }
  // A point of the cube that reaches from -half to half.
  Vec3d inCube(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }
  // A unit vector, uniform on the sphere.
  Vec3d direction() {
    const double z = in(-1, 1), angle = in(0, 2 * kPi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace whit::verify
