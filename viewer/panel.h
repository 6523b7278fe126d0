// The panel over the picture: what a frame costs and what goes into it.
#pragma once

#include <array>
#include <string>

#include "viewer/frame_graph.h"
#include "viewer/knob_costs.h"

namespace whit::view {

// Against the reference: not at all, side by side, or as a map of the differences.
enum class CompareMode { off, split, heatMap };

inline constexpr std::array kPanelTabs{"frame", "picture", "knobs", "effects", "scene", "keys"};

inline constexpr float kPanelAlpha = 0.82f;  // how much of the picture panels cover

// What the user can change here.
struct PanelSettings {
  bool shown = true;
  std::string tab;          // of kPanelTabs, to be turned to by the next frame; empty: it stays
  double rate = 60;         // frames a second to hold
  bool supersample = true;  // at rest
  RenderOptions options;
  DebugView view = DebugView::none;
  CompareMode compare = CompareMode::off;
  bool measureKnobs = false;  // until it is done
};

class Panel {
 public:
  void remember(const TracedFrame& frame);
  // Between ImGui's NewFrame and Render. `frame` must hold a picture. Returns whether the scene was
  // edited.
  bool draw(const TracedFrame& frame, double speed, PanelSettings& settings,
            ShadingEdit& scene) const;
  // Lines at the bottom of the window: an error stays until it is clicked away.
  static void drawMessage(const std::string& message);
  // Returns false when it was clicked away.
  static bool drawError(const std::string& error);

 private:
  void drawTimes(const TracedFrame& frame) const;
  bool drawTabs(const TracedFrame& frame, PanelSettings& settings, ShadingEdit& scene) const;

  KnobCosts costs_;
  FrameGraph graph_;
};

}  // namespace whit::view
