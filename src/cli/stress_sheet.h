// All scenes of hard cases on one picture.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"

namespace whit::cli {

// Renders each scene of scenes/hard at 320x240 and puts them side by side, four a row, in order of
// their names, which are returned. Throws Error: io when there is none or the file cannot be
// written.
std::vector<std::string> writeStressSheet(const std::string& path, Progress* progress);

}  // namespace whit::cli
