// What each knob and each effect costs now: the present view with it and without it.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace whit::view {

struct KnobCost {
  std::string name;   // of the option, or of the effect
  std::string other;  // the setting that is compared with, "off" for an effect
  FrameStats now, then;
  double spreadMs = 0;  // by how much frames of the same settings differed, at most

  double ms() const { return now.frameMs - then.frameMs; }
  // Whether the difference is more than what the machine's other work may have made.
  bool significant() const { return std::abs(ms()) > spreadMs; }
  double rays() const {
    return static_cast<double>(now.allRays()) - static_cast<double>(then.allRays());
  }
};

// Frames as they are and with one thing changed take turns, and the quickest of each counts, so
// that what else the machine does cancels. Options at their cheapest setting already, and those
// that need another acceleration structure, are left out. `film` is overwritten; the renderer has
// `options` before and after. Empty when `superseded` said so between two frames.
std::vector<KnobCost> measureKnobs(Renderer& renderer, const RenderOptions& options,
                                   const Camera& camera, Film& film,
                                   const std::function<bool()>& superseded);

}  // namespace whit::view
