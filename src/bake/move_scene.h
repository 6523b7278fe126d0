// A baked scene at another time.
#pragma once

#include "bake/scene.h"

namespace whit {

// Moves instances, cameras and lights and bends meshes, as they are after so many seconds. What the
// scene then is follows from the time alone, not from the times before. Instances that are
// flattened are left out at that time. Geometries keep their places in memory, so that pointers
// into them stay valid. Renderers of the scene have to be told (Renderer::sceneMoved) before their
// next frame. Throws Error(badScene) where something is carried out of the range of coordinates.
// Nothing is done to a scene without motion. `deformVertices` is the scalar reference or the kernel
// (simd/deform_vertices.h): both give the same bits.
void moveScene(Scene& scene, double seconds, DeformVertices deformVertices);

// In place of its motion, whatever the time: where what has this pointer (Instant::movable) takes
// what it moves. For the next moveScene(). Throws Error(usage) where nothing has that pointer.
void setPlace(Scene& scene, const std::string& pointer, const Affine& place);

// A camera of the scene as it is then, wherever the scene has been moved to.
Camera cameraAt(const Scene& scene, std::size_t camera, double seconds);

}  // namespace whit
