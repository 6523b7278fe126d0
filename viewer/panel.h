// The panel over the picture: what a frame costs and what goes into it.
#pragma once

#include <array>
#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

// What the user can change here.
struct PanelSettings {
  bool shown = true;
  double rate = 60;  // frames a second to hold
  float exposure = 0;
  ToneCurve toneCurve = ToneCurve::none;
  EffectSet disable;
};

class Panel {
 public:
  void remember(const FrameStats& stats);  // a frame in motion, for the graph
  // Between ImGui's NewFrame and Render. `frame` must hold a picture.
  void draw(const TracedFrame& frame, double speed, PanelSettings& settings) const;
  // Lines at the bottom of the window: an error stays until it is clicked away.
  static void drawMessage(const std::string& message);
  // Returns false when it was clicked away.
  static bool drawError(const std::string& error);

 private:
  void drawTimes(const TracedFrame& frame) const;

  std::array<float, 120> times_{};
  std::size_t next_ = 0;
};

}  // namespace whit::view
