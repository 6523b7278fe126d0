// A whole debug view of a frame.
#pragma once

#include <string>
#include <vector>

#include "inspect/debug_view.h"

namespace whit::test {

struct DebugFrame {
  FrameStats stats;
  std::string legend;
  std::vector<WatchedPixel> pixels;
};

// Paints film.display.
inline DebugFrame renderDebugView(Renderer& renderer, const Camera& camera, Film& film,
                                  DebugView view) {
  DebugFrame frame;
  frame.stats = watchFrame(renderer, camera, film, view, frame.pixels);
  const int samples = renderer.options().spp;
  const AmountScale scale = scaleOf(view, frame.pixels, samples);
  paintView(view, frame.pixels, samples, scale, film.display);
  frame.legend = legendOf(view, scale);
  return frame;
}

}  // namespace whit::test
