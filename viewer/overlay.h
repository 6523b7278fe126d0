// These functions draw over the picture all but the panel and the rays, between NewFrame and Render
// of Dear ImGui. They append what the user asks for to `said`, in lines of verbs.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "viewer/session/view_state.h"

namespace whit::view {

// These four draw above `bottom` and return the top of what they drew.
// Draws a bar to play and to choose the time, if the scene moves.
float drawTimeline(const Timeline& timeline, float bottom, std::vector<std::string>& said);
float drawMessage(const std::string& message, float bottom);
float drawError(const std::string& error, float bottom, std::vector<std::string>& said);
// Draws the sharpness of the picture, the frame rate and the meaning of a view's colors, at the
// right.
float drawStatus(const ViewState& state, float bottom);

// Draws the scenes to choose from: those that were open lately, and the shipped ones.
void drawScenes(const std::vector<std::string>& recent, std::vector<std::string>& said);
// Draws the list of the scene's cameras.
void drawCameras(const ViewState& state, std::vector<std::string>& said);
// Draws the list of keys.
void drawKeys(float bottom);

// Describes the pixel of a debug view that is shown at this pixel of a window of that size, in
// lines with units. Returns an empty text beside the picture, and if no debug view is shown.
std::string inspect(const TracedFrame& frame, const ImageSize& window,
                    const std::array<int, 2>& pixel);
// Draws the lines of inspect() beside the pointer, inside the window.
void drawInspection(const std::string& lines, double pointerX, double pointerY);

}  // namespace whit::view
