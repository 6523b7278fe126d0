// A value that changes with time, by keys. glTF 2.0 specification, appendix C.
#pragma once

#include <cstddef>
#include <vector>

namespace whit {

struct Track {
  // cubic: Hermite splines through the keys, each with a tangent before and behind it.
  enum class Interpolation { step, linear, cubic };

  Interpolation interpolation = Interpolation::linear;
  // Quaternions (x, y, z, w): linear is along the shorter great arc, and all come out with
  // length 1.
  bool rotation = false;
  std::size_t components = 3;
  std::vector<double> times;  // seconds, increasing, at least one
  // One group of components for each key; with cubic interpolation three groups: the tangent before
  // the key, the value, and the tangent behind it, per second.
  std::vector<double> values;
};

// Clamped to the first and the last key.
std::vector<double> valueAt(const Track& track, double time);

}  // namespace whit
