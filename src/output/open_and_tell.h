// Opens a scene for a program.
#pragma once

#include <memory>
#include <string>

#include "command_line/parse_options.h"
#include "engine/open_scene.h"

namespace whit {

// Opens the scene and, unless --quiet, tells people on standard error what was repaired, and if
// nothing in the scene gives light.
std::unique_ptr<OpenScene> openAndTell(const std::string& name, const cli::CommonOptions& common,
                                       Progress* progress, const LookAtScene& look = {});

}  // namespace whit
