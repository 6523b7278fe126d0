#include "core/effects.h"

#include <sstream>

#include "core/error.h"
#include "core/nearest_name.h"

namespace whit {

EffectSet parseEffects(const std::string& commaSeparated) {
  EffectSet set;
  std::istringstream in(commaSeparated);
  for (std::string word; std::getline(in, word, ',');) {
    if (word.empty()) continue;
    int found = -1;
    for (int i = 0; i < kEffectCount; ++i) {
      if (kEffectNames[static_cast<std::size_t>(i)].name == word) found = i;
    }
    if (found < 0) {
      std::vector<std::string> names;
      names.reserve(std::size(kEffectNames));
      for (const EffectName& e : kEffectNames) names.emplace_back(e.name);
      throwUsage("no effect is called '" + word + "'" + didYouMean(word, names));
    }
    set = set.with(static_cast<Effect>(found));
  }
  return set;
}

}  // namespace whit
