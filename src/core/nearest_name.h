// Lists of names, and suggestions for misspelt ones.
#pragma once

#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

namespace whit {

// The name that other programs, or former versions, call `word`; else the name at the smallest edit
// distance from it, if that is about a third of the word at most; otherwise empty.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

// "; did you mean 'NAME'?" for the end of a message; empty if no name is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& names);

// The indices in `names` of the names in the text, which are separated by commas. Throws
// Error(usage) for an unknown one: "no KIND is called ...".
std::vector<std::size_t> indicesOf(const std::string& commaSeparated,
                                   const std::vector<std::string>& names, const std::string& kind);

// The names, with a number after those that are taken: "lamp", "lamp#2".
std::vector<std::string> distinctNames(const std::vector<std::string>& names);

// The names of a table whose rows have a member `name`.
template <typename Table>
std::vector<std::string> namesIn(const Table& table) {
  std::vector<std::string> names;
  names.reserve(std::size(table));
  for (const auto& row : table) names.emplace_back(row.name);
  return names;
}

}  // namespace whit
