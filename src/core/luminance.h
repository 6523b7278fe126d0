// How bright a color looks (Rec. 709).
#pragma once

#include "core/vec3.h"

namespace whit {

inline double luminance(const Rgb& c) {
  return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
         0.0722 * static_cast<double>(c.z);
}

}  // namespace whit
