// Materials and lights of the scene, to be changed while it is being looked at.
#pragma once

#include <vector>

#include "scene/light.h"
#include "scene/material.h"

namespace whit::view {

// Between ImGui's Begin and End. Each returns whether something was changed.
bool drawLights(std::vector<Light>& lights);
bool drawMaterials(std::vector<Material>& materials);

}  // namespace whit::view
