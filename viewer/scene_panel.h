// The tab of the scene: lights, materials, sky and ambient light as controls.
#pragma once

#include <string>
#include <vector>

#include "viewer/session/scene_edit.h"
#include "viewer/session/view_state.h"

namespace whit::view {

// Draws the tab between Begin and End of Dear ImGui, and unfolds what was picked; `ownSky` is the
// scene's. Returns the settings by which the user has edited the scene.
std::vector<std::string> drawScene(const Sky& ownSky, Selection& unfolds, EditedScene& scene);

}  // namespace whit::view
