#include "core/effects.h"

#include "core/nearest_name.h"

namespace whit {

EffectSet parseEffects(const std::string& commaSeparated) {
  EffectSet set;
  for (const std::size_t i : indicesOf(commaSeparated, namesIn(kEffectNames), "effect")) {
    set = set.with(static_cast<Effect>(i));
  }
  return set;
}

}  // namespace whit
