// Triangles and spheres as they are loaded or generated, before Scene::finalize() bakes them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/affine.h"
#include "core/vec3.h"
#include "scene/motion.h"

namespace whit {

struct Mesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;    // empty (flat shading), or one a position
  std::vector<Vec2f> uvs;        // empty (0, 0), or one a position; v points up
  std::vector<Vec2f> secondUvs;  // likewise, for what the members of a Material say
  std::vector<Rgb> colors;       // empty (white), or one a position; linear, 0 to 1
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  // Maps from the unit sphere (bake/sphere.h). Spheres have the first material.
  std::vector<Affine> spheres;
  // One index into SceneDescription::materials a triangle, or a single one for all.
  std::vector<std::uint32_t> materials;
  Affine fromModel;             // what transform() has applied so far
  bool hasFlatFaces = false;    // some faces have no normals: those of their corners are zero
  bool hasMadeNormals = false;  // the file has no normals: they follow from the faces
  // Not none: it bends while the scene moves, and has the vertices of its start here.
  std::shared_ptr<const Deformation> deformation;

  // Position in the order of the scene, counted from Instance::rank.
  std::uint64_t rank = 0;
  // Item of the scene that the mesh is part of, counted from Instance::firstItem. Meshes of one
  // item follow each other.
  std::uint32_t item = 0;

  std::uint32_t material(std::size_t triangle) const {
    return materials.size() == 1 ? materials[0] : materials[triangle];
  }
};

// Meshes that move together. An object that is used once, stands still and does not bend is baked
// into the world; all others are kept once and instanced.
struct Object {
  std::string name;
  std::vector<Mesh> meshes;
};

// Rays hit the last of coincident opaque faces in the order of the scene: by the sum of this rank
// and the mesh's, then in the order of the instances, of the object's meshes, and of the
// triangles.
struct Instance {
  std::uint32_t object = 0;
  Affine toWorld;  // where something carries it: to the space of that
  std::uint64_t rank = 0;
  std::uint32_t mover = kNoNode;  // what carries it, a node of SceneMotion::rig
  std::uint64_t firstItem = 0;    // see SceneDescription::items
};

// Applies `map` to positions, normals (rounded once) and spheres, and reverses the winding if the
// map mirrors. Normals become unit vectors, or zero where they have no direction. The identity
// leaves positions alone. The lengths that a stretching map gives to normals follow from
// Mesh::fromModel (makeNormalRecord).
void transform(Mesh& mesh, const Affine& map);

}  // namespace whit
