// Everything that is drawn over the picture beside the panel: the line on what is on screen,
// messages, the comparison with the reference, the pixel under the pointer. All of it is drawn
// between ImGui's NewFrame and Render.
#pragma once

#include <array>
#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

inline constexpr float kPanelAlpha = 0.82f;  // how much of the picture panels cover

// ", within about 0.8 %": the standard error of a pixel, as SampleSums::relativeError() has it;
// empty where that is not known.
std::string errorText(double sampleError);
// "100 of 256 samples, within about 0.8 %": of a picture that gains samples.
std::string samplesText(const UnfinishedFrame& frame);
// "1/4, depth 4": the share of the window's pixels a side, and what else differs from the options.
std::string sharpnessText(const FrameRequest& request);

// Describes that pixel of a window of this size in lines, with units: by the view that was traced,
// or by its radiance; with `compared` also by the reference's. Empty beside the picture.
std::string inspect(const TracedFrame& frame, bool compared, const ImageSize& window,
                    const std::array<int, 2>& pixel);
// Draws such lines beside the pointer, inside the window.
void drawInspection(const std::string& lines, double pointerX, double pointerY);

// Draws into a corner of the window what is on screen, how fast it comes, what is on its way, and
// what the colors of a view mean.
void drawStatus(const TracedFrame& frame, const UnfinishedFrame* next, double rate);
// Draws a line at the bottom of the window.
void drawMessage(const std::string& message);
// Draws an error, which stays until it is clicked away; returns false then.
bool drawError(const std::string& error);

// Draws the line between both pictures at the share `split` of the window's width; with `words`
// also their names, and the measures of their difference.
void drawComparison(const TracedFrame& frame, CompareMode mode, double split, bool words);

}  // namespace whit::view
