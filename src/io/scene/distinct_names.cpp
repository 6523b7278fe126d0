#include "io/scene/distinct_names.h"

#include <map>
#include <set>

namespace whit {

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
