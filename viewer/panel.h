// All that is drawn over the picture: the panel with its tabs, rays, messages. What the user asks
// for there is appended to `said`, in lines of verbs.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "viewer/session/session.h"

namespace whit::view {

inline constexpr float kPanelAlpha = 0.82f;  // how much of the picture windows cover
inline constexpr std::array kPanelTabs{"picture", "rays", "scene", "time"};

// At most one of these is open over the picture.
enum class Over { nothing, panel, cameras, keys };

// WindowState holds what the window shows besides the session's picture.
struct WindowState : KeptSettings {
  Over over = Over::nothing;
  bool words = true;        // anything is written or drawn over the picture
  bool lines = true;        // the rays of the clicked pixel are drawn into the scene
  bool supersample = true;  // at rest; scripts compare pictures without
};

// How the user has changed the scene: the settings, and the scene with them.
struct SceneChange {
  std::vector<std::string> settings;
  EditedScene edited;
};

class Panel {
 public:
  // The panel moves aside if it would cover this place of the window.
  void keepClear(double x, double y) { clear_ = {static_cast<float>(x), static_cast<float>(y)}; }

  // Draws the panel above `bottom`, with the tab shown.tab. `state` must hold a picture.
  SceneChange draw(const ViewState& state, float bottom, WindowState& shown,
                   std::vector<std::string>& said);
  // Returns the ray that the pointer is on in the list, or kNoCounterpart.
  std::size_t pointedAt() const { return pointedAt_; }

 private:
  bool place(float bottom);
  SceneChange drawTab(const ViewState& state, WindowState& shown, std::vector<std::string>& said);

  struct Place {
    float x = 0, y = 0;
  };
  std::optional<Place> clear_;
  float left_ = 0, top_ = 0, width_ = 0, height_ = 0;  // height: at most
  float lowest_ = 1e6f;  // the panel ends above that, because a point there was clicked
  float contents_ = 0;   // height of the tab's contents in the last frame
  std::size_t pointedAt_ = kNoCounterpart;
  Selection unfolds_;  // what the scene's tab unfolds when it is drawn
  int selections_ = 0;
};

// The functions below draw between ImGui's NewFrame and Render; those of controls.cpp, drawScene()
// and drawRayTree() also between its Begin and End.

// panel.cpp: draws words in lines that fit.
void drawText(const std::string& text);

// controls.cpp: presets, options, effects and the choice of view.
void drawOptions(const ViewState& state, std::vector<std::string>& said);
// Lists the costs that exceed the noise, the largest first.
void drawMeasured(const std::vector<KnobCost>& costs);

// scene_panel.cpp: draws lights, materials, sky and ambient light as controls, and unfolds what was
// picked; `ownSky` is the scene's. Returns the settings by which the user has edited the scene.
std::vector<std::string> drawScene(const Sky& ownSky, Selection& unfolds, EditedScene& scene);

// ray_panel.cpp: the rays of a picked pixel, or how to pick one; returns the ray that is pointed
// at. And as lines behind the panels, as this camera sees them.
std::size_t drawRayTree(const ViewState& state, bool& lines, std::vector<std::string>& said);
void drawRayLines(const RayPick& pick, const Camera& camera, std::size_t pointedAt);

// overlay.cpp: all else that is drawn over the picture.
// Pixels beside windows and labels; they follow the scale of the display.
float margin();
// These three draw above `bottom` and return
// the top of what they drew.
// A bar to play and to choose the time, if the scene moves.
float drawTimeline(const Timeline& timeline, float bottom, std::vector<std::string>& said);
float drawMessage(const std::string& message, float bottom);
float drawError(const std::string& error, float bottom, std::vector<std::string>& said);
// The sharpness of the picture, the frame rate and the meaning of a view's colors, at the right.
float drawStatus(const ViewState& state, float bottom);
// The scenes to choose from: those that were open lately, and the shipped ones.
void drawScenes(const std::vector<std::string>& recent, std::vector<std::string>& said);
// The list of the scene's cameras.
void drawCameras(const ViewState& state, std::vector<std::string>& said);
// The list of keys.
void drawKeys(float bottom);
// Describes that pixel of a debug view in a window of this size, in lines with units. Empty beside
// the picture, and for others.
std::string inspect(const TracedFrame& frame, const ImageSize& window,
                    const std::array<int, 2>& pixel);
// Draws such lines beside the pointer, inside the window.
void drawInspection(const std::string& lines, double pointerX, double pointerY);

}  // namespace whit::view
