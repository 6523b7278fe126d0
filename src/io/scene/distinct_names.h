// Names by which things of one kind can be told apart.
#pragma once

#include <string>
#include <vector>

namespace whit {

// The names, with a number after those that are taken: "lamp", "lamp#2".
std::vector<std::string> distinctNames(const std::vector<std::string>& names);

}  // namespace whit
