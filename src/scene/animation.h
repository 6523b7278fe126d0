// What moves in a scene, and the instant at which it is looked at.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace whit {

// One that a model's file has. It lasts from 0 to `seconds`; before and after it stands still.
struct Animation {
  std::string name;       // the file's, or "animation N", counted from 0
  double seconds = 0;     // the time of its last key
  std::size_t nodes = 0;  // that it moves or deforms
};

struct Instant {
  // Not given: everything is where its file has it without animations.
  std::optional<double> seconds;
  // By its name; empty: the first one of each model.
  std::string animation;
};

}  // namespace whit
