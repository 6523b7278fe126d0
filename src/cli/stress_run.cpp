#include "cli/stress_run.h"

#include <algorithm>

namespace whit::cli {

std::vector<StressRow> runCatalogue(const std::vector<std::string>& only, Progress* progress) {
  std::vector<StressRow> rows;
  const std::vector<stress::Family> families = stress::families();
  std::size_t count = 0, done = 0;
  for (const stress::Family& family : families) count += family.cases.size();
  for (const stress::Family& family : families) {
    for (const stress::Case& c : family.cases) {
      reportProgress(progress, std::string(c.name),
                     static_cast<double>(done++) / static_cast<double>(count));
      if (!only.empty() && std::find(only.begin(), only.end(), c.name) == only.end()) continue;
      for (const stress::Setup& setup : stress::setupsOf(c.runs)) {
        rows.push_back({family.name, &c, setup, stress::runCase(c, setup)});
      }
    }
  }
  return rows;
}

}  // namespace whit::cli
