#include "core/edit_distance.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "core/index.h"

namespace whit {

std::size_t editDistance(const std::string& a, const std::string& b) {
  // Dynamic programming, with a row for each letter of `a`.
  std::vector<std::size_t> older, old, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});

  for (const auto i : indices(a)) {
    older = std::exchange(old, row);
    row[0] = i + 1;
    for (const auto j : indices(b)) {
      row[j + 1] = std::min({old[j] + (a[i] == b[j] ? 0 : 1), row[j] + 1, old[j + 1] + 1});
      // A transposition refers to the row before the last one.
      const bool swapped = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (swapped) row[j + 1] = std::min(row[j + 1], older[j - 1] + 1);
    }
  }

  return row[b.size()];
}

}  // namespace whit
