// The cost of each option and each effect at the present view: frames with it and without it, timed
// in turns as `whit accuracy` does.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/timing.h"
#include "render/renderer.h"

namespace whit::view {

struct KnobCost {
  std::string name;         // of the option, or of the effect
  std::string other;        // the setting that is compared with, "off" for an effect
  FrameStats now, then;     // with the present setting and with the other
  accuracy::Timing timing;  // of frames with the other setting; the present one is the baseline
  double presentMs = 0;     // of a frame of the whole window

  // The time that the present setting adds to a frame of the whole window.
  double ms() const { return presentMs * (1 - timing.ratio); }
  // True if the difference is larger than the noise of the machine.
  bool significant() const { return timing.ratioLow > 1 || timing.ratioHigh < 1; }
};

// The costs that can be told from noise, the largest first.
std::vector<KnobCost> toldFromNoise(std::vector<KnobCost> costs);
// "off would be 35 ms faster".
std::string costText(const KnobCost& cost);

// The size of the frames that are measured for a window of that size: smaller where a frame of it
// would take longer than kMeasuredMs.
ImageSize measuredSize(const ImageSize& window, double msPerPixel);
inline constexpr double kMeasuredMs = 50;

struct MeasureCalls {
  std::function<bool()> superseded;  // asked between two frames
  // Called after each knob with what is known, and how many knobs there are.
  std::function<void(const std::vector<KnobCost>& sofar, std::size_t all)> show;
};

// Leaves out options that are at their cheapest setting already, and those that need another
// acceleration structure. `film` is overwritten; a pixel of it stands for `scale` pixels of the
// window. The renderer has `options` before and after. Returns nothing when `superseded` said so.
std::vector<KnobCost> measureKnobs(Renderer& renderer, const RenderOptions& options,
                                   const Camera& camera, Film& film, double scale,
                                   const MeasureCalls& calls);

}  // namespace whit::view
