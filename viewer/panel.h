// The panel over the picture: what a frame costs and what goes into it; and what is drawn over the
// picture while it is compared with the reference.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "viewer/ray_panel.h"
#include "viewer/timeline.h"

namespace whit::view {

// Against the reference: not at all, side by side, or as a map of the differences.
enum class CompareMode { off, split, heatMap };

inline constexpr std::array kPanelTabs{"frame", "picture", "knobs", "effects",
                                       "rays",  "scene",   "keys"};

inline constexpr float kPanelAlpha = 0.82f;  // how much of the picture panels cover

// What the user can change here.
struct PanelSettings {
  bool shown = true;
  bool narrow = false;      // the window is, and the panel was folded for it
  std::string tabShown;     // of kPanelTabs
  std::string tab;          // of kPanelTabs, to be turned to by the next frame; empty: it stays
  double rate = 60;         // frames a second to hold
  bool supersample = true;  // at rest
  RenderOptions options;
  DebugView view = DebugView::none;
  CompareMode compare = CompareMode::off;
  bool measureKnobs = false;  // until it is done
  RayView rays;
  Timeline timeline;
  bool inspects = true;    // the pixel under the pointer
  bool saveScene = false;  // asked for
};

// What the last frames in motion took, as a graph.
class FrameGraph {
 public:
  void add(double ms);
  // Between ImGui's Begin and End: the newest at the right, and a line at the time that a frame may
  // take when there are to be `rate` a second.
  void draw(double rate) const;

 private:
  std::array<float, 120> times_{};  // milliseconds, a ring
  std::size_t next_ = 0, count_ = 0;
};

// ", within about 0.8 %": the standard error of a pixel, as SampleSums::relativeError() has it;
// empty where that is not known.
std::string errorText(double sampleError);
// "100 of 256 samples, within about 0.8 %": of a picture that gets more and more of them.
std::string samplesText(const UnfinishedFrame& frame);
// "1/4, depth 4": the share of the window's pixels a side, and what else differs from the options.
std::string sharpnessText(const FrameRequest& request);

// Whether nothing but options differs from the view that was measured.
bool isMeasuredView(FrameRequest measured, const FrameRequest& request);

class Panel {
 public:
  void remember(const TracedFrame& frame);
  void remember(const UnfinishedFrame& frame);
  // Between ImGui's NewFrame and Render. `frame` must hold a picture. Returns whether the scene was
  // edited.
  bool draw(const TracedFrame& frame, const RayPick& pick, double speed, PanelSettings& settings,
            const SkyChoice& ownSky, ShadingEdit& scene) const;
  // In a corner of the window, what is on screen, how fast it comes, what is on its way, and what
  // the colors of a view stand for.
  static void drawStatus(const TracedFrame& frame, const UnfinishedFrame* next, double rate);
  // Lines at the bottom of the window: an error stays until it is clicked away.
  static void drawMessage(const std::string& message);
  // Returns false when it was clicked away.
  static bool drawError(const std::string& error);

 private:
  void drawTimes(const TracedFrame& frame) const;
  bool drawTabs(const TracedFrame& frame, const RayPick& pick, PanelSettings& settings,
                const SkyChoice& ownSky, ShadingEdit& scene) const;

  std::vector<KnobCost> costs_;  // of the view and scene of the last frame, as far as measured
  FrameRequest measuredFor_;
  double measured_ = 0;  // share of the options, while they are measured
  std::string sofar_;    // of a picture that gets more and more samples, while it does
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

// surroundings.cpp, the sky and the ambient light as controls; `ownSky` is the scene's. Returns
// whether something was changed. Between ImGui's Begin and End.
bool drawSurroundings(const SkyChoice& ownSky, ShadingEdit& scene);

// Color and strength of what has no upper limit but `largest`. Likewise.
bool drawBright(const char* label, const char* strengthLabel, float largest, Rgb& value);

// Between ImGui's NewFrame and Render: the line between both pictures at the share `split` of the
// window's width; with `words` also what is what, and what is known about their difference.
void drawComparison(const TracedFrame& frame, CompareMode mode, double split, bool words);

}  // namespace whit::view
