#include "bake/item_numbers.h"

#include <algorithm>

namespace whit {

ItemNumbers::Run ItemNumbers::find(std::uint32_t triangle) const {
  const auto isBehind = [](std::uint32_t t, const Run& run) { return t < run.first; };
  Run run = *(std::upper_bound(runs_.begin(), runs_.end(), triangle, isBehind) - 1);
  run.number += triangle - run.first;
  run.first = triangle;
  return run;
}

}  // namespace whit
