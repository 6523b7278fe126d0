// The oracle's scenes as files that whit reads.
#pragma once

#include <string>

#include "oracle/scene.h"

namespace oracle {

// Writes scene.json and what it names into the folder; returns its path.
std::string writeScene(const Scene& scene, const std::string& folder);

}  // namespace oracle
