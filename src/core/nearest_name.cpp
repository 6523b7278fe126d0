#include "core/nearest_name.h"

#include <algorithm>
#include <numeric>

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
  const auto closer = [&](const std::string& a, const std::string& b) {
    return editDistance(word, a) < editDistance(word, b);
  };
  const auto best = std::min_element(names.begin(), names.end(), closer);
  return best == names.end() ? std::string() : *best;
}

std::string nearName(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::size_t kMostEdits = 2;
  const std::string nearest = nearestName(word, names);
  const std::size_t edits = editDistance(word, nearest);
  return edits <= kMostEdits && edits < word.size() ? nearest : std::string();
}

}  // namespace whit
