#include "core/nearest_name.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "core/error.h"

namespace whit {

namespace {

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearestName(const std::string& word, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t least = std::min(std::max<std::size_t>(2, word.size() / 3) + 1, word.size());
  for (const std::string& name : names) {
    const std::size_t edits = editDistance(word, name);
    if (edits >= least) continue;
    least = edits;
    nearest = name;
  }
  return nearest;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& names) {
  const std::string nearest = nearestName(word, names);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

std::vector<std::size_t> indicesOf(const std::string& commaSeparated,
                                   const std::vector<std::string>& names, const std::string& kind) {
  std::vector<std::size_t> indices;
  std::istringstream in(commaSeparated);
  for (std::string word; std::getline(in, word, ',');) {
    if (word.empty()) continue;
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) {
      throwUsage("no " + kind + " is called '" + word + "'" + didYouMean(word, names));
    }
    indices.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  return indices;
}

std::vector<std::string> distinctNames(const std::vector<std::string>& names) {
  std::set<std::string> taken(names.begin(), names.end());
  std::map<std::string, int> uses;
  std::vector<std::string> distinct;
  for (const std::string& given : names) {
    std::string name = given;
    int& use = uses[given];
    while (++use > 1 && !taken.insert(name = given + "#" + std::to_string(use)).second) {
    }
    distinct.push_back(name);
  }
  return distinct;
}

}  // namespace whit
