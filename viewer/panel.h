// The panel over the picture, with its tabs. What the user asks for there is appended to `said`, in
// lines of verbs.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "viewer/session/session.h"

namespace whit::view {

inline constexpr float kPanelAlpha = 0.82f;  // opacity of windows over the picture
inline constexpr std::array kPanelTabs{"picture", "rays", "scene", "time"};

// At most one of these is open over the picture.
enum class Over { nothing, panel, cameras, keys };

// WindowState holds what the window shows besides the session's picture.
struct WindowState : KeptSettings {
  Over over = Over::nothing;
  bool words = true;  // texts and the time bar are shown over the picture
  bool lines = true;  // the rays of the clicked pixel are drawn into the scene
  // Pictures at rest get more samples than asked for. Scripts that compare pictures turn it off.
  bool supersample = true;
};

// How the user has changed the scene: the settings, and the scene with them.
struct SceneChange {
  std::vector<std::string> settings;
  EditedScene edited;
};

// Pixels beside windows and labels; they follow the scale of the display.
float margin();
// Draws words in lines that fit.
void drawText(const std::string& text);

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
  float left_ = 0, top_ = 0, width_ = 0;
  float height_ = 0;     // largest height that has room
  float lowest_ = 1e6f;  // the panel ends above this height, to leave a clicked point free
  float contents_ = 0;   // height of the tab's contents in the last frame
  std::size_t pointedAt_ = kNoCounterpart;
  Selection unfolds_;  // what the scene's tab unfolds when it is drawn
  int selections_ = 0;
};

}  // namespace whit::view
