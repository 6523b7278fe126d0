// All that is drawn over the picture: the panel with its tabs, rays, messages.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "viewer/session/session.h"

namespace whit::view {

inline constexpr std::array kPanelTabs{"frame", "picture", "knobs", "effects",
                                       "rays",  "scene",   "keys"};

inline constexpr float kPanelAlpha = 0.82f;  // how much of the picture panels cover

class Panel {
 public:
  // `frame` must hold a picture, and `ownSky` is the scene's. Returns the settings by which the
  // user has edited the scene.
  std::vector<std::string> draw(const TracedFrame& frame, const RayPick& pick,
                                const std::vector<KnobCost>& costs, PanelSettings& settings,
                                const Sky& ownSky, EditedScene& scene);

 private:
  float left_ = 0, width_ = 0;  // of the panel in the last frame
};

// The functions below draw between ImGui's NewFrame and Render; those of knobs.cpp, drawSceneTab()
// and drawRayTree() also between its Begin and End.

// knobs.cpp: the options of a render as sliders, boxes and lists.
// Draws the options that the table of options has in that tab, and presets before those of the
// knobs.
void drawOptions(Tab tab, RenderOptions& options, const std::vector<KnobCost>& costs);
// Draws the cost of that knob or effect beside its control, if it exceeds the noise.
void drawCost(const std::vector<KnobCost>& costs, const std::string& name);
// Lists the costs that exceed the noise, the largest first.
void drawMeasured(const std::vector<KnobCost>& costs);

// scene_panel.cpp: draws lights, materials, sky and ambient light as controls, and unfolds what was
// picked; `ownSky` is the scene's. Returns the settings by which the user has edited the scene.
std::vector<std::string> drawSceneTab(const Sky& ownSky, RayView& picked, EditedScene& scene);

// ray_panel.cpp: the rays of a picked pixel, or how to pick one; and as lines behind the panels, as
// this camera sees them.
void drawRayTree(const RayPick& pick, const TracedFrame& frame, RayView& view);
void drawRayLines(const RayPick& pick, const Camera& camera, const RayView& view);

// overlay.cpp: all else that is drawn over the picture.
// Draws a bar at the bottom of the window if the scene moves. Returns whether something was
// changed.
bool drawTimeline(Timeline& timeline);
// Draws the list of the scene's cameras, of which `current` is shown. Returns the number of the one
// that was chosen.
std::optional<std::size_t> drawCameras(const std::vector<Camera>& cameras,
                                       std::optional<std::size_t> current);
// Describes that pixel of a debug view in a window of this size, in lines with units. Empty beside
// the picture, and for others.
std::string inspect(const TracedFrame& frame, const ImageSize& window,
                    const std::array<int, 2>& pixel);
// Draws such lines beside the pointer, inside the window.
void drawInspection(const std::string& lines, double pointerX, double pointerY);
// Draws the sharpness of the picture, the frame rate and the meaning of a view's colors into a
// corner of the window; `raised`: a line higher, above a message.
void drawStatus(const TracedFrame& frame, const UnfinishedFrame* next, double rate, bool raised);
// Draws a line at the bottom of the window.
void drawMessage(const std::string& message);
// Draws an error, which stays until it is clicked away; returns false then.
bool drawError(const std::string& error);

// app_keys.cpp: the keys, and what they do.
struct KeyHelp {
  const char* keys;
  const char* text;
};
std::span<const KeyHelp> keyHelp();

}  // namespace whit::view
