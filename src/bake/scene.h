// The scene as renderers read it: validated, baked and frozen. After Scene::finalize() nothing
// about the scene can fail.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bake/coplanar_triangles.h"
#include "core/effects.h"
#include "core/huge_vector.h"
#include "core/progress.h"
#include "core/vec3.h"
#include "core/warnings.h"
#include "scene/description.h"

namespace whit {

// Triangles of one class lie together and become one Embree geometry, whose id is the class: bit 0
// set when they cast no shadow, bit 1 set when hits on them are filtered: an alpha mask cuts them,
// or they are seen from one side only.
inline constexpr int kTriangleClasses = 4;
inline constexpr std::uint32_t kNoShadowBit = 1, kMaskedBit = 2;

// Shading data of a triangle, one cache line: corners, texture coordinates, material.
struct alignas(64) TriangleRecord {
  float position[9];
  float uv[6];
  std::uint32_t material;
};
static_assert(sizeof(TriangleRecord) == 64);

// One normal for each corner; all three are the face's where the mesh has none. They have unit
// length unless a transform has stretched the model: then they keep the relative lengths that the
// transform gives them, the longest about 1, so that interpolating and transforming commute.
struct NormalRecord {
  float normal[9];
};
// True if a normal whose length has this square is no unit vector, beyond the rounding of its
// components.
inline constexpr double kStretchedNormal = 1e-6;
inline bool isStretched(double square) { return std::abs(square - 1) > kStretchedNormal; }

struct UvRecord {
  float uv[6];  // as in TriangleRecord
};

struct ColorRecord {
  float color[9];  // linear RGB, one a corner
};

// One object's triangles as Embree wants them. `index` refers to `position`; triangles are sorted
// by class (stable), class c occupying [classBegin[c], classBegin[c + 1]). The triangle i of a
// geometry is number firstTriangle + i in Scene::triangles. `position` has the capacity for one
// more element than it holds, because Embree reads 16 bytes at every vertex.
struct Geometry {
  std::vector<Vec3f> position;
  std::vector<std::array<std::uint32_t, 3>> index;
  std::array<std::uint32_t, kTriangleClasses + 1> classBegin{};
  std::uint32_t firstTriangle = 0;
  std::uint32_t firstSphere = 0, spheres = 0;  // spheres are in Scene::triangles, too
};

// A dielectric that some triangle bounds. Number 0 is the vacuum around everything (ior 1).
struct Medium {
  float ior = 1;
  Rgb absorption{0, 0, 0};
  int priority = 0;
  bool operator==(const Medium&) const = default;
};

struct InstanceRecord {
  std::uint32_t geometry = 0;  // index into Scene::geometries, never 0
  std::uint32_t written = 0;   // index into SceneDescription::instances
  Affine toWorld;
  std::uint32_t mover = kNoNode;  // node of the scene's rig that moves it
  Affine toMover;
  std::uint32_t firstItem = 0;
};

// The largest coordinate with which a ray may start (its direction's length at most 1) so that in
// the instance's own space it stays within kLargestCoordinate, beyond which Embree takes no rays;
// 0 where the inverse of the map has no floats. Embree inverts it as adjoint over determinant, in
// single precision.
float instanceReach(const Affine& toWorld);

// The vertices of a baked geometry that a mesh bends, from `firstVertex` on.
struct BentVertices {
  std::uint32_t geometry = 0, firstVertex = 0;
  std::shared_ptr<const Deformation> deformation;
  // DeformedVertices::sides by which the triangles are turned now; empty: those of the start.
  std::vector<double> sides = {};
};

// Input of moveScene().
struct BakedMotion {
  SceneMotion given;
  // Instances move, meshes bend, or cameras may go to where instances are too small to be traced.
  // If not, only cameras and lights move, and all below is empty.
  bool ofGeometry = false;
  std::vector<InstanceRecord> instances;  // all of them, also those that are flattened at times
  std::vector<Box> boxes;                 // bounds of geometries, each in its own space
  std::vector<BentVertices> bent;
  SceneOrder order;
  // These keep the coplanar triangles of 0 s, and the instances that are not flattened then.
  bool isSearched = false;
  CoplanarTriangles coplanarAtStart;
  std::vector<InstanceRecord> instancesAtStart;

