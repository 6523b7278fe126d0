// Changes of a scene that is already baked: its materials, lights, sky and ambient light are
// edited, and it is brought to another time.
#pragma once

#include <vector>

#include "bake/scene.h"

namespace whit {

// Replaces the scene's materials and lights by as many others, item by item. Of a material its
// maps, alpha cutoff and shadow stay what they are, because triangles were sorted by them. Numbers
// the media again and gathers the effects again; geometry is not touched, so that pointers into it
// stay valid. Values are judged as by Scene::finalize(): throws Error(badScene), the scene then
// being what it was; Error(usage) for another number of items. Renderers of the scene have to be
// told (Renderer::shadingChanged) before their next frame.
void editShading(Scene& scene, std::vector<Material> materials, std::vector<Light> lights);

// Exchanges the scene's sky for `sky`, and replaces its ambient light. Judged and told as above.
void editSky(Scene& scene, Sky& sky, const Ambient& ambient);

// Moves instances, cameras and lights and bends meshes, as they are after so many seconds. What the
// scene then is follows from the time alone, not from the times before. Instances that are
// flattened are left out at that time. Geometries keep their places in memory, so that pointers
// into them stay valid. Renderers of the scene have to be told (Renderer::sceneMoved) before their
// next frame. Throws Error(badScene) where something is carried out of the range of coordinates.
// Nothing is done to a scene without motion.
void moveScene(Scene& scene, double seconds);

// In place of its motion, whatever the time: where what has this pointer (Instant::movable) takes
// what it moves. For the next moveScene(). Throws Error(usage) where nothing has that pointer.
void setPlace(Scene& scene, const std::string& pointer, const Affine& place);

// A camera of the scene as it is then, wherever the scene has been moved to.
Camera cameraAt(const Scene& scene, std::size_t camera, double seconds);

}  // namespace whit
