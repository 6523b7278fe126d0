// Edits materials, lights, sky and ambient light of a scene that is already baked.
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

}  // namespace whit
