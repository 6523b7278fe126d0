// Suggestions for misspelt names: the nearest of those there are.
#pragma once

#include <string>
#include <vector>

namespace whit {

// The name at the smallest edit distance from `word`; empty when there are no names.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);
// The same if it can be meant: at most two letters off, and not in all of them. Empty otherwise.
std::string nearName(const std::string& word, const std::vector<std::string>& names);

}  // namespace whit
