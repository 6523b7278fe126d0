// Searches of lists, as conditions.
#pragma once

#include <algorithm>
#include <functional>

namespace whit {

// True if the projection of an element equals `value`.
template <typename Range, typename Value, typename Projection = std::identity>
bool contains(const Range& range, const Value& value, Projection projection = {}) {
  return std::ranges::find(range, value, projection) != std::ranges::end(range);
}

}  // namespace whit
