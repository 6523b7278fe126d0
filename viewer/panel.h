// All that is drawn over the picture: the panel with its tabs, rays, messages.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/motion.h"
#include "viewer/frame_tracer.h"
#include "viewer/view_files.h"

namespace whit::view {

inline constexpr std::array kPanelTabs{"frame", "picture", "knobs", "effects",
                                       "rays",  "scene",   "keys"};

inline constexpr float kPanelAlpha = 0.82f;  // how much of the picture panels cover

// Returns the largest difference of a channel of two colors, in 8-bit codes.
inline int codesApart(const std::array<std::uint8_t, 3>& a, const std::array<std::uint8_t, 3>& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// The view of the rays.
struct RayView {
  bool lines = true;                       // over the picture
  std::size_t pointedAt = kNoCounterpart;  // the node under the pointer, whose line stands out
  // The material that was hit and the light that adds most to it, which the scene's tab unfolds
  // once; kNoCounterpart: none.
  std::size_t material = kNoCounterpart, light = kNoCounterpart;
  bool fromAside = false;  // the camera is to see all rays
  bool forget = false;     // the rays are to go
};

// The instant of a scene that moves: it plays by the clock, or the user sets it.
struct Timeline {
  bool there = false;  // the scene moves
  double seconds = 0, length = 0;
  bool playing = false;
  std::vector<std::string> animations;  // to choose from; empty where there is one only
  std::string animation;                // the animation that plays
  bool another = false;                 // the animation was just chosen and is to be read

  // Goes on by that many seconds. Returns whether it was playing.
  bool step(double later);
  std::optional<double> time() const { return there ? std::optional(seconds) : std::nullopt; }
};

// Returns the timeline of a scene that was just read: at the instant's seconds if it has any,
// otherwise playing from 0.
Timeline timelineOf(const Scene& scene, const Instant& instant);

// The settings that the panel and the keys change.
struct PanelSettings : KeptSettings {
  bool words = true;               // anything is written or drawn over the picture
  std::optional<float> keepClear;  // a place across the window that the panel must not cover
  std::string open;                // a scene to open
  std::string tab;                 // the tab of kPanelTabs to turn to; empty: it stays
  double rate = 60;                // frames a second to hold
  RenderOptions options;
  DebugView view = DebugView::none;
  bool measureKnobs = false;  // true until the measurement is done
  RayView rays;
  Timeline timeline;
  bool saveScene = false;  // the scene is to be saved
};

// Returns whether nothing but options differs from the view that was measured.
bool isMeasuredView(FrameRequest measured, const FrameRequest& request);

class Panel {
 public:
  void remember(const TracedFrame& frame);  // its costs
  // Call between ImGui's NewFrame and Render; `frame` must hold a picture. Returns whether the
  // scene was edited.
  bool draw(const TracedFrame& frame, const RayPick& pick, double speed, PanelSettings& settings,
            const SkyChoice& ownSky, ShadingEdit& scene);

 private:
  bool drawTabs(const TracedFrame& frame, const RayPick& pick, PanelSettings& settings,
                const SkyChoice& ownSky, ShadingEdit& scene) const;

  std::vector<KnobCost> costs_;  // costs measured so far at the view of the last frame
  FrameRequest measuredFor_;
  float left_ = 0, width_ = 0;  // of the panel in the last frame
};

// knobs.cpp, the options of a render as sliders, boxes and lists. All of it belongs between ImGui's
// Begin and End.
// Draws the options that the table of options has in that tab, and presets before those of the
// knobs.
void drawOptions(Tab tab, RenderOptions& options, const std::vector<KnobCost>& costs);
// Draws the cost of that knob or effect beside its control, where it was measured and can be told
// from noise.
void drawCost(const std::vector<KnobCost>& costs, const std::string& name);
// Lists the costs that can be told from noise, the largest first.
void drawMeasured(const std::vector<KnobCost>& costs);

// scene_panel.cpp: draws lights, materials, sky and ambient light as controls, and unfolds what was
// picked; `ownSky` is the scene's. Returns whether something was changed.
bool drawSceneTab(const SkyChoice& ownSky, RayView& picked, ShadingEdit& scene);

// ray_panel.cpp: the rays of a picked pixel, as a tree in the panel and as lines over the picture.
// Lets the scene's tab unfold what was picked.
void select(const RayPick& pick, RayView& view);

// Draws the tree, or how to pick a pixel. Call between ImGui's Begin and End.
void drawRayTree(const RayPick& pick, const TracedFrame& frame, RayView& view);

// Draws the lines as this camera sees them, behind panels. Call between ImGui's NewFrame and
// Render.
void drawRayLines(const RayPick& pick, const Camera& camera, const RayView& view);

// overlay.cpp: draws a bar at the bottom of the window if the scene moves. Returns whether
// something was changed. Call between ImGui's NewFrame and Render.
bool drawTimeline(Timeline& timeline);

// overlay.cpp: everything else that is drawn over the picture, between ImGui's NewFrame and Render.
// ", within about 0.8 %": the standard error of a pixel, as SampleSums::relativeError() has it;
// empty where that is not known.
std::string errorText(double sampleError);
// "100 of 256 samples, within about 0.8 %": of a picture that gains samples.
std::string samplesText(const UnfinishedFrame& frame);
// "1/4, 16 samples": the share of the window's pixels a side, and the samples.
std::string sharpnessText(const FrameRequest& request);

// Describes that pixel of a window of this size in lines, with units: by the view that was traced,
// or by its radiance. Empty beside the picture.
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
