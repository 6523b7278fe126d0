// The steps of Scene::finalize(), in this order. Internal to it.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/scene.h"
#include "core/vec3.h"

namespace whit {

// Throws Error(badScene), naming the thing at fault, for numbers of lights, materials, sky, ambient
// light and transforms that cannot be rendered. The readers answer for everything else: sizes of
// tables, indices, texels and cameras.
void validate(const SceneDescription& description);
void validate(const std::string& scene, const Sky& sky, const Ambient& ambient);

// Moves the meshes of `description` into scene.geometries, instances, triangles and normals, and
// fills in bounds and instancedTriangles. scene.materials and textures must be in place. Of scenes
// that are not searched for coplanar triangles the order comes back empty.
SceneOrder bakeGeometry(SceneDescription& description, Scene& scene, Warnings& warnings,
                        Progress* progress);

// Makes materials double-sided whose back faces nobody can pass or see: of what transmits light,
// and of closed surfaces without holes alone, as seen from outside.
void settleSides(SceneDescription& description);
// Notes the meshes that are not seen because all cameras are behind their single-sided triangles.
void noteHiddenSides(const SceneDescription& description, Warnings& warnings);

// Finds the spheres that are coincident in the world, up to rounding. None in scenes of more
// spheres than kMostSearched.
CoincidentSpheres findCoincidentSpheres(const Scene& scene, const SceneOrder& order);

// Gives each dielectric its number. Materials that describe the same one share it, so that leaving
// one of them counts as leaving the other. Throws Error(limit) beyond 255.
void numberMedia(Scene& scene);

// Counts and bounds as seen, from `boxes`: one a geometry, in its own space. Leaves out instances
// that are so much smaller or flatter than the scene that its rays, in their space, would leave the
// range of coordinates. Throws Error(badScene) for one that is too far away.
void boundInstances(Scene& scene, const std::vector<Box>& boxes, Warnings& warnings);

// Counts triangles and spheres as seen.
void countInstanced(Scene& scene);

// Effects that the material calls for where a triangle uses it.
EffectSet effectsOf(const Material& material);

// The number of triangles that use each material, instances not multiplied out.
std::vector<std::uint64_t> trianglesOfMaterials(const Scene& scene);

// True if the normal of some corner differs from its triangle's by more than rounding.
bool hasSmoothNormals(const Scene& scene);

// True if the color of some corner is not white.
bool hasVertexColors(const Scene& scene);

}  // namespace whit
