#include "simd/display_tables.h"

#include <cmath>
#include <limits>

namespace whit::simd {

namespace {

// The least float in [0, 1] whose code is at least `code`, by bisection over the bits.
float leastWithCode(int code) {
  float low = 0.0f, high = 1.0f;
  if (code == 0) return low;
  while (std::nextafter(low, 2.0f) < high) {
    const float middle = low + (high - low) / 2;
    (srgbCode(middle) >= code ? high : low) = middle;
  }
  return high;
}

DisplayTables makeDisplayTables() {
  DisplayTables tables;
  for (int code = 0; code < 256; ++code) {
    tables.least[static_cast<std::size_t>(code)] = leastWithCode(code);
  }
  tables.least[256] = std::numeric_limits<float>::infinity();
  for (int i = 0; i <= kSrgbSteps; ++i) {
    tables.byStep[static_cast<std::size_t>(i)] = srgbCode(static_cast<double>(i) / kSrgbSteps);
  }
  return tables;
}

}  // namespace

const DisplayTables& displayTables() {
  static const DisplayTables tables = makeDisplayTables();
  return tables;
}

}  // namespace whit::simd