  bool ofLights() const { return !given.lights.empty(); }
  bool empty() const { return !ofGeometry && !ofLights() && given.cameras.empty(); }
};

// Numbers for people of what a scene holds: its items, as its author placed them, and the triangles
// of each. Scene::triangles has them in another order and without those that were left out.
class ItemNumbers {
 public:
  // Triangles that follow each other in Scene::triangles, in their item and in its numbers.
  struct Run {
    std::uint32_t first = 0;   // index in Scene::triangles
    std::uint32_t item = 0;    // instanced ones count from InstanceRecord::firstItem
    std::uint32_t number = 0;  // number of the first triangle in the item
  };

  // In the order of Scene::triangles.
  void add(std::uint32_t triangle, std::uint32_t item, std::uint32_t number) {
    // Nothing is added for a triangle that continues the last run.
    if (!runs_.empty()) {
      const Run& last = runs_.back();
      if (last.item == item && number - last.number == triangle - last.first) return;
    }
    runs_.push_back({triangle, item, number});
  }
  // The item of a triangle (or sphere), and its number there.
  Run find(std::uint32_t triangle) const;
  std::uint64_t bytes() const { return runs_.size() * sizeof(Run); }

  // Names of the items 0, 1, ...: at most kNamedItems.
  std::vector<std::string> names;
  std::uint64_t count = 0;  // number of items

 private:
  std::vector<Run> runs_;
};

struct EffectReason {
  bool on = false;
  std::string because;  // "3 materials have a mirror", "no mesh uses a material that light passes"
};

// The members of a scene that are made of its geometry, materials and sky.
struct SceneTables {
  EnvironmentImage blurredSky;                 // blurredSky(sky), where some frame reflects it
  std::vector<std::uint8_t> mediumOfMaterial;  // 0 where the material bounds none
  std::vector<Medium> media;                   // [0] is vacuum

  // Geometry 0 is the world (may be empty), the others are instanced.
  std::vector<Geometry> geometries;
  std::vector<InstanceRecord> instances;
  // Triangles of all geometries, one after the other; from firstSphere on they are spheres
  // (bake/sphere.h), in the same order.
  HugeVector<TriangleRecord> triangles;
  std::uint32_t firstSphere = 0;
  // Same length, or empty when no mesh has normals other than its triangles'.
  HugeVector<NormalRecord> normals;
  HugeVector<ColorRecord> colors;  // same length, or empty when every vertex is white
  // Same length, or empty when no map is looked up with second texture coordinates.
  HugeVector<UvRecord> secondUvs;

  // Bounds of everything, instances (each by its object's box) included; zero without triangles.
  Vec3f lower, upper;
  // Counts with instances multiplied out.
  std::uint64_t instancedTriangles = 0, instancedSpheres = 0;

  ItemNumbers items;
  CoplanarTriangles coplanar;  // triangles that overlap others in their plane
  CoincidentSpheres coincidentSpheres;
  BakedMotion motion;  // see bake/edit_scene.h

  EffectSet effects;
  std::array<EffectReason, kEffectCount> reasons;
};

// Has at least one camera.
class Scene : public SceneContents, public SceneTables {
 public:
  // Validates and bakes. Non-finite or enormous vertices (beyond Embree's 1.844e18), out-of-range
  // indices and degenerate triangles are dropped and counted in `warnings`. Throws Error(badScene)
  // where nothing sensible remains, Error(limit) beyond 2^32 - 1 triangles or 255 media.
  static Scene finalize(SceneDescription&& description, Warnings& warnings,
                        Progress* progress = nullptr);

  // The number of the item that a triangle (or sphere) belongs to where it stands, `instance` being
  // kNoInstance in the world; and its own among that item's triangles. What is beyond 2^32 - 2 has
  // that number.
  struct HitNumbers {
    std::uint32_t item = 0, triangle = 0;
  };
  HitNumbers numbersOf(std::uint32_t triangle, std::uint32_t instance) const;

  bool isSphere(std::uint32_t number) const { return number >= firstSphere; }

  // The three corners' texture coordinates for a map that is looked up with the first or second.
  const float* uvsOf(std::uint32_t triangle, bool second) const {
    return second && !secondUvs.empty() ? secondUvs[triangle].uv : triangles[triangle].uv;
  }

  // Bytes held by geometry and by textures (without Embree's).
  std::uint64_t memoryBytes() const;
};

// Fills effects and reasons from what the geometry really uses.
void gatherEffects(Scene& scene);

}  // namespace whit
