// What each knob, an option or an effect, costs at the present view.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accuracy/timing.h"
#include "render/renderer.h"

namespace whit::view {

// The cost of an option or an effect at the present view. Frames with the present setting and with
// the option's cheapest one, or without the effect, are timed in turns.
struct KnobCost {
  std::string name;         // name of the option or of the effect
  std::string other;        // the setting to compare with: the cheapest, or "off" for an effect
  FrameStats now, then;     // with the present setting and with the other
  accuracy::Timing timing;  // its ratio is that of the other setting's time to the present one's
  double presentMs = 0;     // time of a frame of the whole window with the present setting

  // The time that the present setting adds to a frame of the whole window.
  double ms() const { return presentMs * (1 - timing.ratio); }
  // True if the difference is larger than the noise of the machine.
  bool significant() const { return timing.ratioLow > 1 || timing.ratioHigh < 1; }
};

// Returns the costs that exceed the noise of the machine, the largest first.
std::vector<KnobCost> significantCosts(std::vector<KnobCost> costs);
// Returns a text such as "off would be 35 ms faster".
std::string costText(const KnobCost& cost);

// Returns the size of the frames whose time is measured. It is that of the window, or smaller if a
// frame of the whole window would take longer than kMeasuredMs.
ImageSize measuredSize(const ImageSize& window, double msPerPixel);
inline constexpr double kMeasuredMs = 50;

// Called between frames and at the end, with the costs so far and the share of the knobs that has
// been measured. Returns false to end the measurement.
using MeasureCall = std::function<bool(const std::vector<KnobCost>& sofar, double measured)>;

// Measures the cost of each option and each effect. Leaves out options that are at their cheapest
// setting already, and those that need another renderer. `film` is overwritten; a pixel of it
// stands for `scale` pixels of the window. The renderer has `options` before and after. Returns
// false if `goesOn` ended the measurement.
bool measureKnobs(Renderer& renderer, const RenderOptions& options, const Camera& camera,
                  Film& film, double scale, const MeasureCall& goesOn);

}  // namespace whit::view
