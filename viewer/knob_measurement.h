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

  // What the present setting costs of a frame of the whole window.
  double ms() const { return now.frameMs - then.frameMs; }
  // Whether the difference is more than what the machine's other work may have made.
  bool significant() const { return std::abs(ms()) > spreadMs; }
  double rays() const {
    return static_cast<double>(now.allRays()) - static_cast<double>(then.allRays());
  }
};

// The costs that can be told from noise, the largest first.
std::vector<KnobCost> toldFromNoise(std::vector<KnobCost> costs);
// "off would be 35 ms faster".
std::string costText(const KnobCost& cost);

// The size of the frames that are measured for a window of that size: smaller where a frame of it
// would take longer than kMeasuredMs. `msPerPixel` of the frame that is there.
ImageSize measuredSize(const ImageSize& window, double msPerPixel);
inline constexpr double kMeasuredMs = 50;

struct MeasureCalls {
  std::function<bool()> superseded;  // asked between two frames
  // Called after each knob: what is known, and how many there are.
  std::function<void(const std::vector<KnobCost>& sofar, std::size_t all)> show;
};

// Frames as they are and with one thing changed take turns, and the quickest of each counts, so
// that what else the machine does cancels. Options at their cheapest setting already, and those
// that need another acceleration structure, are left out. `film` is overwritten; times are `scale`
// times what it took. The renderer has `options` before and after. Empty when `superseded` said so.
std::vector<KnobCost> measureKnobs(Renderer& renderer, const RenderOptions& options,
                                   const Camera& camera, Film& film, double scale,
                                   const MeasureCalls& calls);

}  // namespace whit::view
