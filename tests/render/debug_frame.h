// A whole debug view of a frame.
#pragma once

#include <string>

#include "inspect/reference_view.h"

namespace whit::test {

struct DebugFrame {
  FrameStats stats;
  std::string legend;
  DebugPicture picture;
};

// Paints film.display.
inline DebugFrame renderDebugView(Renderer& renderer, const Camera& camera, Film& film,
                                  DebugView view) {
  DebugFrame frame;
  if (showsReference(view)) {
    std::optional<Film> reference;
    frame.stats = watchReference(renderer, camera, film, view, reference, frame.picture, {});
  } else {
    frame.stats = watchFrame(renderer, camera, film, view, frame.picture);
  }
  frame.legend = frame.picture.legend();
  return frame;
}

}  // namespace whit::test
