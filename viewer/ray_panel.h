// The rays of a picked pixel: as a tree in the panel, and as lines over the picture.
#pragma once

#include <cstddef>

#include "viewer/traced_frame.h"

namespace whit::view {

// How they are looked at.
struct RayView {
  bool lines = true;                       // over the picture
  std::size_t pointedAt = kNoCounterpart;  // the node under the pointer, whose line stands out
  // Of the surface that was picked, and the light that it has most of; kNoCounterpart: none. The
  // scene's tab unfolds them once.
  std::size_t material = kNoCounterpart, light = kNoCounterpart;
  bool fromAside = false;  // asked for: a camera that sees all of them
  bool forget = false;     // asked for
};

// Lets the scene's tab unfold what was picked.
void select(const RayPick& pick, RayView& view);

// Between ImGui's Begin and End. Says how to pick where nothing is.
void drawRayTree(const RayPick& pick, const TracedFrame& frame, RayView& view);

// Between ImGui's NewFrame and Render, behind panels: the lines as this camera sees them.
void drawRayLines(const RayPick& pick, const Camera& camera, const RayView& view);

}  // namespace whit::view
