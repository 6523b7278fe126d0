// The panel over the picture: times and rays of the frame, options, effects, the scene, the keys.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "viewer/ray_panel.h"
#include "viewer/timeline.h"

namespace whit::view {

inline constexpr std::array kPanelTabs{"frame", "picture", "knobs", "effects",
                                       "rays",  "scene",   "keys"};

// The settings that the panel and the keys change.
struct PanelSettings {
  bool shown = true;
  bool narrow = false;      // the window is narrow, and the panel was folded for it
  std::string tabShown;     // of kPanelTabs
  std::string tab;          // the tab of kPanelTabs to turn to; empty: it stays
  double rate = 60;         // frames a second to hold
  bool supersample = true;  // at rest
  RenderOptions options;
  DebugView view = DebugView::none;
  CompareMode compare = CompareMode::off;
  bool measureKnobs = false;  // true until the measurement is done
  RayView rays;
  Timeline timeline;
  bool inspects = true;    // the pixel under the pointer is described
  bool saveScene = false;  // the scene is to be saved
};

// A graph of the times of the last frames in motion.
class FrameGraph {
 public:
  void add(double ms);
  // Draws the newest frame at the right, and a line at the time that a frame may take to hold
  // `rate` frames a second. Call between ImGui's Begin and End.
  void draw(double rate) const;

 private:
  std::array<float, 120> times_{};  // milliseconds, a ring
  std::size_t next_ = 0, count_ = 0;
};

// Returns whether nothing but options differs from the view that was measured.
bool isMeasuredView(FrameRequest measured, const FrameRequest& request);

class Panel {
 public:
  void remember(const TracedFrame& frame);
  void remember(const UnfinishedFrame& frame);
  // Call between ImGui's NewFrame and Render; `frame` must hold a picture. Returns whether the
  // scene was edited.
  bool draw(const TracedFrame& frame, const RayPick& pick, double speed, PanelSettings& settings,
            const SkyChoice& ownSky, ShadingEdit& scene) const;

 private:
  void drawTimes(const TracedFrame& frame) const;
  bool drawTabs(const TracedFrame& frame, const RayPick& pick, PanelSettings& settings,
                const SkyChoice& ownSky, ShadingEdit& scene) const;

  std::vector<KnobCost> costs_;  // costs measured so far at the view of the last frame
  FrameRequest measuredFor_;
  double measured_ = 0;  // share of the knobs that are measured
  std::string sofar_;    // samples so far of a picture that gains samples
  FrameGraph graph_;
};

// knobs.cpp, the options of a render as sliders, boxes and lists. All of it belongs between ImGui's
// Begin and End.
// Draws presets, then every option that the table of options has in the tab of knobs.
void drawKnobs(RenderOptions& options, const std::vector<KnobCost>& costs);
// Draws the options that the table has in the picture's tab: exposure and tone curve.
void drawDisplay(RenderOptions& options);
// Draws the cost of that knob or effect beside its control, where it was measured and can be told
// from noise.
void drawCost(const std::vector<KnobCost>& costs, const std::string& name);
// Lists the costs that can be told from noise, the largest first.
void drawMeasured(const std::vector<KnobCost>& costs);

// scene_panel.cpp: draws lights, materials, sky and ambient light as controls, and unfolds what was
// picked; `ownSky` is the scene's. Returns whether something was changed.
bool drawSceneTab(const SkyChoice& ownSky, RayView& picked, ShadingEdit& scene);

// app_keys.cpp: the keys, and what they do.
struct KeyHelp {
  const char* keys;
  const char* text;
};
std::span<const KeyHelp> keyHelp();

}  // namespace whit::view
