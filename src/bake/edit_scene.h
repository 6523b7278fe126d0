// Changes to a scene that is already baked: edits of its materials, lights, sky and ambient light,
// and motion to another time.
#pragma once

#include <vector>

#include "bake/scene.h"

namespace whit {

// Replaces the scene's materials and lights by as many others, item by item. Materials keep their
// alpha cutoff and shadow, because triangles were sorted by them, and their maps, except that maps
// of roughness, mirror and transmission can be left out. Numbers the media and
// gathers the effects again; geometry is not touched, so that pointers into it stay valid. Values
// are validated as by Scene::finalize(): throws Error(badScene), and the scene is then unchanged;
// throws Error(usage) for another number of items. The caller has to notify renderers of the scene
// (Renderer::shadingChanged) before their next frame.
void editShading(Scene& scene, std::vector<Material> materials, std::vector<Light> lights);

// Exchanges the scene's sky for `sky`, and replaces its ambient light. Values are validated and
// renderers notified as above.
void editSky(Scene& scene, Sky& sky, const Ambient& ambient);

// Moves instances, cameras and lights and deforms meshes to their state at `seconds`. The result
// depends on the time alone, not on earlier times. Instances that are flattened at that time are
// left out. Geometries keep their places in memory, so that pointers into them stay valid. The
// caller has to notify renderers of the scene (Renderer::sceneMoved) before their next frame.
// Throws Error(badScene) if something is carried out of the range of coordinates. A scene without
// motion stays unchanged.
void moveScene(Scene& scene, double seconds);

// Replaces the motion of the object with this pointer (Instant::movable) by a fixed transform,
// which takes effect at the next moveScene(). Throws Error(usage) if no object has that pointer.
void setPlace(Scene& scene, const std::string& pointer, const Affine& place);

// Returns a camera of the scene at the given time, independently of the time that the scene has
// been moved to.
Camera cameraAt(const Scene& scene, std::size_t camera, double seconds);

}  // namespace whit
