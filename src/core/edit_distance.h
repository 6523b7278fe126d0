// How far a misspelt word is from a name.
#pragma once

#include <cstddef>
#include <string>

namespace whit {

// Damerau's edit distance (1964): letters that are put in, left out or replaced, and neighbors that
// changed places.
std::size_t editDistance(const std::string& a, const std::string& b);

}  // namespace whit
