// The scalar reference's frame, and the difference of the packets' frame from it, as debug views.
#pragma once

#include <optional>

#include "core/progress.h"
#include "inspect/debug_view.h"

namespace whit {

inline bool showsReference(DebugView view) {
  return view == DebugView::reference || view == DebugView::difference;
}

// Traces the frame by packets into `film`, and by the scalar reference into `reference` unless that
// holds its film already. Stores the differences of the pixels: of the channel that differs most,
// in 8-bit codes as they are displayed, and in linear values. Then `film` is
//   reference   the reference's
//   difference  that of the packets, with the differences in the colors of heatOfCodes() as display
// Returns the statistics of the packets' frame. If the hooks stop the frame, `film` is useless and
// `reference` stays empty.
FrameStats watchReference(Renderer& renderer, const Camera& camera, Film& film, DebugView view,
                          std::optional<Film>& reference, DebugPicture& picture,
                          const FrameHooks& hooks, Progress* progress = nullptr);

}  // namespace whit
