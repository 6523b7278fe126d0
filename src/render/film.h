// The film: where a frame goes, as linear radiance and as 8-bit codes.
#pragma once

#include "core/channels.h"
#include "core/image.h"

namespace whit {

struct Film {
  Image image;  // linear radiance; size and window are set by whoever wants the frame
  bool wantDisplay = true;
  DisplayImage display;    // 8-bit codes of the window, when they are wanted
  ChannelLayers channels;  // of the window, those of RenderOptions::channels
};

// Room for the display codes of the film's window, when they are wanted.
void sizeDisplay(Film& film);

}  // namespace whit
