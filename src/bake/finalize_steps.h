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
// fills in bounds and instancedTriangles. scene.materials and textures must be in place. The order
// of a scene that is too large for the search for coplanar triangles lists no triangles.
SceneOrder bakeGeometry(SceneDescription& description, Scene& scene, Warnings& warnings,
                        Progress* progress);

// Makes materials double-sided whose back faces cannot be seen or must not be passed: those that
// bound a medium, and those that are used by closed surfaces without holes only, as seen from
// outside.
void decideDoubleSided(SceneDescription& description);
// Adds a note for each mesh that is invisible because all cameras are behind its single-sided
// triangles.
void noteHiddenSides(const SceneDescription& description, Warnings& warnings);

// Finds the spheres that coincide in the world, up to rounding. Finds none in scenes of more
// spheres than kMostSearched.
CoincidentSpheres findCoincidentSpheres(const Scene& scene, const SceneOrder& order);

// Gives each dielectric its number. Materials that describe the same one share it, so that leaving
// one of them counts as leaving the other. Throws Error(limit) beyond 255.
void numberMedia(Scene& scene);

// Computes counts and bounds with instances multiplied out, from `boxes`: one a geometry, in its
// own space. Leaves out instances that are so much smaller or flatter than the scene that its rays,
// in their space, would leave the range of coordinates. Throws Error(badScene) for one that is too
// far away.
void boundInstances(Scene& scene, const std::vector<Box>& boxes, Warnings& warnings);

// Counts triangles and spheres with instances multiplied out.
void countInstanced(Scene& scene);

// Returns the effects that the material calls for if a triangle uses it.
EffectSet effectsOf(const Material& material);

// The number of triangles that use each material, instances not multiplied out.
std::vector<std::uint64_t> trianglesOfMaterials(const Scene& scene);

// True if the normal of some corner differs from its triangle's by more than rounding.
bool hasSmoothNormals(const Scene& scene);

// True if the color of some corner is not white.
bool hasVertexColors(const Scene& scene);

}  // namespace whit
