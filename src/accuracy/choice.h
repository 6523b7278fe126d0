// What a reader should choose who has so much time for a frame.
#pragma once

#include <array>
#include <string>

#include "accuracy/measurement.h"

namespace whit::accuracy {

// A frame of a game, of a preview, of a still in a moment, and of one that is waited for.
inline constexpr std::array kChoiceMs{16.0, 100.0, 1000.0, 10000.0};

// The point of the least error, mean FLIP against the truth, whose time is within `ms` as far as
// its spread reaches; of equal errors the fastest. Null: there is none.
const Point* bestWithin(const SceneSweep& sweep, double ms);

// One sentence, text: "whitted at 256x256 pixels: in 16 ms choose draft (FLIP 0.0812), in 100 ms
// ...". Says of a point whose time has no spread that it has none.
std::string choiceText(const SceneSweep& sweep);

}  // namespace whit::accuracy
