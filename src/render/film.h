// The film: where a frame goes, as linear radiance and as 8-bit codes.
#pragma once

#include <cstdint>
#include <limits>

#include "bake/scene.h"
#include "core/channels.h"
#include "core/image.h"
#include "core/options.h"

namespace whit {

struct Film {
  Image image;  // linear radiance; size and window are set by whoever wants the frame
  bool wantDisplay = true;
  DisplayImage display;    // 8-bit codes of the window, when they are wanted
  ChannelLayers channels;  // layers of RenderOptions::channels in the window
};

// Room for the display codes of the film's window, when they are wanted.
void sizeDisplay(Film& film);

// An empty film of the size and crop that the options ask for. Throws Error(usage) for a crop
// outside the image, Error(limit) when it and what writes it would take more than `maxBytes`.
Film makeFilm(const Scene& scene, const RenderOptions& options,
              std::uint64_t maxBytes = std::numeric_limits<std::uint64_t>::max());
// Replaces the standard error of each pixel by the root mean square over the pixels around it,
// because a pixel whose few samples all missed the light has an error of 0.
void poolErrors(Film& film);
inline constexpr int kPoolReach = 2;  // pixels to each side, within the film's window
// Shows the background of the options where the film was asked for display codes.
void showBackground(const RenderOptions& options, Film& film);

}  // namespace whit
