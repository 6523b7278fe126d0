// The transfer function of sRGB (IEC 61966-2-1), with its exact branches.
#pragma once

namespace whit {

// Linear light of an sRGB value in [0, 1] (a code divided by its largest).
double srgbToLinear(double code);
// And back; `linear` in [0, 1].
double linearToSrgb(double linear);

}  // namespace whit
