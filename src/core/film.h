// The precision in which a picture is kept.
#pragma once

#include "core/options.h"
#include "core/vec3.h"

namespace whit {

// The nearest half (IEEE 754 binary16, ties to even) as a float. What is finite stays finite: at
// most 65504.
float roundedToHalf(float x);

// A pixel as the film keeps it. 8-bit film holds nothing outside [0, 1], and no NaN.
Rgb quantized(FilmPrecision precision, const Rgb& pixel);

}  // namespace whit
