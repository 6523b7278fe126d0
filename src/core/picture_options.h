// Which options a picture depends on.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/options.h"

namespace whit {

// Whether the option of this name (as in forEachOption) can change a bit of the picture. The others
// cannot by design: the bits do not depend on how the work is shared out.
inline bool changesPicture(std::string_view option) {
  return option != "threads" && option != "tile" && option != "queue" && option != "batch";
}

// Name and value of every such option that says anything, in the order of forEachOption.
std::vector<std::pair<std::string, std::string>> pictureOptions(const RenderOptions& options);

}  // namespace whit
