// Suggestions for misspelt names.
#pragma once

#include <string>
#include <vector>

namespace whit {

// The name at the smallest edit distance from `word`, if that is at most 2, or a third of the word,
// and less than the whole word; otherwise empty.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

// "; did you mean 'NAME'?" for the end of a message; empty if no name is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& names);

}  // namespace whit
