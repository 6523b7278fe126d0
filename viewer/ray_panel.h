// The rays of a picked pixel, as a tree in the panel and as lines over the picture.
#pragma once

#include <cstddef>

#include "viewer/traced_frame.h"

namespace whit::view {

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

// Lets the scene's tab unfold what was picked.
void select(const RayPick& pick, RayView& view);

// Draws the tree, or how to pick a pixel. Call between ImGui's Begin and End.
void drawRayTree(const RayPick& pick, const TracedFrame& frame, RayView& view);

// Draws the lines as this camera sees them, behind panels. Call between ImGui's NewFrame and
// Render.
void drawRayLines(const RayPick& pick, const Camera& camera, const RayView& view);

}  // namespace whit::view
